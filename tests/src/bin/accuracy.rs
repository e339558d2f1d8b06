//! How far the kernels are from the truth: the table of docs/kernels.md.
//!
//! ```text
//! accuracy [--thousands 5000] [--seed 1]
//! ```
//! Exit code 1 where a kernel does not keep its bound.

use std::process::ExitCode;

use anyhow::Result;
use rayon::prelude::*;
use smalti_tests::accuracy::{KERNELS, Kernel, Worst};
use smalti_tests::arguments::numbers;
use smalti_tests::oracle::Random;

/// Arguments of a piece of work, in thousands.
const CHUNK: u64 = 100;

fn main() -> Result<ExitCode> {
    let [thousands, seed] = numbers([("--thousands", 5000), ("--seed", 1)])?;
    println!("| kernel | domain | error | found | bound |\n|---|---|---|---:|---:|");
    let mut kept = true;
    for (number, Kernel { name, domain, measure, bound, worst }) in KERNELS.iter().enumerate() {
        let chunk = |chunk: u64| worst(&mut Random::new(seed << 32 | chunk << 8 | number as u64), 1000 * CHUNK as u32);
        let found = (0..thousands.div_ceil(CHUNK)).into_par_iter().map(chunk);
        let found = found.reduce(Worst::default, |a, b| a.or(b.error, b.at));
        kept &= found.error <= *bound;
        println!("| {name} | {domain} | {measure} | {:.1e} | {bound:.1e} |", found.error);
        if found.error > *bound {
            eprintln!("{name}: {:e} at {:?}", found.error, found.at);
        }
    }
    Ok(if kept { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
