//! What the chances of lamps by place are made of: each lamp's surrounding sphere, normal and strength, in f64.

use core::f64::consts::PI;

use glam::DVec3;

use super::place::{Lamp, Lamps, MOST};
use super::table::{Kind, LightTable, Row};
use crate::sampling::discrete;

/// The lamps of a table, where there are several and not too many; `None` where lamps are chosen by power alone.
pub fn by_place(table: &LightTable) -> Option<Lamps> {
    let rows = rows_of_lamps(table);
    if !(2..=MOST).contains(&rows.len()) {
        return None;
    }
    let power = |row: &usize| table.power(*row);
    let powers: Vec<f64> = rows.iter().map(|rows| rows.iter().map(power).sum()).collect();
    let (_, chances) = discrete::shares(&powers);
    let brought: Vec<Brought> = rows.iter().map(|rows| brought(table, rows)).collect();
    let largest = brought.iter().map(Brought::most).fold(f64::MIN_POSITIVE, f64::max);
    let lamps = rows.iter().zip(&brought).zip(chances).map(|((rows, brought), chance)| Lamp {
        strength: (brought.near / largest) as f32,
        everywhere: (brought.everywhere / largest) as f32,
        chance: chance as f32,
        first: rows[0] as u32,
        rows: rows.len() as u32,
        ..around(table, rows)
    });
    let within = rows.iter().flat_map(|rows| discrete::shares(&rows.iter().map(power).collect::<Vec<_>>()).0);
    let mut ordered: Vec<(usize, f32)> = rows.iter().flatten().copied().zip(within).collect();
    ordered.sort_by_key(|(row, _)| *row);
    Some(Lamps {
        lamps: lamps.collect(),
        within: ordered.into_iter().map(|(_, end)| end).collect(),
        most_rows: rows.iter().map(Vec::len).max().unwrap_or(1) as u32,
    })
}

/// The sphere around each emitter: centre and radius, in the frame.
pub fn around_emitters(table: &LightTable) -> Vec<[f32; 4]> {
    let lamps = rows_of_lamps(table).into_iter().take(table.emitters.len());
    let spheres = lamps.map(|rows| around(table, &rows));
    spheres.map(|Lamp { centre: [x, y, z], radius, .. }| [x, y, z, radius]).collect()
}

/// Rows of each lamp: those of each emitter, then each row that no path can hit.
fn rows_of_lamps(table: &LightTable) -> Vec<Vec<usize>> {
    let mut lamps = vec![Vec::new(); table.emitters.len()];
    for row in 0..table.rows.len() {
        match table.emitter_of(row) {
            Some(emitter) => lamps[emitter as usize].push(row),
            None => lamps.push(vec![row]),
        }
    }
    lamps
}

/// Irradiance that a lamp brings at most, mean of the channels.
struct Brought {
    /// Times squared distance.
    near: f64,
    /// At any distance.
    everywhere: f64,
}

impl Brought {
    fn most(&self) -> f64 {
        self.near.max(self.everywhere)
    }
}

fn brought(table: &LightTable, rows: &[usize]) -> Brought {
    let row = rows[0];
    let [.., r, g, b, _] = table.rows[row].map(f64::from);
    let radiance = (r + g + b) / 3.0;
    let area = || rows.iter().filter_map(|row| table.area(*row)).sum::<f64>();
    match table.kind(row) {
        Kind::Parallelogram | Kind::Triangle => Brought { near: radiance * area(), everywhere: 0.0 },
        // A quarter of a sphere's area is that of its disc.
        Kind::Sphere => Brought { near: radiance * area() / 4.0, everywhere: 0.0 },
        Kind::Point => Brought { near: radiance, everywhere: 0.0 },
        Kind::Sky => Brought { near: 0.0, everywhere: radiance * PI },
    }
}

/// Place and extent of a lamp; nothing else is set.
fn around(table: &LightTable, rows: &[usize]) -> Lamp {
    let place = table.rows[rows[0]];
    let [x, y, z, radius, ..] = place;
    let all_around = Lamp { centre: [x, y, z], lift: f32::MAX / 4.0, ..Lamp::default() };
    match table.kind(rows[0]) {
        Kind::Parallelogram | Kind::Triangle => {
            let corners: Vec<DVec3> =
                rows.iter().flat_map(|row| corners(&table.rows[*row], table.kind(*row))).collect();
            let low = corners.iter().copied().fold(DVec3::INFINITY, DVec3::min);
            let high = corners.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
            let centre = low.midpoint(high);
            let reach = corners.iter().map(|corner| corner.distance(centre)).fold(0.0, f64::max);
            let [.., nx, ny, nz, _, _, _, _] = place;
            Lamp { centre: centre.as_vec3().to_array(), radius: reach as f32, normal: [nx, ny, nz], ..Lamp::default() }
        }
        Kind::Sphere => Lamp { radius, ..all_around },
        Kind::Point | Kind::Sky => all_around,
    }
}

/// Corners of a patch.
fn corners(row: &Row, kind: Kind) -> Vec<DVec3> {
    let [origin, e1, e2] = [0, 3, 6].map(|at| DVec3::from_array([0, 1, 2].map(|k| f64::from(row[at + k]))));
    let mut corners = vec![origin, origin + e1, origin + e2];
    if kind == Kind::Parallelogram {
        corners.push(origin + e1 + e2);
    }
    corners
}
