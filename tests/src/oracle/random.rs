//! Random numbers and directions of the oracle.

use core::f64::consts::TAU;

use glam::DVec3;
use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// A stream of random numbers.
pub struct Random(Xoshiro256PlusPlus);

impl Random {
    /// The stream named by `seed`.
    pub fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    /// A number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A whole number below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count - 1)
    }

    /// A point of the cube [-1, 1)³.
    pub fn cube(&mut self) -> DVec3 {
        DVec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// A direction, uniform on the sphere.
    pub fn direction(&mut self) -> DVec3 {
        let (z, azimuth) = (self.between(-1.0, 1.0), TAU * self.unit());
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * libm::cos(azimuth), r * libm::sin(azimuth), z)
    }

    /// A direction about the unit vector `normal` with density cosθ/π: a uniform point of the sphere added to the
    /// normal.
    pub fn cosine_about(&mut self, normal: DVec3) -> DVec3 {
        (normal + self.direction()).normalize_or(normal)
    }
}
