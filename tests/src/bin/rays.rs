//! How many rays find a way out of a closed mesh at its edges and corners, and how many hit again what they leave? None, of
//! as many as anyone cares to trace.
//!
//! ```text
//! rays [--millions 1000] [--seed 1]
//! ```
//! Exit code 1 where one did. What starts within its own rounding of an edge can slip out there, a ray in a million or so:
//! that is counted too, and is no failure.

use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};

use anyhow::Result;
use glam::DVec3;
use rayon::prelude::*;
use smalti_core::accel::{Accel, List};
use smalti_core::scene::Scene;
use smalti_tests::arguments::numbers;
use smalti_tests::build::at;
use smalti_tests::closed::{SQUEEZES, leaks, shell, slips};
use smalti_tests::leaving::{Left, from_sphere, from_tetrahedron};
use smalti_tests::oracle::Random;

/// Rays of a piece of work.
const CHUNK: u64 = 1_000_000;

fn main() -> Result<ExitCode> {
    let [millions, seed] = numbers([("--millions", 1000), ("--seed", 1)])?;
    let leaked = shells(millions, seed, leaks);
    println!("aimed at edges and corners of closed meshes: {millions} million rays, {leaked} of them found a way out");
    let slipped = shells(millions, seed, slips);
    println!("left the inside of closed meshes anywhere: {millions} million rays, {slipped} of them found a way out");
    let (left, wrong) = leaving(millions, seed);
    let of = |rays: u64| rays / CHUNK;
    println!(
        "left tetrahedra and spheres: {} million rays outward, {} million through the inside of spheres; {} wrong",
        of(left.out),
        of(left.across),
        wrong.len()
    );
    wrong.iter().take(5).for_each(|wrong| println!("  {wrong}"));
    Ok(if leaked == 0 && wrong.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// A question to a closed mesh about a place, with so many rays: how many find a way out.
type Ask = fn(&Scene, &Accel, DVec3, u32, &mut Random) -> u32;

/// Rays out of closed meshes, small ones in a list and large ones in a tree, of any shape and anywhere.
fn shells(millions: u64, seed: u64, ask: Ask) -> u64 {
    let chunk = |number: u64| {
        let mut random = Random::new(seed << 32 | number);
        let squeeze = SQUEEZES[number as usize % SQUEEZES.len()];
        let away = if number % 8 < 4 { DVec3::ZERO } else { at(3.0, -40.0, 1000.0) };
        let scene = shell(if number.is_multiple_of(3) { (8, 5) } else { (48, 24) }, squeeze, away, &mut random);
        let prims = 0..scene.shades.len() as u32;
        let accel = match List::new(&scene, prims.clone()) {
            Some(list) if number.is_multiple_of(3) => Accel { list, tree: None },
            _ => Accel::tree_only(&scene, &prims.collect::<Vec<u32>>()),
        };
        u64::from(ask(&scene, &accel, away, CHUNK as u32, &mut random))
    };
    (0..millions).into_par_iter().map(chunk).sum()
}

/// Rays that leave solids in rooms, until there are enough; and what went wrong.
fn leaving(millions: u64, seed: u64) -> (Left, Vec<String>) {
    let traced = AtomicU64::new(0);
    let worker = |number: u64| {
        let mut random = Random::new((seed + 1000) << 32 | number);
        let (mut left, mut wrong) = (Left::default(), Vec::new());
        while traced.load(Ordering::Relaxed) < millions * CHUNK {
            let before = left.out + left.across;
            for found in [from_tetrahedron(60, &mut random), from_sphere(60, &mut random)] {
                match found {
                    Ok(more) => left += more,
                    Err(fault) => wrong.push(fault),
                }
            }
            traced.fetch_add(left.out + left.across - before, Ordering::Relaxed);
        }
        (left, wrong)
    };
    let of_workers: Vec<_> = (0..rayon::current_num_threads() as u64).into_par_iter().map(worker).collect();
    of_workers.into_iter().fold((Left::default(), Vec::new()), |(mut left, mut wrong), (more, faults)| {
        left += more;
        wrong.extend(faults);
        (left, wrong)
    })
}
