//! What is said at the end: where the time went.

use smalti_core::settings::Rect;

use super::Title;
use super::numbers;
use super::tally::{End, Tally};

/// More workers than this are summed up.
const NAMED: usize = 16;

/// The summary, line by line, not cut to any width.
pub fn lines(title: &Title, tally: &Tally, end: &End) -> Vec<String> {
    let mut lines = vec![whole(title, tally, end)];
    lines.extend(tiles(end));
    lines.extend(idle(&end.timing.idle()));
    lines
}

fn whole(title: &Title, tally: &Tally, end: &End) -> String {
    let done = match end.interrupted {
        true => "interrupted".to_owned() + &tally.total.map_or(String::new(), |total| at(tally.done, total)),
        false => "done".to_owned(),
    };
    let passes = match end.timing.passes {
        1 => "1 pass".to_owned(),
        passes => format!("{passes} passes"),
    };
    let (setup, render) = (numbers::duration(title.setup), numbers::duration(end.timing.elapsed));
    format!("{done}: set-up {setup}, render {render} in {passes}, {}", numbers::rays(tally.rays_per_second()))
}

fn at(done: u64, total: u64) -> String {
    format!(" at {}", numbers::done(done, total))
}

fn tiles(end: &End) -> Option<String> {
    let balance = end.timing.balance()?;
    let times = [balance.min, balance.median, balance.max].map(numbers::duration);
    let Rect { x, y, width, height } = balance.slowest;
    let [min, median, max] = times;
    let count = end.timing.tiles.len();
    Some(format!("tiles {count}: min {min}, median {median}, max {max}; slowest at {x},{y} ({width}x{height})"))
}

/// The idle share of each worker, or of the least, the middle and the most idle one of many.
fn idle(shares: &[f64]) -> Option<String> {
    let list = |shares: &[f64]| shares.iter().map(|share| numbers::share(*share)).collect::<Vec<_>>().join(", ");
    let mut sorted = shares.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => None,
        1..=NAMED => Some(format!("idle {}", list(shares))),
        many => {
            Some(format!("idle min, median, max of {many}: {}", list(&[sorted[0], sorted[many / 2], sorted[many - 1]])))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frontend::fixture;

    #[test]
    fn tells_where_the_time_went() {
        let mut tally = fixture::half_way(2);
        for (interrupted, start) in [(false, "done"), (true, "interrupted at 50 %")] {
            tally.hear(&fixture::finished(interrupted));
            let lines = lines(&fixture::title(), &tally, tally.end.as_ref().unwrap());
            assert_eq!(lines[0], format!("{start}: set-up 120 ms, render 1.0 s in 7 passes, 1.60 Mrays/s"));
            assert_eq!(lines[1], "tiles 16: min 1.00 ms, median 9.00 ms, max 16.0 ms; slowest at 58,68 (16x16)");
            assert_eq!(lines[2..], ["idle 1.0 %, 30 %"]);
        }
    }

    #[test]
    fn many_workers_are_summed_up() {
        let shares: Vec<f64> = (0..17).rev().map(|n| f64::from(n) / 100.0).collect();
        assert_eq!(idle(&shares[..]).unwrap(), "idle min, median, max of 17: 0.00 %, 8.0 %, 16 %");
        assert_eq!(idle(&shares[15..]).unwrap(), "idle 1.0 %, 0.00 %");
        assert_eq!(idle(&[]), None);
    }
}
