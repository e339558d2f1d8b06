//! Every two boxes that meet, by halving: in time nearly proportional to the boxes and to what is found, however finely a
//! plane is cut up.

use glam::DVec3;

/// So few boxes are compared each with each.
const FEW: usize = 8;

/// A box, by its low and high corner.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Low corner.
    pub low: [f32; 3],
    /// High corner.
    pub high: [f32; 3],
}

impl Extent {
    /// Around points, wider by `more` on every side.
    pub fn around(points: impl Iterator<Item = DVec3>, more: f64) -> Self {
        let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = points.fold(none, |(low, high), point| (low.min(point), high.max(point)));
        Self { low: (low - more).as_vec3().to_array(), high: (high + more).as_vec3().to_array() }
    }

    /// Whether the two have a point in common.
    pub fn meets(&self, other: &Self) -> bool {
        (0..3).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }
}

/// Boxes with their numbers, which are divided further and further.
type Part = Vec<(Extent, u32)>;

/// Gives the numbers of every two boxes of `part` that meet.
pub fn within(part: Part, give: &mut impl FnMut(u32, u32)) {
    if part.len() <= FEW {
        for (at, (extent, number)) in part.iter().enumerate() {
            part[at + 1..].iter().filter(|other| other.0.meets(extent)).for_each(|other| give(*number, other.1));
        }
        return;
    }
    let [lower, upper] = halves(part);
    within(lower.clone(), give);
    within(upper.clone(), give);
    between(lower, upper, give);
}

/// Gives the numbers of every box of `these` and every one of `those` that meet.
pub fn between(mut these: Part, mut those: Part, give: &mut impl FnMut(u32, u32)) {
    keep_near(&mut these, &those);
    keep_near(&mut those, &these);
    if these.len() * those.len() <= FEW * FEW {
        for (extent, number) in these {
            those.iter().filter(|other| other.0.meets(&extent)).for_each(|other| give(number, other.1));
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
    let all = all(others, |extent| extent);
    part.retain(|(extent, _)| extent.meets(&all));
}

/// Halves by number, along the axis on which the low corners are spread widest.
fn halves(mut part: Part) -> [Part; 2] {
    let lows = all(&part, |extent| Extent { high: extent.low, ..extent });
    let spread = |k: usize| lows.high[k] - lows.low[k];
    let axis = (0..3).reduce(|a, b| if spread(b) > spread(a) { b } else { a }).unwrap_or(0);
    let middle = part.len() / 2;
    part.select_nth_unstable_by(middle, |a, b| a.0.low[axis].total_cmp(&b.0.low[axis]));
    let upper = part.split_off(middle);
    [part, upper]
}

/// The box around what is made of all boxes of `part`.
fn all(part: &Part, made: impl Fn(Extent) -> Extent) -> Extent {
    let none = Extent { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };
    part.iter().map(|(extent, _)| made(*extent)).fold(none, |all, extent| Extent {
        low: [0, 1, 2].map(|k| all.low[k].min(extent.low[k])),
        high: [0, 1, 2].map(|k| all.high[k].max(extent.high[k])),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Boxes at random, small ones and some that are as large as all: every two that meet are given, once.
    #[test]
    fn every_two_that_meet_are_given_once() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1u64 << 24) as f32
        };
        let mut boxes: Part = Vec::new();
        for number in 0..600 {
            let size = if number % 97 == 0 { 1.0 } else { 0.1 };
            // In a plane, and many on the same place of a grid.
            let low = [random(), (random() * 8.0).floor() / 8.0, 0.0];
            boxes.push((Extent { low, high: low.map(|x| x + size * random()) }, number));
        }
        let wanted = |a: &(Extent, u32), b: &(Extent, u32)| a.1 < b.1 && a.0.meets(&b.0);
        let mut all: Vec<(u32, u32)> = Vec::new();
        for a in &boxes {
            all.extend(boxes.iter().filter(|b| wanted(a, b)).map(|b| (a.1, b.1)));
        }
        let mut found: Vec<(u32, u32)> = Vec::new();
        within(boxes.clone(), &mut |a, b| found.push((a.min(b), a.max(b))));
        found.sort_unstable();
        assert_eq!(found, all);
        let (these, those) = boxes.split_at(100);
        let mut found: Vec<(u32, u32)> = Vec::new();
        between(these.to_vec(), those.to_vec(), &mut |a, b| found.push((a.min(b), a.max(b))));
        found.sort_unstable();
        all.retain(|(a, b)| *a < 100 && *b >= 100);
        assert_eq!(found, all);
    }
}
