//! Photon maps of the first rounds, which all pilots share: they do not depend on what is tried.

use std::sync::{Mutex, PoisonError};

use smalti_core::photon::Maps;
use smalti_core::photon::maps::{Kept, Pilots};
use smalti_scheduler::Shelf;

/// Bytes of maps that are kept at most; more are made anew for each pilot.
const MOST: u64 = 256 << 20;

/// Maps by their round.
#[derive(Default)]
pub struct PilotMaps(Mutex<Rounds>);

#[derive(Default)]
struct Rounds {
    kept: Vec<(Kept, Pilots)>,
    bytes: u64,
}

impl Shelf for PilotMaps {
    fn take(&self, round: u32) -> Option<(Kept, Pilots)> {
        let rounds = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        rounds.kept.iter().find(|(kept, _)| kept.round == round).cloned()
    }

    fn put(&self, maps: &Maps) {
        let mut rounds = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if rounds.bytes + maps.bytes() <= MOST {
            rounds.bytes += maps.bytes();
            rounds.kept.push((maps.kept(), maps.pilots()));
        }
    }
}
