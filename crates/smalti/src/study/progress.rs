//! How far a study is: a bar on a terminal, a line for each render in a log, JSON lines for machines.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::json;
use smalti_report::{Arm, Run};

use crate::frontend::{Mode, numbers};
use crate::print;

/// What shows how far a study is.
pub struct Progress {
    shown: Shown,
    begun: Instant,
    /// Renders to do, those included that were done before.
    total: usize,
    done: usize,
}

enum Shown {
    Bar(ProgressBar),
    Plain,
    Json,
    Nothing,
}

impl Progress {
    /// Of a study of `total` renders, `done` of which are there already.
    pub fn new(mode: Mode, total: usize, done: usize) -> Self {
        let shown = match mode {
            Mode::Bar(_) => Shown::Bar(bar(total)),
            Mode::Plain => Shown::Plain,
            Mode::Json => Shown::Json,
            Mode::None => Shown::Nothing,
        };
        Self { shown, begun: Instant::now(), total, done }
    }

    /// A sentence about the study.
    pub fn say(&self, text: &str) {
        match &self.shown {
            Shown::Bar(bar) => bar.suspend(|| print::write_line(text)),
            Shown::Plain => print::write_line(text),
            Shown::Json => print::write_line(&json!({ "event": "study", "message": text }).to_string()),
            Shown::Nothing => {}
        }
    }

    /// What begins now; `rest` says how long everything will take from here on.
    pub fn begin(&self, what: &str, rest: Option<[f64; 2]>) {
        let Shown::Bar(bar) = &self.shown else { return };
        bar.set_position(self.done as u64);
        bar.set_message(match rest {
            Some(rest) => format!("{what}  {} left", left(rest)),
            None => what.to_owned(),
        });
        bar.tick();
    }

    /// A render of the study is done.
    pub fn finished(&mut self, arm: &Arm, run: &Run, rest: Option<[f64; 2]>) {
        self.done += 1;
        match self.shown {
            Shown::Plain => print::write_line(&self.line(arm, run, rest)),
            Shown::Json => print::write_line(&self.fact(arm, run).to_string()),
            Shown::Bar(_) | Shown::Nothing => {}
        }
    }

    fn line(&self, arm: &Arm, run: &Run, rest: Option<[f64; 2]>) -> String {
        let seconds = numbers::duration(Duration::from_secs_f64(run.seconds));
        let error = numbers::share(run.relative_error);
        let rest = rest.filter(|_| self.done < self.total);
        let rest = rest.map(|rest| format!("; {} left", left(rest))).unwrap_or_default();
        format!("{} of {}: {}, {seconds}, error {error}{rest}", self.done, self.total, arm.name)
    }

    fn fact(&self, arm: &Arm, run: &Run) -> serde_json::Value {
        json!({
            "event": "run_finished",
            "done": self.done,
            "total": self.total,
            "arm": arm.name,
            "repetition": run.repetition,
            "seconds": run.seconds,
            "relative_error": run.relative_error,
            "elapsed": self.begun.elapsed().as_secs_f64(),
        })
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Shown::Bar(bar) = &self.shown {
            bar.finish_and_clear();
        }
    }
}

fn bar(total: usize) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(total as u64), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{bar:24} {pos}/{len}  {elapsed}  {msg}").expect("a fixed template");
    // Once a second: what is timed must not wait for it.
    bar.enable_steady_tick(Duration::from_secs(1));
    bar.with_style(style.progress_chars("█▉▊▋▌▍▎▏ "))
}

fn left(rest: [f64; 2]) -> String {
    let [low, high] = rest.map(|seconds| Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX));
    numbers::range(low, high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::fixture::{arm, run};

    #[test]
    fn a_log_has_a_line_for_each_render() {
        let mut progress = Progress::new(Mode::None, 3, 1);
        progress.finished(&arm("auto"), &run(1, 0, 2.4, 0.1), None);
        assert_eq!(
            progress.line(&arm("auto"), &run(1, 0, 2.4, 0.1), Some([60.2, 70.0])),
            "2 of 3: auto, 2.4 s, error 10 %; 60-70 s left"
        );
        progress.finished(&arm("auto"), &run(1, 0, 2.4, 0.1), None);
        assert!(progress.line(&arm("auto"), &run(1, 0, 2.4, 0.1), Some([0.0, 0.0])).ends_with("error 10 %"));
    }

    #[test]
    fn machines_get_facts() {
        let progress = Progress::new(Mode::None, 3, 1);
        let fact = progress.fact(&arm("auto"), &run(1, 0, 2.4, 0.1));
        assert_eq!(
            (&fact["event"], &fact["total"], &fact["seconds"]),
            (&"run_finished".into(), &3.into(), &2.4.into())
        );
    }
}
