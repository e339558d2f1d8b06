//! Panes and gaps as thin as the coordinates' steps.

use super::Finding;
use crate::scene::contact::Pair;
use crate::scene::world::World;
use crate::scene::{Frame, Origin};

/// Thinner than so many steps, and which side of a face a ray starts on is a matter of rounding. (On spheres and on inclined
/// faces; a pane along the axes is right down to two.)
const STEPS: f64 = 8.0;

/// Two faces of one body that are nearer than this, in steps, were written as one.
const WRITTEN_AS_ONE: f64 = 1e-3;

/// One finding for each two materials, with the thinnest place.
pub fn examine(world: &World, frame: &Frame, pairs: &[Pair]) -> Vec<Finding> {
    let mut found: Vec<Finding> = Vec::new();
    for pair in pairs.iter().filter(|pair| is_lost(world, pair)) {
        let mut materials = pair.of.map(|origin| world.skin(origin).0);
        materials.sort_unstable();
        let (thickness, steps) = (pair.gap.abs() / frame.scale, pair.gap.abs() / pair.step);
        let known = found.iter_mut().find_map(|finding| match finding {
            Finding::Thin { materials: of, of: known, thickness, steps, places } if *of == materials => {
                Some((known, thickness, steps, places))
            }
            _ => None,
        });
        match known {
            None => found.push(Finding::Thin { of: pair.of, materials, thickness, steps, places: 1 }),
            Some((of, least, fewest, places)) => {
                *places += 1;
                if steps < *fewest {
                    (*of, *least, *fewest) = (pair.of, thickness, steps);
                }
            }
        }
    }
    found
}

/// Whether what is between the two may be lost.
fn is_lost(world: &World, pair: &Pair) -> bool {
    let steps = pair.gap.abs() / pair.step;
    let is_sphere = matches!(pair.of[0], Origin::Sphere(_));
    if !pair.coincides() {
        return steps < if is_sphere { 2.0 * STEPS } else { STEPS };
    }
    let [a, b] = pair.of.map(|origin| world.skin(origin).0);
    let one_thing = match pair.of {
        [Origin::Polygon(_), Origin::Polygon(_)] => a == b,
        [Origin::Mesh(one, _), Origin::Mesh(other, _)] => one == other,
        _ => false,
    };
    // A pane whose two faces have become one; not two things that stand at each other.
    let is_pane = one_thing && !pair.same_way && pair.gap < 0.0 && world.materials[a].is_dielectric();
    is_pane && steps > WRITTEN_AS_ONE
}
