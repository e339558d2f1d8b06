//! How far rays may start off primitives that are as near to another as rays usually start off a surface.

use super::Pair;
use crate::scene::Scene;

/// Part of a gap by which rays leave what is beside it.
const PART: f64 = 1.0 / 64.0;

/// The error of points on a plane, in steps of coordinates.
const OFF_FACES: f64 = 2.0;

/// The error of points on a sphere, in steps: a ray that starts nearer to it may start on the other side.
const OFF_SPHERES: f64 = 6.0;

/// Spheres with a gap of fewer steps are one: some rays would find the inner one, and some not.
const LEAST_SHELL: f64 = 12.0;

/// Room beside the primitives of a scene.
pub struct Room {
    /// For each primitive, to the side of its normal; ∞ where nothing is near.
    pub outside: Vec<f32>,
    /// To the other side.
    pub inside: Vec<f32>,
}

impl Room {
    /// Beside what these pairs are of; `None` where none has a gap.
    pub fn beside(scene: &Scene, pairs: &[(Pair, [u32; 2])]) -> Option<Self> {
        let mut gaps = pairs.iter().filter(|(pair, _)| !pair.coincides()).peekable();
        gaps.peek()?;
        let all = vec![f32::INFINITY; scene.shades.len()];
        let mut room = Self { outside: all.clone(), inside: all };
        for &(pair, [a, b]) in gaps {
            room.narrow(scene, a, pair);
            room.narrow(scene, b, pair.turned());
        }
        Some(room)
    }

    /// Leaves to rays beside a gap a small part of it: what they are absorbed by begins where they start. Never more than
    /// half of it between faces; these are not hit again by what leaves them, wherever it starts.
    fn narrow(&mut self, scene: &Scene, prim: u32, pair: Pair) {
        let gap = pair.gap.abs();
        let is_sphere = prim as usize >= scene.faces.len();
        if is_sphere && gap < LEAST_SHELL * pair.step {
            return;
        }
        let off = match is_sphere {
            true => (gap * PART).max(OFF_SPHERES * pair.step),
            false => (gap * PART).max(OFF_FACES * pair.step).min(gap / 2.0),
        };
        let side = if pair.gap < 0.0 { &mut self.inside } else { &mut self.outside };
        side[prim as usize] = side[prim as usize].min(off as f32);
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        (size_of_val(&self.outside[..]) + size_of_val(&self.inside[..])) as u64
    }
}
