//! What was found by fuzzing stays found, and files with random damage are answered: for each kind of input the corpus, and
//! damage to it. (A coverage-guided fuzzer for as long as anyone likes: `just fuzz`.)

use std::fs;
use std::path::PathBuf;

use rand_core::SeedableRng;
use rand_xoshiro::Xoshiro128PlusPlus;
use rayon::prelude::*;
use smalti_tests::draw::repository;
use smalti_tests::fuzz::{KINDS, Kind, damage};

/// Damaged inputs of each kind.
const DAMAGED: usize = 1000;

/// The corpus of a kind, in the order of the names.
fn corpus(kind: &Kind) -> Vec<Vec<u8>> {
    let entries = fs::read_dir(repository().join("tests/corpus").join(kind.name)).expect("a corpus");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    assert!(!paths.is_empty(), "there is no corpus of {}", kind.name);
    paths.into_iter().map(|path| fs::read(path).expect("an input")).collect()
}

#[test]
fn everything_in_the_corpus_is_answered() {
    for kind in &KINDS {
        corpus(kind).par_iter().for_each(|input| (kind.ask)(input));
    }
}

#[test]
fn damaged_inputs_are_answered() {
    for (number, kind) in KINDS.iter().enumerate() {
        let corpus = corpus(kind);
        (0..DAMAGED).into_par_iter().for_each(|case| {
            let mut random = Xoshiro128PlusPlus::seed_from_u64((number * DAMAGED + case) as u64);
            let mut input = corpus[case % corpus.len()].clone();
            (0..=case % 3).for_each(|_| input = damage(&input, &mut random));
            (kind.ask)(&input);
        });
    }
}
