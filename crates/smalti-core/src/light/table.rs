//! The table of lights: one row a planar patch (parallelogram or triangle), sphere or point, with its share of the
//! choice; and one row an emitter (a primitive that emits), for paths that hit it.

use super::lamps::by_place;
use super::place::{Lamps, Outlook};
use crate::lanes::{Lanes, V3};
use crate::sampling::discrete;

/// Kinds of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Kind {
    /// Origin + u·e1 + v·e2, u and v in [0, 1).
    Parallelogram = 0,
    /// Origin + u·e1 + v·e2, u + v ≤ 1.
    Triangle = 1,
    /// A sphere, sampled by the cone in which it is seen.
    Sphere = 2,
    /// A point.
    Point = 3,
    /// The environment, where no scattered ray looks for it (whitted).
    Sky = 4,
}

impl Kind {
    /// All kinds, by their numbers.
    const ALL: [Self; 5] = [Self::Parallelogram, Self::Triangle, Self::Sphere, Self::Point, Self::Sky];
}

/// A row: place (12: origin, e1, e2, normal; or centre and radius), radiance or intensity (3), 1 / (pick · pdf): area /
/// pick for a patch, 1 / pick otherwise. Where lamps are chosen by place, the pick is that among the rows of the lamp.
pub type Row = [f32; 16];

/// An emitter: radiance (3), the density of its points by area and choice (patches) or its pick (sphere). Where lamps
/// are chosen by place, the choice is not in it.
pub type Emitter = [f32; 4];

/// All lights with extent or position.
#[derive(Clone, Debug, Default)]
pub struct LightTable {
    /// The rows.
    pub rows: Vec<Row>,
    /// Their kinds, as [`Kind`] numbers.
    pub kinds: Vec<u32>,
    /// Their surface ids: a shadow ray towards a row cannot be stopped by its own surface.
    pub surfaces: Vec<u32>,
    /// Upper ends of the rows' shares of [0, 1).
    pub cumulative: Vec<f32>,
    /// One for each primitive that emits.
    pub emitters: Vec<Emitter>,
    /// Chances by place, where there are several lamps and not too many.
    pub by_place: Option<Lamps>,
    power: Vec<f64>,
    area: Vec<f64>,
    emitter_of: Vec<Option<u32>>,
}

/// No surface: a camera ray leaves none, a point light has none.
pub const NO_SURFACE: u32 = u32::MAX;

impl LightTable {
    /// Adds the patches of an emitting polygon; returns its emitter number. `area` is that of the polygon.
    pub fn polygon(
        &mut self,
        corners: &[[f32; 3]],
        area: f64,
        plane: [f32; 4],
        radiance: [f64; 3],
        surface: u32,
    ) -> u32 {
        let emitter = self.emitter(radiance);
        if is_parallelogram(corners) {
            let spread = [corners[1], corners[3]];
            self.patch(Kind::Parallelogram, corners[0], spread, area, plane, radiance, (surface, emitter));
        } else {
            for k in 1..corners.len() - 1 {
                let spread = [corners[k], corners[k + 1]];
                let [e1, e2] = spread.map(|c| glam::DVec3::from_array(minus(c, corners[0]).map(f64::from)));
                let part = e1.cross(e2).length() / 2.0;
                self.patch(Kind::Triangle, corners[0], spread, part, plane, radiance, (surface, emitter));
            }
        }
        emitter
    }

    /// Adds an emitting sphere (centre, radius); returns its emitter number.
    pub fn sphere(&mut self, [x, y, z, r]: [f32; 4], radiance: [f64; 3], surface: u32) -> u32 {
        let emitter = self.emitter(radiance);
        let area = 4.0 * core::f64::consts::PI * f64::from(r) * f64::from(r);
        let mut row = [0.0; 16];
        row[..4].copy_from_slice(&[x, y, z, r]);
        self.push(Kind::Sphere, row, radiance, area * core::f64::consts::PI, (area, surface, Some(emitter)));
        emitter
    }

    /// Adds a point light of the given intensity (in the frame's units).
    pub fn point(&mut self, position: [f32; 3], intensity: [f64; 3]) {
        let mut row = [0.0; 16];
        row[..3].copy_from_slice(&position);
        self.push(Kind::Point, row, intensity, 4.0 * core::f64::consts::PI, (1.0, NO_SURFACE, None));
    }

    /// Adds the environment as a light that is sampled.
    pub fn sky(&mut self, radiance: [f64; 3]) {
        // As much as arrives in a scene of the frame's size, radius 1: π r² · π.
        let power = core::f64::consts::PI * core::f64::consts::PI;
        self.push(Kind::Sky, [0.0; 16], radiance, power, (1.0, NO_SURFACE, None));
    }

    /// Whether some row is of this kind.
    pub fn has(&self, kind: Kind) -> bool {
        self.kinds.contains(&(kind as u32))
    }

    /// Shares the choice out, once every light is there.
    pub fn finish(&mut self) {
        let (cumulative, mut shares) = discrete::shares(&self.power);
        self.cumulative = cumulative;
        self.by_place = by_place(self);
        if self.by_place.is_some() {
            shares = self.shares_within_lamps();
        }
        for (index, share) in shares.into_iter().enumerate() {
            self.rows[index][15] = if share > 0.0 { (self.area[index] / share) as f32 } else { f32::INFINITY };
            if let Some(emitter) = self.emitter_of[index] {
                // The patches of one polygon have equal radiance, so share / area is the same for all of them.
                self.emitters[emitter as usize][3] =
                    (share / if self.kinds[index] == Kind::Sphere as u32 { 1.0 } else { self.area[index] }) as f32;
            }
        }
    }

    /// Each row's share of the area of its emitter.
    fn shares_within_lamps(&self) -> Vec<f64> {
        let areas = self.areas();
        let share = |row| match (self.emitter_of[row], self.area(row)) {
            (Some(emitter), Some(area)) if areas[emitter as usize] > 0.0 => area / areas[emitter as usize],
            _ => 1.0,
        };
        (0..self.rows.len()).map(share).collect()
    }

    /// The lamps as seen from a place, for [`choose`](Self::choose) and [`chance_of`](Self::chance_of).
    #[inline(always)]
    pub fn seen_from<L: Lanes>(&self, l: L, place: V3<L>) -> Option<Outlook<L>> {
        self.by_place.as_ref().map(
            #[inline(always)]
            |lamps| lamps.seen_from(l, place),
        )
    }

    /// The row that `u` in [0, 1) falls on, and the chance that is not in the row itself.
    #[inline(always)]
    pub fn choose<L: Lanes>(&self, l: L, outlook: Option<&Outlook<L>>, u: L::F) -> (L::U, L::F) {
        match (&self.by_place, outlook) {
            (Some(lamps), Some(outlook)) => lamps.choose(l, outlook, u),
            _ => (discrete::choose(l, &self.cumulative, u), l.f(1.0)),
        }
    }

    /// The chance of an emitter that is not in the emitter itself.
    #[inline(always)]
    pub fn chance_of<L: Lanes>(&self, l: L, outlook: Option<&Outlook<L>>, emitter: L::U) -> L::F {
        match (&self.by_place, outlook) {
            (Some(lamps), Some(outlook)) => lamps.chance_of(l, outlook, emitter),
            _ => l.f(1.0),
        }
    }

    /// Kind of a row.
    pub fn kind(&self, row: usize) -> Kind {
        Kind::ALL[self.kinds[row] as usize]
    }

    /// Power of a row, mean of the channels, in the frame's units.
    pub fn power(&self, row: usize) -> f64 {
        self.power[row]
    }

    /// Area of a patch or sphere in the frame; `None` for lights without one.
    pub fn area(&self, row: usize) -> Option<f64> {
        match self.rows[row] {
            [_, _, _, r, ..] if self.kinds[row] == Kind::Sphere as u32 => {
                Some(4.0 * core::f64::consts::PI * f64::from(r) * f64::from(r))
            }
            _ => self.emitter_of[row].map(|_| self.area[row]),
        }
    }

    /// Area of each emitter, in the frame.
    pub fn areas(&self) -> Vec<f64> {
        let mut areas = vec![0.0; self.emitters.len()];
        for row in 0..self.rows.len() {
            if let (Some(emitter), Some(area)) = (self.emitter_of[row], self.area(row)) {
                areas[emitter as usize] += area;
            }
        }
        areas
    }

    /// The emitter that a row is part of; `None` for lights that no path can hit.
    pub fn emitter_of(&self, row: usize) -> Option<u32> {
        self.emitter_of[row]
    }

    fn emitter(&mut self, radiance: [f64; 3]) -> u32 {
        let [r, g, b] = radiance.map(|x| x as f32);
        self.emitters.push([r, g, b, 0.0]);
        self.emitters.len() as u32 - 1
    }

    #[expect(clippy::too_many_arguments, reason = "one row of a table")]
    fn patch(
        &mut self,
        kind: Kind,
        origin: [f32; 3],
        ends: [[f32; 3]; 2],
        area: f64,
        plane: [f32; 4],
        radiance: [f64; 3],
        (surface, emitter): (u32, u32),
    ) {
        let mut row = [0.0; 16];
        row[..3].copy_from_slice(&origin);
        row[3..6].copy_from_slice(&minus(ends[0], origin));
        row[6..9].copy_from_slice(&minus(ends[1], origin));
        row[9..12].copy_from_slice(&plane[..3]);
        self.push(kind, row, radiance, area * core::f64::consts::PI, (area, surface, Some(emitter)));
    }

    fn push(&mut self, kind: Kind, mut row: Row, radiance: [f64; 3], spread: f64, origin: (f64, u32, Option<u32>)) {
        for k in 0..3 {
            row[12 + k] = radiance[k] as f32;
        }
        let (area, surface, emitter) = origin;
        self.rows.push(row);
        self.kinds.push(kind as u32);
        self.surfaces.push(surface);
        self.power.push(radiance.iter().sum::<f64>() / 3.0 * spread);
        self.area.push(if kind == Kind::Sphere { 1.0 } else { area });
        self.emitter_of.push(emitter);
    }
}

/// Whether four corners close exactly in f32: c0 + c2 = c1 + c3 to rounding.
fn is_parallelogram(corners: &[[f32; 3]]) -> bool {
    let [a, b, c, d] = corners else { return false };
    let largest = corners.iter().flatten().fold(0.0f32, |so_far, x| so_far.max(x.abs()));
    (0..3).all(|k| {
        (f64::from(a[k]) + f64::from(c[k]) - f64::from(b[k]) - f64::from(d[k])).abs() <= f64::from(largest) * 2.4e-7
    })
}

fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// A row's three components from `at` on, in every lane.
#[inline(always)]
pub fn triple<L: Lanes>(row: &[L::F; 16], at: usize) -> V3<L> {
    V3::new(row[at], row[at + 1], row[at + 2])
}
