use glam::DVec3;
use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;

use super::*;

/// Places in the plane z = 0.
fn flat(places: &[[f64; 2]]) -> Vec<DVec3> {
    places.iter().map(|[x, y]| DVec3::new(*x, *y, 0.0)).collect()
}

/// As a mesh has it: the fan where that covers the face.
fn triangles(corners: &[DVec3]) -> Cut {
    if fan_covers(corners.len(), |corner| corners[corner]) {
        let triangles = (1..corners.len() - 1).map(|i| [0, i, i + 1]).collect();
        return Cut { triangles, crosses: false };
    }
    cut(corners)
}

fn vector(corners: &[DVec3], triangle: [usize; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|corner| corners[corner]);
    (b - a).cross(c - a) / 2.0
}

/// The sum of the areas of all triangles, which overlap if it is more than that of the face.
fn area(corners: &[DVec3]) -> f64 {
    let cut = triangles(corners);
    assert!(!cut.crosses, "{corners:?}");
    cut.triangles.iter().map(|triangle| vector(corners, *triangle).length()).sum()
}

/// The area is right from every first corner, in both windings, slanted, far away and at any unit of length; and all
/// triangles face the way of the face.
fn assert_area(corners: &[DVec3], expected: f64) {
    // Onto slanted planes, without rounding.
    let slants = [
        [DVec3::X, DVec3::Y],
        [DVec3::new(1., 0., 1.), DVec3::new(0., 1., 2.)],
        [DVec3::new(0., 1., 2.), DVec3::new(1., 0., 4.)],
        [DVec3::new(-4., 2., 1.), DVec3::new(1., 2., 0.)],
    ];
    let mut corners = corners.to_vec();
    for wound in [1.0, -1.0] {
        for start in 0..corners.len().min(40) {
            for [x, y] in slants {
                let slanted: Vec<DVec3> = corners.iter().map(|corner| x * corner.x + y * corner.y).collect();
                let ratio = area(&slanted) / (expected * x.cross(y).length());
                assert!((ratio - 1.0).abs() < 1e-9, "{ratio} from {start}: {slanted:?}");
            }
            let cut = triangles(&corners);
            assert!(cut.triangles.iter().all(|triangle| vector(&corners, *triangle).z * wound > 0.0), "{corners:?}");
            for power in [-1000, -40, 3, 900] {
                let unit = libm::scalbn(1.0, power);
                assert_eq!(
                    triangles(&corners.iter().map(|corner| *corner * unit).collect::<Vec<_>>()),
                    cut,
                    "2^{power}"
                );
            }
            let away = DVec3::new(1048576.0, -4096.0, 65536.0);
            assert_eq!(triangles(&corners.iter().map(|corner| *corner + away).collect::<Vec<_>>()), cut);
            corners.rotate_left(1);
        }
        corners.reverse();
    }
}

const U: [[f64; 2]; 8] = [[-1., -1.], [1., -1.], [1., 1.], [0.5, 1.], [0.5, -0.5], [-0.5, -0.5], [-0.5, 1.], [-1., 1.]];

#[test]
fn concave_faces_have_their_area() {
    assert_area(&flat(&U), 2.5);
    assert_area(&flat(&[[0., 0.], [2., 1.], [0., 2.], [0.5, 1.]]), 1.5);
    assert_area(&flat(&[[0., 0.], [3., 0.], [3., 1.], [2., 1.], [2., 2.], [3., 2.], [3., 3.], [0., 3.]]), 8.0);
    // A comb with five teeth of 1 × 4 on a back of 9 × 1, and a spiral of width 1.
    let gap = |k: i32| [[1., 5.], [0., 5.], [0., 1.], [-1., 1.]].map(|[x, y]| [x + 2.0 * f64::from(k), y]);
    let mut comb: Vec<[f64; 2]> = [[0., 0.], [9., 0.]].into_iter().chain((0..5).rev().flat_map(gap)).collect();
    comb.truncate(comb.len() - 2);
    assert_area(&flat(&comb), 9.0 + 20.0);
    let spiral = [
        [0., 0.],
        [5., 0.],
        [5., 5.],
        [1., 5.],
        [1., 2.],
        [3., 2.],
        [3., 3.],
        [2., 3.],
        [2., 4.],
        [4., 4.],
        [4., 1.],
        [0., 1.],
    ];
    assert_area(&flat(&spiral), 15.0);
}

#[test]
fn corners_on_a_line_and_corners_twice_add_nothing() {
    assert_area(&flat(&[[0., 0.], [1., 0.], [2., 0.], [2., 1.], [2., 2.], [1., 2.], [0., 2.], [0., 1.]]), 4.0);
    assert_area(&flat(&[[0., 0.], [0., 0.], [2., 0.], [2., 0.], [2., 2.], [0., 2.], [0., 2.], [0., 0.]]), 4.0);
    assert_area(&flat(&[[0., 0.], [3., 0.], [2., 0.], [2., 2.], [0., 2.]]), 4.0);
    assert_area(&flat(&[[0., 0.], [1., 0.], [2., 0.], [3., 0.], [0., 3.]]), 4.5);
    let straight = flat(&[[0., 0.], [1., 0.], [2., 0.], [3., 0.], [1.5, 0.]]);
    assert!(triangles(&straight).triangles.iter().all(|triangle| vector(&straight, *triangle) == DVec3::ZERO));
    assert!(!triangles(&straight).crosses);
}

/// Holes are written as a path that goes in, round the hole the other way, and out where it came in.
#[test]
fn faces_with_holes_have_their_area() {
    let square = [[0., 0.], [4., 0.], [4., 4.], [0., 4.], [0., 0.]];
    let one = [[1., 1.], [1., 3.], [3., 3.], [3., 1.], [1., 1.]];
    assert_area(&flat(&[&square[..], &one].concat()), 12.0);
    let small = |x: f64, y: f64| [[x, y], [x, y + 1.], [x + 1., y + 1.], [x + 1., y], [x, y]];
    let two = [&square[..], &small(0.5, 0.5), &[[0., 0.]], &small(2.5, 0.25)].concat();
    assert_area(&flat(&two), 14.0);
    // The hole touches the edge in a corner: that corner stands there twice.
    let touching = [[0., 0.], [2., 0.], [1., 1.], [2., 2.], [3., 1.], [2., 0.], [4., 0.], [4., 4.], [0., 4.]];
    assert_area(&flat(&touching), 14.0);
}

#[test]
fn faces_that_cross_themselves_are_known() {
    let even = flat(&[[0., 0.], [1., 1.], [1., 0.], [0., 1.]]);
    let uneven = flat(&[[0., 0.], [3., 3.], [3., 0.], [0., 1.]]);
    let star = |k: i32| libm::sincos(f64::from(2 * k) * 1.256_637_061_435_917_3);
    let star: Vec<DVec3> = (0..5).map(star).map(|(y, x)| DVec3::new(x, y, 0.0)).collect();
    for face in [&even, &uneven, &star] {
        let cut = triangles(face);
        assert!(cut.crosses, "{face:?}");
        assert_eq!((cut.triangles.len(), triangles(face)), (face.len() - 2, cut));
    }
}

/// A quad that is folded along its first diagonal keeps its fan; and what is not quite flat is cut as if it were.
#[test]
fn faces_that_are_not_flat() {
    let folded = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.5, 0.5, 1.0)];
    assert_eq!(triangles(&folded).triangles, [[0, 1, 2], [0, 2, 3]]);
    let mut bent = flat(&U);
    bent.iter_mut().enumerate().for_each(|(index, corner)| corner.z = 1e-3 * [1.0, -1.0][index % 2]);
    assert!((area(&bent) / 2.5 - 1.0).abs() < 1e-3);
}

/// A star of random arms has the area of its triangles about the centre, whatever its corners.
#[test]
fn random_faces_have_their_area() {
    let mut random = Xoshiro128PlusPlus::seed_from_u64(7);
    let mut fraction = || f64::from(random.next_u32() >> 8) / f64::from(1 << 24);
    for case in 0..300 {
        let count = 4 + case % 60;
        let place = |k: usize, arm: f64| {
            let (sin, cos) = libm::sincos(k as f64 / count as f64 * std::f64::consts::TAU);
            // On a grid, so that corners meet lines.
            [(cos * arm * 64.0).round(), (sin * arm * 64.0).round()]
        };
        let places: Vec<[f64; 2]> = (0..count).map(|k| place(k, 0.3 + 0.7 * fraction())).collect();
        let double: f64 =
            (0..count).map(|k| (places[k], places[(k + 1) % count])).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
        let face = flat(&places);
        let cut = triangles(&face);
        let sum: f64 = cut.triangles.iter().map(|triangle| vector(&face, *triangle).z).sum();
        assert!(cut.triangles.iter().all(|triangle| vector(&face, *triangle).z > 0.0), "{places:?}");
        assert_eq!((sum * 2.0, cut.crosses), (double, false), "{places:?}");
    }
}

/// A gear of many teeth and a long strip: both take a moment, not a minute.
#[test]
fn faces_of_many_corners_are_cut_soon() {
    let count = 20_000;
    let gear = |k: usize| {
        let (sin, cos) = libm::sincos(k as f64 / count as f64 * std::f64::consts::TAU);
        let arm = [1.0, 0.9][k % 2];
        [cos * arm, sin * arm]
    };
    let places: Vec<[f64; 2]> = (0..count).map(gear).collect();
    let wave = |k: usize| [k as f64, 3.0 * libm::sin(k as f64 * 0.1)];
    let above = (0..count / 2).rev().map(wave).map(|[x, y]| [x, y + 0.01]);
    let strip: Vec<[f64; 2]> = (0..count / 2).map(wave).chain(above).collect();
    for (places, expected) in [
        (places, 0.9 * libm::sin(std::f64::consts::TAU / count as f64) * count as f64 / 2.0),
        (strip, 0.01 * (count / 2 - 1) as f64),
    ] {
        let found = area(&flat(&places));
        assert!((found / expected - 1.0).abs() < 1e-6, "{found} is not {expected}");
    }
}

/// The outline of a maze whose walls are as thin as nothing: it passes every wall twice and meets itself in every corner,
/// and its area is that of all its rooms.
#[test]
fn mazes_have_the_area_of_their_rooms() {
    for seed in 0..40 {
        let side = 2 + seed as usize % 9;
        let mut maze = Maze {
            side,
            seen: vec![false; side * side],
            random: Xoshiro128PlusPlus::seed_from_u64(seed),
            outline: vec![],
        };
        maze.walk([0, 0], 3);
        maze.outline.push([0.0, 0.0]);
        let mut outline = flat(&maze.outline);
        for start in 0..4 {
            assert!((area(&outline) - maze.rooms()).abs() < 1e-9, "maze {seed} from {start}");
            outline.rotate_left(maze.outline.len() / 4);
        }
    }
}

struct Maze {
    side: usize,
    seen: Vec<bool>,
    random: Xoshiro128PlusPlus,
    outline: Vec<[f64; 2]>,
}

impl Maze {
    /// Rooms that can be reached: 1 each.
    fn rooms(&self) -> f64 {
        self.seen.iter().filter(|seen| **seen).count() as f64
    }

    /// Goes round a room and the rooms behind it with a hand on the wall, having come in by wall `door`.
    fn walk(&mut self, [x, y]: [usize; 2], door: usize) {
        // Walls counter-clockwise from the one below: the room behind, and the corner where the wall ends.
        let walls = [([0, -1], [1, 0]), ([1, 0], [1, 1]), ([0, 1], [0, 1]), ([-1, 0], [0, 0])];
        self.seen[y * self.side + x] = true;
        for wall in (door + 1..door + 4).map(|wall| wall % 4) {
            let ([dx, dy], [right, up]) = walls[wall];
            let behind = [x.wrapping_add_signed(dx), y.wrapping_add_signed(dy)];
            let is_new = behind.iter().all(|at| *at < self.side) && !self.seen[behind[1] * self.side + behind[0]];
            if is_new && !self.random.next_u32().is_multiple_of(4) {
                self.walk(behind, (wall + 2) % 4);
            } else {
                self.outline.push([(x + right) as f64, (y + up) as f64]);
            }
        }
    }
}
