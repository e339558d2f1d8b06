//! One kind of input, that `SMALTI_FUZZ` names.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use smalti_tests::fuzz::{KINDS, Kind};

static KIND: LazyLock<Kind> = LazyLock::new(|| {
    let name = std::env::var("SMALTI_FUZZ").expect("SMALTI_FUZZ names a kind of input");
    *KINDS.iter().find(|kind| kind.name == name).expect("a known kind")
});

fuzz_target!(|bytes: &[u8]| (KIND.ask)(bytes));
