//! Every two faces whose boxes meet, by halving: in time nearly proportional to the faces and to what is found, however
//! finely a plane is cut up.

use super::objects::Candidate;

/// So few faces are compared each with each.
const FEW: usize = 8;

/// Faces that are divided further and further.
type Part<'f> = Vec<&'f Candidate>;

/// Gives every two of `faces` whose boxes meet.
pub fn within<'f>(faces: Part<'f>, give: &mut impl FnMut(&'f Candidate, &'f Candidate)) {
    if faces.len() <= FEW {
        for (at, a) in faces.iter().enumerate() {
            faces[at + 1..].iter().filter(|b| a.meets(b)).for_each(|b| give(a, b));
        }
        return;
    }
    let [lower, upper] = halves(faces);
    within(lower.clone(), give);
    within(upper.clone(), give);
    between(lower, upper, give);
}

/// Gives every one of `these` with every one of `those` whose box its own meets.
pub fn between<'f>(mut these: Part<'f>, mut those: Part<'f>, give: &mut impl FnMut(&'f Candidate, &'f Candidate)) {
    keep_near(&mut these, &those);
    keep_near(&mut those, &these);
    if these.len() * those.len() <= FEW * FEW {
        for a in &these {
            those.iter().filter(|b| a.meets(b)).for_each(|b| give(a, b));
        }
        return;
    }
    let (longer, shorter) = if these.len() < those.len() { (those, these) } else { (these, those) };
    let [lower, upper] = halves(longer);
    between(lower, shorter.clone(), give);
    between(upper, shorter, give);
}

/// Drops what does not meet the box around all of `others`.
fn keep_near(part: &mut Part, others: &Part) {
    let (low, high) = extent(others, |face| (face.low, face.high));
    part.retain(|face| (0..3).all(|k| face.low[k] <= high[k] && low[k] <= face.high[k]));
}

/// Halves by number, along the axis on which their low corners are spread widest.
fn halves(mut part: Part<'_>) -> [Part<'_>; 2] {
    let (low, high) = extent(&part, |face| (face.low, face.low));
    let spread = |k: usize| high[k] - low[k];
    let axis = (0..3).reduce(|a, b| if spread(b) > spread(a) { b } else { a }).unwrap_or(0);
    let middle = part.len() / 2;
    part.select_nth_unstable_by(middle, |a, b| a.low[axis].total_cmp(&b.low[axis]));
    let upper = part.split_off(middle);
    [part, upper]
}

/// Low and high corner around the boxes of `part`.
fn extent(part: &Part, corners: impl Fn(&Candidate) -> ([f32; 3], [f32; 3])) -> ([f32; 3], [f32; 3]) {
    let none = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    part.iter()
        .map(|face| corners(face))
        .fold(none, |(low, high), (a, b)| ([0, 1, 2].map(|k| low[k].min(a[k])), [0, 1, 2].map(|k| high[k].max(b[k]))))
}
