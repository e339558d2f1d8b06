//! What stages have to know of primitives that touch: how far rays may start off them, and which dielectrics have a
//! boundary in common.

use super::Pair;
use crate::geometry::{Lone, polygon};
use crate::mutant::mutant;
use crate::scene::Scene;
use crate::scene::world::World;

/// Part of a gap by which rays leave what is beside it.
const PART: f64 = 1.0 / 64.0;

/// On a plane points are known to about so many steps.
const OFF_FACES: f64 = 2.0;

/// On a sphere they are known to so many only; rays that start nearer may be taken for inside or outside.
const OFF_SPHERES: f64 = 6.0;

/// Spheres with a gap of fewer steps are one: some rays would find the inner one, and some not.
const LEAST_SHELL: f64 = 12.0;

/// What touches in a scene.
pub struct Touching {
    /// How far rays may start off each primitive, to the side of its normal and to the other; ∞ where nothing is near.
    pub room: [Vec<f32>; 2],
    /// First partner of each primitive, and the end of the last one's.
    first: Vec<u32>,
    partners: Vec<Partner>,
    /// Number of each primitive's material.
    materials: Vec<u32>,
}

/// A dielectric in the place of another.
#[derive(Clone, Copy, Debug)]
pub struct Partner {
    /// The primitive.
    pub prim: u32,
    /// Whether it shows the same side.
    pub same_way: bool,
}

impl Touching {
    /// Of these pairs, the lower number first.
    pub fn new(scene: &Scene, world: &World, pairs: &[(Pair, [u32; 2])]) -> Self {
        let prims = scene.shades.len();
        let mut room = [vec![f32::INFINITY; prims], vec![f32::INFINITY; prims]];
        let mut found: Vec<(u32, Partner)> = Vec::new();
        let materials: Vec<u32> = scene.origins.iter().map(|origin| world.skin(*origin).0 as u32).collect();
        let clear = |prim: u32| world.materials[materials[prim as usize] as usize].is_dielectric();
        for &(pair, [a, b]) in pairs {
            if !pair.coincides() {
                narrow(scene, &mut room, a, pair);
                narrow(scene, &mut room, b, pair.turned());
            } else if clear(a) && clear(b) {
                let same_way = pair.same_way;
                found.extend([(a, Partner { prim: b, same_way }), (b, Partner { prim: a, same_way })]);
            }
        }
        found.sort_by_key(|(prim, partner)| (*prim, partner.prim));
        let first = (0..=prims as u32).map(|prim| found.partition_point(|(of, _)| *of < prim) as u32).collect();
        Self { room, first, partners: found.into_iter().map(|(_, partner)| partner).collect(), materials }
    }

    /// Whether dielectrics coincide anywhere.
    pub fn joins(&self) -> bool {
        !self.partners.is_empty() && !mutant!("vacuum_between_glasses")
    }

    /// What may lie in the place of a primitive.
    pub fn partners(&self, prim: u32) -> &[Partner] {
        &self.partners[self.first[prim as usize] as usize..self.first[prim as usize + 1] as usize]
    }

    /// Number of the material of a primitive: of several surfaces of one material that show the same side, one counts.
    pub fn material(&self, prim: u32) -> u32 {
        self.materials[prim as usize]
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        (self.room.iter().map(|room| size_of_val(&room[..])).sum::<usize>()
            + size_of_val(&self.first[..])
            + size_of_val(&self.materials[..])
            + size_of_val(&self.partners[..])) as u64
    }
}

/// Leaves to rays beside a gap a small part of it: what they are absorbed by begins where they start. Never more than half
/// of it between faces; these are not hit again by what leaves them, wherever it starts.
fn narrow(scene: &Scene, room: &mut [Vec<f32>; 2], prim: u32, pair: Pair) {
    let gap = pair.gap.abs();
    let is_sphere = prim as usize >= scene.faces.len();
    if is_sphere && gap < LEAST_SHELL * pair.step {
        return;
    }
    let off = match is_sphere {
        true => (gap * PART).max(OFF_SPHERES * pair.step),
        false => (gap * PART).max(OFF_FACES * pair.step).min(gap / 2.0),
    };
    let side = &mut room[usize::from(pair.gap < 0.0)][prim as usize];
    *side = side.min(off as f32);
}

impl Scene {
    /// Whether a ray, as a line, passes through a primitive that lies where it hit another one.
    pub(crate) fn lies_there(&self, prim: u32, ray: &Lone) -> bool {
        let Some(face) = self.faces.get(prim as usize) else { return true };
        let corners = self.face_corners(face).iter().map(|&corner| self.vertices[corner as usize]);
        polygon::passes(corners, &ray.ray())
    }
}
