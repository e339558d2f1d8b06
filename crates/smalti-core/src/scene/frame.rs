//! The frame in which a scene is traced: recentred and scaled by a power of two so that coordinates lie in [-1, 1].
//!
//! Promise 3 rests on this: no epsilon anywhere is absolute, because every scene has the size 1 when it is traced.
//! The minimum corner of the bounding box is subtracted first (exact under every translation that is exact in f64),
//! then half the extent, rounded to a coarse grid, then everything is multiplied by a power of two; all in f64.

use glam::DVec3;

use super::world::World;

/// Maps the user's metres to the frame of the kernels and back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Minimum corner of the scene's bounding box, metres.
    corner: DVec3,
    /// Half the rounded extent, metres.
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
        let extent = high - low;
        let largest = extent.max_element();
        if largest == 0.0 {
            return Self { corner: low, half: DVec3::ZERO, scale: 1.0 };
        }
        let scale = power_of_two_below(2.0 / largest);
        let grid = 1.0 / (scale * 4096.0);
        Self { corner: low, half: (extent / (2.0 * grid)).round() * grid, scale }
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

    fn ball(centre: DVec3, radius: f64) -> World {
        World { spheres: vec![Sphere { centre, radius, material: 0, radiance: None }], ..World::default() }
    }

    #[test]
    fn scales_by_powers_of_two_leave_the_frame_unchanged() {
        let p = DVec3::new(1.25, -0.3, 0.7);
        let at_one = Frame::of(&ball(DVec3::ONE, 1.7)).point(p);
        for k in [-40, -1, 1, 20, 40] {
            let s = f64::from_bits(((1023 + k) as u64) << 52);
            assert_eq!(Frame::of(&ball(DVec3::ONE * s, 1.7 * s)).point(p * s), at_one);
        }
    }

    #[test]
    fn coordinates_lie_within_one() {
        let frame = Frame::of(&ball(DVec3::new(1e7, 0.0, -3.0), 0.3));
        assert!(frame.point(DVec3::new(1e7 + 0.3, 0.0, -3.0)).abs().max_element() <= 1.0);
        let back = frame.to_world(frame.point(DVec3::new(1e7, 0.125, -3.0)).as_vec3().to_array());
        assert!((back[1] - 0.125).abs() < 1e-6 && (back[0] - 1e7).abs() < 1e-6);
    }
}
