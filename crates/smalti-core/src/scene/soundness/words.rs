//! Findings in words, with the names that whoever tells them has for surfaces and materials.

use super::{Finding, Surface};
use crate::scene::Origin;

/// Names of surfaces and materials.
pub trait Names {
    /// What a surface is called: `the quad in line 12`.
    fn surface(&self, surface: Origin) -> String;
    /// What a material is called: `` `glass` ``.
    fn material(&self, material: usize) -> String;
}

impl Finding {
    /// The finding as a sentence without its full stop.
    pub fn says(&self, names: &dyn Names) -> String {
        match *self {
            Finding::Open { surface, material, edges } => format!(
                "the surface of {} is open: {} ends at {}; light that goes in comes not out again, and counts by the \
                 square of the index too little or too much",
                names.material(material),
                body(names, surface),
                counted(edges, "free edge"),
            ),
            Finding::InsideOut { surface, material } => format!(
                "the closed surface of {} is inside out: {} is wound so that all the world around it is its inside",
                names.material(material),
                body(names, surface),
            ),
            Finding::ShinesInwards { surface } => format!(
                "a closed lamp shines inwards, where nothing is: {} is wound so that its front is inside",
                body(names, surface),
            ),
            Finding::Thin { of: [a, b], materials: [one, other], thickness, steps, places } => {
                let materials = match one == other {
                    true => names.material(one),
                    false => format!("{} and {}", names.material(one), names.material(other)),
                };
                let steps = if steps < 10.0 { format!("{steps:.1}") } else { format!("{steps:.0}") };
                let more = if places > 1 { format!("; {} such places", places) } else { String::new() };
                format!(
                    "{} is {thickness:.1e} m from {} ({materials}), {steps} steps of the coordinates there: what is \
                     between may be lost{more}",
                    names.surface(a),
                    names.surface(b),
                )
            }
            Finding::Rough { sphere, across, rounding, beside, extent, things } => {
                let more =
                    if things > 1 { format!(" and {} more", counted(things - 1, "thing")) } else { String::new() };
                format!(
                    "{}, {across:.1e} m across, is rounded to {rounding:.1e} m, {:.0} of which are {} ({extent:.1e} m){more} \
                     beside it: light and shadows there are wrong; a plane would do",
                    names.surface(sphere),
                    extent / rounding,
                    names.surface(beside),
                )
            }
            Finding::Coarse { surface, extent, steps, largest, scene, things } => {
                let more = if things > 1 { format!(", and {} more hardly more", things - 1) } else { String::new() };
                format!(
                    "{} is {extent:.1e} m across, {steps:.0} steps of the coordinates where it lies{more}: the scene is \
                     {scene:.1e} m large, by {}; shapes and light there may be drawn wrong",
                    names.surface(surface),
                    names.surface(largest),
                )
            }
        }
    }
}

fn body(names: &dyn Names, Surface { face, faces, count }: Surface) -> String {
    let of = (faces > 1).then(|| format!("of {faces} faces"));
    let with = (count > 1).then(|| format!("with {} more", counted(count - 1, "surface")));
    let more: Vec<String> = of.into_iter().chain(with).collect();
    let name = names.surface(face);
    if more.is_empty() { name } else { format!("{name}, {},", more.join(" and ")) }
}

fn counted(count: usize, name: &str) -> String {
    format!("{count} {name}{}", if count == 1 { "" } else { "s" })
}
