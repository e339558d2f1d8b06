//! Adaptive sampling: how many rounds each tile takes of the passes to come.
//!
//! Passes come in stages, each as long as all before it. Before a stage the noise so far says which part ρ of the mean
//! number of samples a tile is to take (Neyman 1934: as the root of its variance by its cost), and each of its samples
//! counts 1 / ρ times. A tile that was unlucky, or is black, still takes its least part, and the next stage judges anew.
//! What a stage takes is decided before it is begun, so the image has no bias, however wrong the decision was.

use smalti_core::settings::Rect;

/// Side of the tiles that take more or fewer samples: 256 pixels, which with a round of 16 samples are a batch of paths.
pub const SIDE: u32 = 16;

/// Rounds that every tile takes before anything is decided.
pub const AHEAD: u32 = 4;

/// The least part of the mean number of samples that a tile takes.
const LEAST: f64 = 0.25;

/// The greatest.
const MOST: f64 = 8.0;

/// What is known of a tile.
#[derive(Clone, Copy, Debug)]
pub struct Need {
    /// Where it lies.
    pub area: Rect,
    /// What one sample of each pixel leaves of squared error.
    pub noise: f64,
    /// Rays of a sample of each pixel.
    pub cost: f64,
}

/// What tiles take of a stage.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stage {
    /// The pass before its first.
    from: u32,
    /// Its passes.
    passes: u32,
    /// Rounds that each tile takes of it, at least 1.
    rounds: Vec<u32>,
}

impl Stage {
    /// The stage that begins after `from` passes, at least one, as long as all before it.
    pub fn new(from: u32, needs: &[Need]) -> Self {
        let rounds = |part: f64| ((part * f64::from(from)).round() as u32).max(1);
        Self { from, passes: from, rounds: parts(needs).into_iter().map(rounds).collect() }
    }

    /// Whether pass `pass` (from 0) is one of its own.
    pub fn has(&self, pass: u32) -> bool {
        (self.from..self.from + self.passes).contains(&pass)
    }

    /// Rounds that `tile` takes of pass `pass`, and how often each sample counts.
    pub fn rounds(&self, tile: usize, pass: u32) -> (u32, f64) {
        let until = |passes: u32| (u64::from(passes) * u64::from(self.rounds[tile]) / u64::from(self.passes)) as u32;
        let number = pass - self.from;
        (until(number + 1) - until(number), f64::from(self.passes) / f64::from(self.rounds[tile]))
    }
}

/// The part of the mean number of samples that each tile takes, such that all take as long as if each took the mean.
fn parts(needs: &[Need]) -> Vec<f64> {
    let wanted: Vec<f64> =
        smoothed(needs).into_iter().zip(needs).map(|(noise, need)| (noise / need.cost).sqrt()).collect();
    let clamped = |scale: f64| -> Vec<f64> { wanted.iter().map(|part| (part * scale).clamp(LEAST, MOST)).collect() };
    let all: f64 = needs.iter().map(|need| need.cost).sum();
    let spent = |parts: &[f64]| parts.iter().zip(needs).map(|(part, need)| part * need.cost).sum::<f64>();
    // What is spent grows with the scale: bisection of its exponent.
    let (mut low, mut high) = (-200.0, 200.0);
    for _ in 0..100 {
        let middle = (low + high) / 2.0;
        if spent(&clamped(libm::exp2(middle))) > all { high = middle } else { low = middle }
    }
    let parts = clamped(libm::exp2(low));
    if parts.iter().all(|part| part.is_finite()) { parts } else { vec![1.0; needs.len()] }
}

/// The noise of each tile, half of it its own and half that of the tiles around it: what is found by chance is not far
/// from where it will be found next.
fn smoothed(needs: &[Need]) -> Vec<f64> {
    let index: std::collections::HashMap<(u32, u32), f64> =
        needs.iter().map(|need| ((need.area.x, need.area.y), need.noise)).collect();
    let around = |area: Rect| {
        let steps = [-1i64, 0, 1].into_iter().flat_map(|y| [-1i64, 0, 1].map(|x| (x, y)));
        let place = move |(x, y)| Some((moved(area.x, x)?, moved(area.y, y)?));
        let near: Vec<f64> = steps.filter_map(place).filter_map(|place| index.get(&place).copied()).collect();
        near.iter().sum::<f64>() / near.len() as f64
    };
    needs.iter().map(|need| (need.noise + around(need.area)) / 2.0).collect()
}

fn moved(from: u32, tiles: i64) -> Option<u32> {
    u32::try_from(i64::from(from) + tiles * i64::from(SIDE)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn need(x: u32, noise: f64, cost: f64) -> Need {
        Need { area: Rect { x: x * SIDE, y: 0, width: SIDE, height: SIDE }, noise, cost }
    }

    #[test]
    fn samples_go_as_the_root_of_noise_by_cost_and_take_as_long() {
        // Far apart: nothing is smoothed.
        let needs = [need(0, 4.0, 1.0), need(9, 1.0, 1.0), need(18, 4.0, 4.0)];
        let parts = parts(&needs);
        assert!((parts[0] / parts[1] - 2.0).abs() < 1e-9 && (parts[2] / parts[1] - 1.0).abs() < 1e-9, "{parts:?}");
        assert!((parts[0] + parts[1] + 4.0 * parts[2] - 6.0).abs() < 1e-9);
    }

    #[test]
    fn nothing_stops_and_nothing_takes_all() {
        let mut needs: Vec<Need> = (0..100).map(|x| need(9 * x, 0.0, 1.0)).collect();
        needs[7].noise = 1.0;
        let found = parts(&needs);
        assert_eq!((found[7], found[0]), (MOST, LEAST));
        assert_eq!(parts(&[need(0, 0.0, 1.0), need(9, 0.0, 2.0)]).len(), 2);
    }

    #[test]
    fn a_stage_adds_up_and_samples_count_as_if_all_took_the_mean() {
        let needs: Vec<Need> = (0..50).map(|x| need(9 * x, f64::from(x * x), 1.0)).collect();
        for from in [4, 8, 64] {
            let stage = Stage::new(from, &needs);
            assert!(stage.has(from) && stage.has(2 * from - 1) && !stage.has(2 * from));
            for tile in 0..50 {
                let taken = (from..2 * from).map(|pass| stage.rounds(tile, pass));
                let weight: f64 = taken.clone().map(|(rounds, weight)| f64::from(rounds) * weight).sum();
                assert!((weight - f64::from(from)).abs() < 1e-9 && taken.map(|(rounds, _)| rounds).sum::<u32>() >= 1);
            }
        }
    }

    #[test]
    fn neighbours_share_what_they_find() {
        let found = smoothed(&[need(0, 3.0, 1.0), need(1, 0.0, 1.0), need(2, 0.0, 1.0)]);
        assert_eq!(found, [2.25, 0.5, 0.0]);
    }
}
