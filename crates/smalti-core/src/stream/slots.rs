//! Where radiance goes: one slot a (pixel, sample) of the batch.

use crate::lanes::{Lanes, Rgb};

/// Radiance of the samples of a batch.
#[derive(Clone, Debug, Default)]
pub struct Slots {
    radiance: Vec<[f32; 3]>,
    /// Where photons are asked: what their radius may add, or half of it (see [`Slots::shift`]).
    shift: Vec<[f32; 3]>,
    /// Where paths find again what photons bring: the grey of what photons bring and of what paths find.
    twice: Vec<[f32; 2]>,
}

/// The two ways of finding the light of a caustic map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// By the photons of the map.
    Photons,
    /// By a path that meets the lamp.
    Paths,
}

impl Slots {
    /// `count` black slots; with `shift` also for what photon radii add, with `twice` for what is found in two ways.
    pub fn reset(&mut self, count: usize, shift: bool, twice: bool) {
        self.radiance.clear();
        self.radiance.resize(count, [0.0; 3]);
        self.shift.clear();
        self.shift.resize(if shift { count } else { 0 }, [0.0; 3]);
        self.twice.clear();
        self.twice.resize(if twice { count } else { 0 }, [0.0; 2]);
    }

    /// For each sample the grey of what photons bring and of what paths find again.
    pub fn twice(&self) -> &[[f32; 2]] {
        &self.twice
    }

    /// Adds to what is found in one of two ways, where that is noted.
    #[inline(always)]
    pub fn add_twice<L: Lanes>(&mut self, l: L, mask: L::M, slot: L::U, (way, radiance): (Way, Rgb<L>)) {
        if self.twice.is_empty() {
            return;
        }
        let (grey, none) = ((radiance.x + radiance.y + radiance.z) * l.f(1.0 / 3.0), l.f(0.0));
        let both = match way {
            Way::Photons => [grey, none],
            Way::Paths => [none, grey],
        };
        add(l, &mut self.twice, mask, slot, both);
    }

    /// For each sample the difference of what photons within their radius and within half of its disc say. As a disc's
    /// bias goes with its area, that is half of the radiance that the radius adds in error.
    pub fn shift(&self) -> &[[f32; 3]] {
        &self.shift
    }

    /// Adds to the shift.
    #[inline(always)]
    pub fn add_shift<L: Lanes>(&mut self, l: L, mask: L::M, slot: L::U, difference: Rgb<L>) {
        add(l, &mut self.shift, mask, slot, [difference.x, difference.y, difference.z]);
    }

    /// The samples.
    pub fn radiance(&self) -> &[[f32; 3]] {
        &self.radiance
    }

    /// Adds to the slots of the lanes `mask`, lane by lane (two lanes may share a slot). `slot` is the column
    /// [`SLOT`](super::SLOT).
    #[inline(always)]
    pub fn add<L: Lanes>(&mut self, l: L, mask: L::M, slot: L::U, radiance: Rgb<L>) {
        add(l, &mut self.radiance, mask, slot, [radiance.x, radiance.y, radiance.z]);
    }
}

#[inline(always)]
fn add<L: Lanes, const N: usize>(l: L, to: &mut [[f32; N]], mask: L::M, slot: L::U, values: [L::F; N]) {
    let mut slots = [0; 16];
    let mut columns = [[0.0; 16]; N];
    l.store_u(slot & l.u(0xffff), &mut slots);
    for (value, column) in values.into_iter().zip(&mut columns) {
        l.store(value, column);
    }
    let mut left = l.bitmask(mask);
    while left != 0 {
        let lane = left.trailing_zeros() as usize % 16;
        let sum = &mut to[slots[lane] as usize];
        for (sum, column) in sum.iter_mut().zip(&columns) {
            *sum += column[lane];
        }
        left &= left - 1;
    }
}
