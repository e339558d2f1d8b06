//! The primitives' numbers by where they come from.

use super::Pair;
use crate::scene::{Origin, Scene, World};

/// No primitive: left out for want of an area.
const NONE: u32 = u32::MAX;

/// Numbers of the primitives of a scene.
pub struct Numbers {
    /// Of polygons, of the triangles of all meshes, and of spheres.
    numbers: Vec<u32>,
    /// Place of each mesh's first triangle in that list.
    meshes: Vec<usize>,
    /// Place of the first sphere.
    spheres: usize,
}

impl Numbers {
    /// Those of `scene`, which is compiled from `world`.
    pub fn of(scene: &Scene, world: &World) -> Self {
        let mut spheres = world.polygons.len();
        let mut meshes = Vec::with_capacity(world.meshes.len());
        for mesh in &world.meshes {
            meshes.push(spheres);
            spheres += mesh.faces.len();
        }
        let mut found = Self { numbers: vec![NONE; spheres + world.spheres.len()], meshes, spheres };
        for (origin, number) in scene.origins.iter().zip(0..) {
            let place = found.place(*origin);
            found.numbers[place] = number;
        }
        found
    }

    fn place(&self, origin: Origin) -> usize {
        match origin {
            Origin::Polygon(index) => index as usize,
            Origin::Mesh(index, triangle) => self.meshes[index as usize] + triangle as usize,
            Origin::Sphere(index) => self.spheres + index as usize,
        }
    }

    /// The pairs with their primitives, the lower number first, of those that are in the scene.
    pub fn numbered(&self, pairs: &[Pair]) -> Vec<(Pair, [u32; 2])> {
        let numbered = |pair: &Pair| {
            let [a, b] = pair.of.map(|origin| self.numbers[self.place(origin)]);
            if a < b { (*pair, [a, b]) } else { (pair.turned(), [b, a]) }
        };
        pairs.iter().map(numbered).filter(|(_, [_, b])| *b != NONE).collect()
    }
}
