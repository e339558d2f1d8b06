//! Which dielectrics have a boundary in common.

use super::Pair;
use crate::geometry::{Lone, polygon};
use crate::mutant::mutant;
use crate::scene::Scene;
use crate::scene::world::World;

/// The dielectrics of a scene that lie in one place.
pub struct Joints {
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

impl Joints {
    /// Those among these pairs; `None` if there are none.
    pub fn among(scene: &Scene, world: &World, pairs: &[(Pair, [u32; 2])]) -> Option<Self> {
        let materials: Vec<u32> = scene.origins.iter().map(|origin| world.skin(*origin).0 as u32).collect();
        let clear = |prim: u32| world.materials[materials[prim as usize] as usize].is_dielectric();
        let joined = |(pair, [a, b]): &&(Pair, [u32; 2])| pair.coincides() && clear(*a) && clear(*b);
        let both = |&(Pair { same_way, .. }, [a, b]): &(Pair, [u32; 2])| {
            [(a, Partner { prim: b, same_way }), (b, Partner { prim: a, same_way })]
        };
        let mut found: Vec<(u32, Partner)> = pairs.iter().filter(joined).flat_map(both).collect();
        if found.is_empty() || mutant!("vacuum_between_glasses") {
            return None;
        }
        found.sort_by_key(|(prim, partner)| (*prim, partner.prim));
        let prims = scene.shades.len() as u32;
        let first = (0..=prims).map(|prim| found.partition_point(|(of, _)| *of < prim) as u32).collect();
        Some(Self { first, partners: found.into_iter().map(|(_, partner)| partner).collect(), materials })
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
        (size_of_val(&self.first[..]) + size_of_val(&self.materials[..]) + size_of_val(&self.partners[..])) as u64
    }
}

impl Scene {
    /// Whether a ray, as a line, passes through a primitive that lies where it hit another one.
    pub(crate) fn lies_there(&self, prim: u32, ray: &Lone) -> bool {
        let Some(face) = self.faces.get(prim as usize) else { return true };
        let corners = self.face_corners(face).iter().map(|&corner| self.vertices[corner as usize]);
        polygon::passes(corners, &ray.ray())
    }
}
