//! Chances of lamps by the place of the vertex that looks for light.
//!
//! One table by power serves all vertices badly: a small lamp beside a vertex may bring it most of its light and yet be
//! chosen once in a million, and its light is then found by bounces that hit it, as rare bright samples. So a lamp's
//! chance is the irradiance that it can bring to the place at most, L · A · cosθ / d², with bounds of cosθ and d² that
//! hold for all its points (after Conty Estevez and Kulla 2018, "Importance sampling of many lights"; theirs are bounds
//! for nodes of a tree). A share by power stays, for what the bounds do not see: a near lamp may be hidden.
//!
//! Chances depend on the place alone, so that a path that hits a lamp weighs it by the same chance.

use crate::lanes::{Lanes, V3};

/// Lamps up to which chances go by place: each vertex goes through all of them.
pub const MOST: usize = 32;

/// Share of the choice that goes by power. In rooms whose near lamps are hidden, light of the others is then found at
/// least this much as often as by power alone.
pub const BY_POWER: f32 = 0.25;

/// The least squared distance, where it divides, in the frame.
const LEAST: f32 = 1e-24;

/// What is chosen as one: an emitting primitive with all its patches, a point light, or the environment.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lamp {
    /// Centre of the sphere around it, in the frame.
    pub centre: [f32; 3],
    /// Radius of that sphere, 0 for a point.
    pub radius: f32,
    /// Its normal; 0 where it shines all around.
    pub normal: [f32; 3],
    /// Added to the height above its plane; so large where it shines all around that any place is high above.
    pub lift: f32,
    /// Irradiance that it brings at most, times squared distance, as a fraction of the largest one of the table.
    pub strength: f32,
    /// Irradiance that it brings everywhere: the environment's. Same unit.
    pub everywhere: f32,
    /// Its share of the power of all.
    pub chance: f32,
    /// Its first row in the table.
    pub first: u32,
    /// Number of its rows.
    pub rows: u32,
}

/// All lamps of a table: those that can be hit first, by their emitter numbers.
#[derive(Clone, Debug, Default)]
pub struct Lamps {
    /// The lamps.
    pub lamps: Vec<Lamp>,
    /// For each row of the table: upper end of its share of [0, 1) among the rows of its lamp.
    pub within: Vec<f32>,
    /// Most rows of one lamp.
    pub most_rows: u32,
}

/// The lamps as seen from the places of a packet.
#[derive(Clone, Copy)]
pub struct Outlook<L: Lanes> {
    place: V3<L>,
    /// The share that goes by power: all, where nothing seems to arrive.
    by_power: L::F,
    /// The share that goes by place, by what all lamps bring.
    by_place: L::F,
}

impl Lamps {
    /// The lamps as seen from a place.
    #[inline(always)]
    pub fn seen_from<L: Lanes>(&self, l: L, place: V3<L>) -> Outlook<L> {
        let mut all = l.f(0.0);
        for lamp in &self.lamps {
            all = all + lamp.brings(l, place);
        }
        let lit = l.lt(l.f(0.0), all);
        Outlook {
            place,
            by_power: l.select(lit, l.f(BY_POWER), l.f(1.0)),
            by_place: l.keep(lit, l.f(1.0 - BY_POWER) / all),
        }
    }

    /// The row that `u` in [0, 1) falls on, and the chance of its lamp.
    #[inline(always)]
    pub fn choose<L: Lanes>(&self, l: L, outlook: &Outlook<L>, u: L::F) -> (L::U, L::F) {
        let (mut below, mut start, mut chance) = (l.f(0.0), l.f(0.0), l.f(0.0));
        let (mut row, mut rows) = (l.u(0), l.u(1));
        for lamp in self.lamps.iter().filter(|lamp| lamp.shines()) {
            let reached = l.le(below, u);
            let share = lamp.share(l, outlook);
            (start, chance) = (l.select(reached, below, start), l.select(reached, share, chance));
            (row, rows) = (l.select_u(reached, l.u(lamp.first), row), l.select_u(reached, l.u(lamp.rows), rows));
            below = below + share;
        }
        if self.most_rows > 1 {
            row = self.part(l, (row, rows), (u - start) / chance);
        }
        (row, chance)
    }

    /// The row that `u` in [0, 1) falls on among those of a lamp, given by its first and their number.
    #[inline(always)]
    fn part<L: Lanes>(&self, l: L, (first, rows): (L::U, L::U), u: L::F) -> L::U {
        let mut row = first;
        let last = l.add_u(l.add_u(first, rows), l.u(u32::MAX));
        for _ in 1..self.most_rows {
            let above = l.lt_u(row, last) & l.le(l.gather(&self.within, row), u);
            row = l.select_u(above, l.add_u(row, l.u(1)), row);
        }
        row
    }

    /// The chance of the lamp with this emitter number.
    #[inline(always)]
    pub fn chance_of<L: Lanes>(&self, l: L, outlook: &Outlook<L>, emitter: L::U) -> L::F {
        let mut chance = l.f(0.0);
        for (number, lamp) in (0..).zip(&self.lamps) {
            let this = l.eq_u(emitter, l.u(number));
            if l.any(this) {
                chance = l.select(this, lamp.share(l, outlook), chance);
            }
        }
        chance
    }
}

impl Lamp {
    fn shines(&self) -> bool {
        self.strength > 0.0 || self.everywhere > 0.0 || self.chance > 0.0
    }

    /// Irradiance that it brings to a place at most, in the table's unit.
    #[inline(always)]
    fn brings<L: Lanes>(&self, l: L, place: V3<L>) -> L::F {
        let away = place - V3::splat(l, self.centre);
        let height = V3::splat(l, self.normal).dot(l, away) + l.f(self.lift);
        let squared = l.max(away.dot(l, away), l.f(LEAST));
        let distance = l.sqrt(squared);
        // Of all points of a lamp, none sees the place at a larger cosine than height + radius by distance, nor is it of
        // use to take any for nearer than the lamp is large.
        let cosine_by = l.min(distance, height + l.f(self.radius));
        let nearest = l.max(squared, l.f(self.radius * self.radius));
        let brought = l.f(self.strength) * cosine_by / (distance * nearest);
        l.keep(l.lt(l.f(0.0), height), brought) + l.f(self.everywhere)
    }

    /// Its share of the choice.
    #[inline(always)]
    fn share<L: Lanes>(&self, l: L, outlook: &Outlook<L>) -> L::F {
        l.mul_add(outlook.by_place, self.brings(l, outlook.place), outlook.by_power * l.f(self.chance))
    }
}
