//! Ctrl-C and its relatives: once ends the work and keeps it, twice leaves at once, as does once while there is no work to
//! keep yet.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};

use smalti_scheduler::Cancel;

use crate::print::Messages;

/// Listens for SIGINT, SIGTERM and SIGHUP.
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    /// Set by the first signal.
    pub cancel: Cancel,
    /// The first signal; 0: none yet.
    first: Arc<AtomicI32>,
    /// Whether there is work to keep.
    keeps: Arc<AtomicBool>,
}

/// What is done at signals by which the process leaves at once.
#[derive(Clone, Copy, Debug)]
pub struct Farewell {
    /// Puts the terminal in order.
    pub restore: fn(),
    /// Where it is told that nothing is kept.
    pub messages: Messages,
}

impl Farewell {
    #[cfg(unix)]
    fn leave(self, signal: i32, keeps: bool) -> ! {
        (self.restore)();
        if !keeps {
            self.messages
                .warning(&format!("interrupted by {} before the first sample: nothing is written", name(signal)));
        }
        std::process::exit(128 + signal)
    }
}

impl Interrupt {
    /// The signal that asked for the end.
    pub fn signal(&self) -> Option<i32> {
        Some(self.first.load(Ordering::Relaxed)).filter(|&signal| signal != 0)
    }

    /// Notes that from now on there is work to keep: before, the process leaves at the first signal.
    pub fn keep(&self) {
        self.keeps.store(true, Ordering::Relaxed);
    }

    /// Takes note of `signal`; true if it is not the first.
    fn receive(&self, signal: i32) -> bool {
        let again = self.first.compare_exchange(0, signal, Ordering::Relaxed, Ordering::Relaxed).is_err();
        self.cancel.cancel();
        again
    }
}

/// Starts to listen, but not to signals that whoever started us wants ignored (`nohup`).
#[cfg(unix)]
pub fn listen(farewell: Farewell) -> std::io::Result<Interrupt> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};

    let interrupt = Interrupt::default();
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let heard = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|&signal| !ignores(&status, signal));
    let mut signals = signal_hook::iterator::Signals::new(heard)?;
    let shared = interrupt.clone();
    let forever = move || {
        for signal in signals.forever() {
            let keeps = shared.keeps.load(Ordering::Relaxed);
            if shared.receive(signal) || !keeps {
                farewell.leave(signal, keeps);
            }
        }
    };
    std::thread::Builder::new().name("signals".into()).spawn(forever)?;
    Ok(interrupt)
}

/// Whether a process with this `/proc` status ignores `signal`.
#[cfg(unix)]
fn ignores(status: &str, signal: i32) -> bool {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|digits| u64::from_str_radix(digits.trim(), 16).ok()).unwrap_or(0);
    mask >> (signal - 1) & 1 == 1
}

/// Where there are no such signals Ctrl-C ends the process at once.
#[cfg(not(unix))]
pub fn listen(_: Farewell) -> std::io::Result<Interrupt> {
    Ok(Interrupt::default())
}

/// The name of a signal that [`listen`] hears.
pub fn name(signal: i32) -> &'static str {
    match signal {
        1 => "SIGHUP",
        2 => "SIGINT",
        _ => "SIGTERM",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_signal_counts_and_cancels() {
        let interrupt = Interrupt::default();
        assert_eq!((interrupt.signal(), interrupt.cancel.is_cancelled()), (None, false));
        assert!(!interrupt.receive(15));
        assert!(interrupt.receive(2));
        assert_eq!((interrupt.signal(), interrupt.cancel.is_cancelled()), (Some(15), true));
    }

    #[cfg(unix)]
    #[test]
    fn ignored_signals_are_read_from_the_mask() {
        let status = "SigBlk:\t0000000000000002\nSigIgn:\t0000000000001001\n";
        assert_eq!([1, 2, 13, 15].map(|signal| ignores(status, signal)), [true, false, true, false]);
        assert!(!ignores("", 1));
    }
}
