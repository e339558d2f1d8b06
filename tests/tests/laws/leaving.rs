//! Rays that leave a surface do not hit it again, and hit nothing of a convex solid that they leave outward. (The same with
//! as many rays as anyone likes: `just rays`.)

use smalti_tests::leaving::{Left, from_sphere, from_tetrahedron};
use smalti_tests::oracle::Random;

fn rooms(seed: u64, each: fn(u32, &mut Random) -> Result<Left, String>) -> Left {
    let (mut random, mut left) = (Random::new(seed), Left::default());
    (0..400).for_each(|room| left += each(60, &mut random).unwrap_or_else(|wrong| panic!("room {room}: {wrong}")));
    left
}

#[test]
fn rays_that_leave_a_convex_solid_hit_nothing_of_it() {
    let left = rooms(41, from_tetrahedron);
    assert!(left.out > 200_000, "only {left:?}");
}

#[test]
fn rays_that_leave_a_sphere_meet_it_again_only_across_its_inside() {
    let left = rooms(42, from_sphere);
    assert!(left.out > 100_000 && left.across > 50_000, "only {left:?}");
}
