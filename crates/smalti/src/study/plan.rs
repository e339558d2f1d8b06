//! What a study will do: its ways to render and how often, before anything is rendered.

use smalti_core::scene::World;

use super::combine::{self, Turned};
use super::naming::{self, Named};
use super::way::Way;

/// What a study will do.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// What was asked: `sweep`, `report` ...
    pub preset: &'static str,
    /// The ways to render, and what is known of each.
    pub arms: Vec<Planned>,
    /// The arm that others are compared with.
    pub baseline: Option<usize>,
    /// What the samples of each arm are chosen by.
    pub budget: Budget,
    /// How long the reference may take, by the time of all runs.
    pub reference_share: f64,
}

/// One arm to be.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// How it is rendered. Its samples are not final where the budget chooses them.
    pub way: Way,
    /// What it is called; `None`: by what its knobs say.
    pub named: Option<Named>,
    /// A group other than by its knobs.
    pub group: Option<String>,
    /// Repetitions where none were asked for.
    pub repetitions: u32,
}

/// What the samples of an arm are chosen by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Budget {
    /// They are given.
    Samples,
    /// So that a render takes so many seconds.
    Seconds(f64),
    /// So that the relative error is this, where a render need not take longer than so many seconds for it.
    Error {
        /// The relative error.
        error: f64,
        /// Seconds that no render takes longer than, about.
        seconds: f64,
    },
}

/// Repetitions where nothing else is said.
pub const REPETITIONS: u32 = 3;

impl Planned {
    /// An arm with nothing special about it.
    pub fn new(way: Way) -> Self {
        Self { way, named: None, group: None, repetitions: REPETITIONS }
    }
}

impl Plan {
    /// A study of `ways`, compared with each other or with one of them.
    pub fn of(preset: &'static str, ways: Vec<Way>, baseline: Option<usize>) -> Self {
        let arms = ways.into_iter().map(Planned::new).collect();
        Self { preset, arms, baseline, budget: Budget::Samples, reference_share: 1.0 }
    }

    /// Repetitions of each arm: `asked`, or its own.
    pub fn repetitions(&self, asked: Option<u32>) -> Vec<u32> {
        self.arms.iter().map(|arm| asked.unwrap_or(arm.repetitions)).collect()
    }

    /// What each arm is called, by its final knobs.
    pub fn named(&self, turned: &[Turned]) -> Vec<Named> {
        let call = |(arm, named): (&Planned, Named)| {
            let group = arm.group.clone().unwrap_or_else(|| named.group.clone());
            arm.named.clone().unwrap_or(Named { group, ..named })
        };
        self.arms.iter().zip(naming::named(turned)).map(call).collect()
    }

    /// What the knobs of each arm say.
    pub fn turned(&self, world: &World) -> Vec<Turned> {
        self.arms.iter().map(|arm| combine::turned(&arm.way, world)).collect()
    }
}

/// The order of renders, each an arm and a repetition: all arms once, then all again, so that a machine that slows down
/// slows all alike.
pub fn interleaved(repetitions: &[u32]) -> Vec<(usize, u32)> {
    let most = repetitions.iter().copied().max().unwrap_or(0);
    let of = |repetition| {
        let due = move |&(_, repetitions): &(usize, &u32)| repetition < *repetitions;
        repetitions.iter().enumerate().filter(due).map(move |(arm, _)| (arm, repetition))
    };
    (0..most).flat_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_arms_once_then_all_again() {
        let expected = [(0, 0), (1, 0), (2, 0), (0, 1), (2, 1), (2, 2)];
        assert_eq!(interleaved(&[2, 1, 3]), expected);
        assert_eq!(interleaved(&[]), []);
    }
}
