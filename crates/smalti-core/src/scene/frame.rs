//! The frame in which a scene is traced: recentred and scaled by a power of two so that coordinates lie in [-1, 1].
//!
//! Promise 3 rests on this: no epsilon anywhere is absolute, because every scene has the size 1 when it is traced. An f32
//! coordinate is the finer the nearer it is to the origin, so the origin lies where the scene has its details
//! ([`details`]): a marble in a hall, or beside a ball a hundred kilometres away, is traced as finely as
//! alone. The corner of a box is subtracted first (exact under every translation that is exact in f64), then half of the
//! box's extent, rounded to a coarse grid, then everything is multiplied by a power of two; all in f64.

use glam::DVec3;

use super::details::{self, Place};
use super::world::World;

/// Maps the user's metres to the frame of the kernels and back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The lower ends, axis by axis, of what lies in the middle of the details, metres.
    corner: DVec3,
    /// From there to the origin, metres.
    half: DVec3,
    /// Lengths in the frame per metre, a power of two.
    pub scale: f64,
}

impl Frame {
    /// The frame of everything in `world` but its cameras.
    pub fn of(world: &World) -> Self {
        let Some((low, high)) = world.bounds() else {
            return Self { corner: DVec3::ZERO, half: DVec3::ZERO, scale: 1.0 };
        };
        let largest = (high - low).max_element();
        if largest == 0.0 {
            return Self { corner: low, half: DVec3::ZERO, scale: 1.0 };
        }
        let grid = 1.0 / (power_of_two_below(1.0 / largest) * 4096.0);
        let Place { low: corner, extent } = details::middle(world, low);
        let half = (extent / (2.0 * grid)).round() * grid;
        let reach = ((high - corner) - half).max(half - (low - corner)).max_element();
        Self { corner, half, scale: power_of_two_below(1.0 / reach) }
    }

    /// A point of the world in the frame, still f64.
    pub fn point(&self, p: DVec3) -> DVec3 {
        ((p - self.corner) - self.half) * self.scale
    }

    /// A point of the frame in the world.
    pub fn to_world(&self, p: [f32; 3]) -> [f64; 3] {
        (DVec3::from_array(p.map(f64::from)) / self.scale + self.half + self.corner).to_array()
    }
}

/// The largest power of two that is at most `x`, for positive normal `x`.
fn power_of_two_below(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & 0x7ff0_0000_0000_0000)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::world::Sphere;

    fn balls(balls: &[(DVec3, f64)]) -> World {
        let ball = |&(centre, radius): &(DVec3, f64)| Sphere { centre, radius, material: 0, radiance: None };
        World { spheres: balls.iter().map(ball).collect(), ..World::default() }
    }

    #[test]
    fn scales_by_powers_of_two_leave_the_frame_unchanged() {
        let p = DVec3::new(1.25, -0.3, 0.7);
        let of = |s: f64| Frame::of(&balls(&[(DVec3::ONE * s, 1.7 * s), (DVec3::X * s, 0.3 * s)])).point(p * s);
        for k in [-40, -1, 1, 20, 40] {
            assert_eq!(of(f64::from_bits(((1023 + k) as u64) << 52)), of(1.0));
        }
    }

    #[test]
    fn exact_translations_leave_the_frame_unchanged() {
        let p = DVec3::new(1.25, -0.375, 0.75);
        let of = |by: DVec3| Frame::of(&balls(&[(DVec3::ONE + by, 1.75), (DVec3::X + by, 0.375)])).point(p + by);
        for by in [DVec3::splat(1024.0), DVec3::new(-3.0, 4e6, 0.125)] {
            assert_eq!(of(by), of(DVec3::ZERO));
        }
    }

    #[test]
    fn coordinates_lie_within_one() {
        let frame = Frame::of(&balls(&[(DVec3::new(1e7, 0.0, -3.0), 0.3)]));
        assert!(frame.point(DVec3::new(1e7 + 0.3, 0.0, -3.0)).abs().max_element() <= 1.0);
        let back = frame.to_world(frame.point(DVec3::new(1e7, 0.125, -3.0)).as_vec3().to_array());
        assert!((back[1] - 0.125).abs() < 1e-6 && (back[0] - 1e7).abs() < 1e-6);
        let world = balls(&[(DVec3::ZERO, 0.01), (DVec3::new(70.0, -900.0, 3.0), 1.0), (DVec3::Y * 31.0, 2.0)]);
        let frame = Frame::of(&world);
        let (low, high) = world.bounds().expect("balls");
        let largest = frame.point(low).abs().max(frame.point(high).abs()).max_element();
        assert!(largest <= 1.0 && largest > 0.25, "{largest}");
    }

    #[test]
    fn the_origin_is_beside_the_smallest_thing() {
        let far = DVec3::new(3e4, -7e4, 5e4);
        for marble in [DVec3::ZERO, DVec3::new(4.0, 1.0, 2.0), far] {
            let frame = Frame::of(&balls(&[(marble, 0.01), (far / 2.0, 1.0), (-far, 10.0), (DVec3::Z * 9.0, 3.0)]));
            let steps = frame.point(marble).abs().max_element() / (0.01 * frame.scale);
            assert!(steps <= 1000.0, "a marble at {marble} lies {steps} of its radii away");
        }
    }
}
