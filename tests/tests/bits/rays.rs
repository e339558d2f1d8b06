//! Rays that are hard to answer: aimed at corners and edges, grazing, along the axes, and from surfaces.

use glam::Vec3;
use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;
use smalti_core::scene::Scene;

/// Rays as columns, with the surface each leaves and the one it is aimed at (`u32::MAX`: none).
#[derive(Default)]
pub struct Rays {
    /// Origin and direction.
    pub columns: [Vec<f32>; 6],
    pub leaves: Vec<u32>,
    pub target: Vec<u32>,
    len: usize,
}

impl Rays {
    pub fn len(&self) -> usize {
        self.len
    }

    pub fn push(&mut self, origin: Vec3, direction: Vec3, leaves: u32, target: u32) {
        let values = origin.to_array().into_iter().chain(direction.to_array());
        self.len += 1;
        // Padded by the widest packet.
        for (column, value) in self.columns.iter_mut().zip(values) {
            column.truncate(self.len - 1);
            column.extend([value; 17]);
        }
        for (column, value) in [(&mut self.leaves, leaves), (&mut self.target, target)] {
            column.truncate(self.len - 1);
            column.extend([value; 17]);
        }
    }

    /// A ray in words, exactly.
    pub fn show(&self, at: usize) -> String {
        let [x, y, z, dx, dy, dz] = self.columns.each_ref().map(|column| column[at]);
        let (leaves, target) = (self.leaves[at] as i32, self.target[at] as i32);
        format!("ray {at} from ({x:e}, {y:e}, {z:e}) along ({dx:e}, {dy:e}, {dz:e}) leaves {leaves} target {target}")
    }
}

/// Random choices.
pub struct Dice(Xoshiro128PlusPlus);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(Xoshiro128PlusPlus::seed_from_u64(seed))
    }

    /// Less than `end`.
    pub fn below(&mut self, end: usize) -> usize {
        self.0.next_u32() as usize % end
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f32 {
        (self.0.next_u32() >> 8) as f32 / 16_777_216.0
    }

    /// In the cube from -1 to 1.
    pub fn cube(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }

    /// A unit vector, of no particular distribution.
    pub fn direction(&mut self) -> Vec3 {
        self.cube().try_normalize().unwrap_or(Vec3::X)
    }
}

/// A point of a primitive, its normal there and its surface.
struct Spot {
    point: Vec3,
    normal: Vec3,
    surface: u32,
}

/// A corner (0), a point of an edge (1) or of the inside (2) of a random primitive; of spheres just a point.
fn spot(scene: &Scene, dice: &mut Dice, where_to: usize) -> Spot {
    let prim = dice.below(scene.shades.len());
    let surface = scene.shades[prim][7].to_bits();
    let Some(face) = scene.faces.get(prim) else {
        let [x, y, z, r] = scene.spheres[prim - scene.faces.len()];
        let normal = dice.direction();
        return Spot { point: Vec3::new(x, y, z) + normal * r, normal, surface };
    };
    let corners: Vec<Vec3> =
        scene.face_corners(face).iter().map(|&corner| Vec3::from_array(scene.vertices[corner as usize])).collect();
    let first = dice.below(corners.len());
    let [a, b, c] = [0, 1, 2].map(|k| corners[(first + k) % corners.len()]);
    let (u, v) = (dice.unit(), dice.unit());
    let point = match where_to {
        0 => a,
        1 => a + (b - a) * if u < 0.5 { 0.5 } else { v },
        _ => a + ((b - a) * (1.0 - u) + (c - a) * u) * v,
    };
    Spot { point, normal: Vec3::from_slice(&face.plane[..3]), surface }
}

/// `count` rays of all kinds.
pub fn rays(scene: &Scene, count: usize) -> Rays {
    let mut rays = Rays::default();
    let mut dice = Dice::new(count as u64);
    let none = u32::MAX;
    for number in 0..count {
        let where_to = dice.below(3);
        let (from, to) = (spot(scene, &mut dice, where_to), spot(scene, &mut dice, number % 3));
        let outside = dice.cube() * 1.25;
        match number % 8 {
            0 => rays.push(outside, dice.direction(), none, none),
            1 => rays.push(outside, to.point - outside, none, none),
            2 => rays.push(outside, to.point - outside, none, to.surface),
            3 => {
                let origin = from.point + from.normal * 3e-6;
                rays.push(origin, dice.direction(), from.surface, none);
            }
            4 => {
                let origin = from.point - from.normal * 2e-6;
                rays.push(origin, to.point - origin, from.surface, to.surface);
            }
            5 => rays.push(from.point, to.point - from.point, none, to.surface),
            6 => {
                let axis = [Vec3::X, Vec3::Y, Vec3::Z][dice.below(3)];
                let sign = if dice.unit() < 0.5 { 1.0 } else { -1.0 };
                rays.push(to.point - axis * sign * 0.75, axis * sign, none, none);
            }
            _ => grazing(&mut rays, &mut dice, &from),
        }
    }
    rays
}

/// A ray that begins near the plane of `spot`, or in it, and hardly leaves it.
fn grazing(rays: &mut Rays, dice: &mut Dice, spot: &Spot) {
    let along = spot.normal.cross(dice.direction());
    let tilt = [0.0, 1e-8, -1e-6, 1e-4, -1e-2][dice.below(5)];
    let height = [0.0, 1e-8, -1e-7, 1e-5, 1e-3][dice.below(5)];
    let back = dice.unit();
    let origin = spot.point - along * back + spot.normal * height;
    rays.push(origin, along + spot.normal * tilt, u32::MAX, u32::MAX);
}
