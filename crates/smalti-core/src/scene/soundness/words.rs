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
                "the surface of {} is open: {} ends at {}; light that goes in does not come out again, and is too bright or \
                 too dark by the square of the index: give it a thickness",
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
                let more = if places > 1 { format!("; there are {places} such places") } else { String::new() };
                format!(
                    "{} is {} from {} ({materials}), {} times the length by which coordinates are rounded: what is between the two may be \
                     lost{more}",
                    names.surface(a),
                    metres(thickness),
                    names.surface(b),
                    figure(steps),
                )
            }
            Finding::Rough { sphere, across, rounding, beside, extent, things } => format!(
                "{}, {} across, is rounded to {}; {} beside it is {} across, {} times that{}: light and shadows there are wrong; a \
                 plane would do",
                names.surface(sphere),
                metres(across),
                metres(rounding),
                names.surface(beside),
                metres(extent),
                figure(extent / rounding),
                and_more(things),
            ),
            Finding::Coarse { surface, extent, steps, largest, scene, things } => format!(
                "{} is {} across, {} times the length by which coordinates are rounded where it lies{}: the scene is {} large, by {}; shapes \
                 and light there may be wrong",
                names.surface(surface),
                metres(extent),
                figure(steps),
                and_more(things),
                metres(scene),
                names.surface(largest),
            ),
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

/// Where more than one thing is so small.
fn and_more(things: usize) -> String {
    if things > 1 { format!(" (so it is with {} more)", counted(things - 1, "thing")) } else { String::new() }
}

/// A length to two digits.
fn metres(length: f64) -> String {
    match length {
        0.001..100_000.0 => format!("{} m", figure(length)),
        _ => format!("{length:.1e} m"),
    }
}

/// A number to two digits, or whole.
fn figure(x: f64) -> String {
    if x < 100.0 { two_digits(x) } else { format!("{x:.0}") }
}

/// The shortest decimal that has the first two digits of a number below 100.
fn two_digits(x: f64) -> String {
    let decimals = (1.0 - libm::floor(libm::log10(x.max(1e-9)))).max(0.0) as usize;
    let rounded: f64 = format!("{x:.decimals$}").parse().unwrap_or(x);
    rounded.to_string()
}
