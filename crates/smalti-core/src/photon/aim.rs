//! Aiming photons: which light a photon leaves, and for which target.
//!
//! A target is a sphere around what the photon has to meet; or everything, and then photons leave as the light radiates.
//! Light and target are chosen together, by the flux that goes from the one to the other. The direction is uniform in
//! the cone of the chosen target, and weighed by the density with which *any* target would have led to it, so that
//! targets may overlap. Without this weight (the report aims at its sphere and says nothing of it, §2.8) the caustic
//! would be brighter by the whole sphere of directions over the cone.

use glam::DVec3;

use crate::lanes::{Lanes, V3};
use crate::light::table::{Kind, LightTable};
use crate::mutant::mutant;
use crate::sampling::{discrete, warp};

/// Most targets; what is nearest to each other is united until they are so few.
const MOST_TARGETS: usize = 16;

/// The part of the photons that goes to all targets alike, whatever flux they meet.
const FAIR: f64 = 0.25;

/// Points of a light from where its targets are looked at, along each side.
const LOOKS: u32 = 4;

/// Where photons go.
#[derive(Clone, Debug, Default)]
pub struct Aim {
    /// Centre and radius; an infinite radius is everything.
    pub targets: Vec<[f32; 4]>,
    /// For each light row, then each target, the chance of the pair.
    shares: Vec<f32>,
    /// Upper ends of the shares.
    cumulative: Vec<f32>,
    /// Row and target of each pair.
    pairs: Vec<[f32; 2]>,
    /// For each row what its radiance has to be multiplied by: its area, or 1 for a point.
    pub measures: Vec<f32>,
}

impl Aim {
    /// From the lights that `emits` names at spheres (centre, radius) around what has to be met.
    pub fn at(lights: &LightTable, spheres: &[[f32; 4]], emits: &[bool]) -> Self {
        let targets = united(spheres);
        Self::new(lights, targets, emits, |row, target: &[f32; 4]| fraction(lights, row, target))
    }

    /// From every light in all directions.
    pub fn everywhere(lights: &LightTable) -> Self {
        let emits = vec![true; lights.rows.len()];
        Self::new(lights, vec![[0.0, 0.0, 0.0, f32::INFINITY]], &emits, |_, _| 1.0)
    }

    fn new(
        lights: &LightTable,
        targets: Vec<[f32; 4]>,
        emits: &[bool],
        fraction: impl Fn(usize, &[f32; 4]) -> f64,
    ) -> Self {
        let rows = 0..lights.rows.len();
        let weight =
            |row: usize, target: &[f32; 4]| if emits[row] { lights.power(row) * fraction(row, target) } else { 0.0 };
        let weight = &weight;
        let weights: Vec<f64> =
            rows.clone().flat_map(|row| targets.iter().map(move |target| weight(row, target))).collect();
        let (cumulative, shares) = discrete::shares(&defended(&weights, targets.len()));
        let numbers = 0..targets.len();
        let pairs = rows.clone().flat_map(|row| numbers.clone().map(move |target| [row, target]));
        Self {
            pairs: pairs.map(|pair| pair.map(|number| f32::from_bits(number as u32))).collect(),
            shares: shares.into_iter().map(|share| share as f32).collect(),
            measures: rows.map(|row| lights.area(row).unwrap_or(1.0) as f32).collect(),
            cumulative,
            targets,
        }
    }

    /// Whether no light reaches a target.
    pub fn is_empty(&self) -> bool {
        self.shares.iter().all(|share| *share == 0.0)
    }

    /// The pair of light row and target that `u` in [0, 1) falls on.
    #[inline(always)]
    pub fn choose<L: Lanes>(&self, l: L, u: L::F) -> (L::U, L::U) {
        let pair = discrete::choose(l, &self.cumulative, u);
        let [row, target] = l.gather_record(&self.pairs, pair);
        (l.bits(row), l.bits(target))
    }

    /// A direction from `from` to target `target`, and the density of (row, direction) over all targets, sr⁻¹. A light
    /// with a surface has the unit `normal`; points (`is_point`) have none.
    #[inline(always)]
    pub fn direction<L: Lanes>(
        &self,
        l: L,
        (row, target): (L::U, L::U),
        (from, normal, is_point): (V3<L>, V3<L>, L::M),
        (u, v): (L::F, L::F),
    ) -> (V3<L>, L::F) {
        let seen = Seen::new(l, &l.gather_record(&self.targets, target), from);
        let along_cone = seen.sample(l, u, v);
        let by_cosine = warp::about(l, normal, warp::cosine_hemisphere(l, u, v)).normalised(l);
        let anywhere = V3::select(l, is_point, warp::sphere(l, u, v), by_cosine);
        let direction = V3::select(l, seen.inside, anywhere, along_cone);
        (direction, self.density(l, (row, target), (from, normal, is_point), direction))
    }

    /// Density of (row, direction) over all targets; the chosen one counts whatever rounding says.
    #[inline(always)]
    fn density<L: Lanes>(
        &self,
        l: L,
        (row, chosen): (L::U, L::U),
        (from, normal, is_point): (V3<L>, V3<L>, L::M),
        direction: V3<L>,
    ) -> L::F {
        let cosine = l.max(normal.dot(l, direction), l.f(0.0));
        let anywhere =
            l.select(is_point, l.f(0.25 * core::f32::consts::FRAC_1_PI), warp::cosine_hemisphere_pdf(l, cosine));
        let count = self.targets.len() as u32;
        let first = l.mul_u(row, l.u(count));
        // Report §2.8: photons go to the glass alone, with the flux of those that go everywhere.
        if mutant!("photons_aimed_at_full_flux") {
            return anywhere;
        }
        let mut density = l.f(0.0);
        for number in 0..count {
            let target = self.targets[number as usize].map(
                #[inline(always)]
                |x| l.f(x),
            );
            let seen = Seen::new(l, &target, from);
            let met = seen.meets(l, direction) | l.eq_u(chosen, l.u(number));
            let pdf = l.select(seen.inside, anywhere, l.keep(met, warp::cone_pdf(l, seen.opening)));
            let share = l.gather(&self.shares, l.add_u(first, l.u(number)));
            density = l.mul_add(share, pdf, density);
        }
        density
    }
}

/// The weights of pairs, row by row, such that each of the `targets` that light reaches has at least its part of
/// [`FAIR`]: by flux alone a small caster would meet no photon, and yet its caustic may be all that the camera sees.
fn defended(weights: &[f64], targets: usize) -> Vec<f64> {
    let by_target: Vec<f64> = (0..targets).map(|target| weights.iter().skip(target).step_by(targets).sum()).collect();
    let all: f64 = by_target.iter().sum();
    let reached = by_target.iter().filter(|flux| **flux > 0.0).count() as f64;
    let fair = |(number, weight): (usize, &f64)| match by_target[number % targets] {
        flux if flux > 0.0 => (1.0 - FAIR) * weight + FAIR * (all / reached) * (weight / flux),
        _ => 0.0,
    };
    weights.iter().enumerate().map(fair).collect()
}

/// A target as seen from a point.
struct Seen<L: Lanes> {
    axis: V3<L>,
    distance: L::F,
    opening: L::F,
    squared_radius: L::F,
    /// Whether the point is inside.
    inside: L::M,
}

impl<L: Lanes> Seen<L> {
    #[inline(always)]
    fn new(l: L, target: &[L::F; 4], from: V3<L>) -> Self {
        let [x, y, z, radius] = *target;
        let axis = V3::new(x, y, z) - from;
        let (squared, r2) = (axis.dot(l, axis), radius * radius);
        let opening = warp::sphere_opening(l, r2, squared);
        Self { axis, distance: l.sqrt(squared), opening, squared_radius: r2, inside: l.le(squared, r2) }
    }

    /// A direction uniform in its cone.
    #[inline(always)]
    fn sample(&self, l: L, u: L::F, v: L::F) -> V3<L> {
        let (local, _) = warp::cone(l, self.opening, u, v);
        warp::about(l, self.axis.scale(l.f(1.0) / self.distance), local).normalised(l)
    }

    /// Lanes whose unit `direction` lies in the cone: by how near it passes the centre, as 1 less the cosine of a narrow
    /// cone is lost beside 1.
    #[inline(always)]
    fn meets(&self, l: L, direction: V3<L>) -> L::M {
        let beside = self.axis.cross(l, direction);
        l.lt(l.f(0.0), self.axis.dot(l, direction)) & l.le(beside.dot(l, beside), self.squared_radius)
    }
}

/// The fraction of the flux of a row that goes into the cone of a target; a guess that is 0 only where nothing can.
fn fraction(lights: &LightTable, row: usize, target: &[f32; 4]) -> f64 {
    let [x, y, z, radius] = target.map(f64::from);
    let looks = looks(lights, row);
    let each = |&(from, normal): &(DVec3, Option<DVec3>)| {
        let axis = DVec3::new(x, y, z) - from;
        let sine_squared = (radius * radius / axis.length_squared()).min(1.0);
        let Some(normal) = normal else { return opening(sine_squared) / 2.0 };
        let (cosine, sine) = (normal.dot(axis.normalize_or_zero()), sine_squared.sqrt());
        // Of a cone that dips below the horizon something is left as long as it reaches above.
        let part = cosine.max(if cosine > -sine { 0.1 * sine } else { 0.0 });
        if sine_squared >= 1.0 { 1.0 } else { (2.0 * opening(sine_squared) * part).min(1.0) }
    };
    let mean = looks.iter().map(each).sum::<f64>() / looks.len() as f64;
    mean.max(1e-3 * reachable(lights, row, target))
}

fn opening(sine_squared: f64) -> f64 {
    sine_squared / (1.0 + (1.0 - sine_squared).max(0.0).sqrt())
}

/// The solid angle of a target by that of everything, as long as any of it is in front of the light; else 0.
fn reachable(lights: &LightTable, row: usize, target: &[f32; 4]) -> f64 {
    let place = lights.rows[row].map(f64::from);
    let [x, y, z, radius] = target.map(f64::from);
    let axis = DVec3::new(x - place[0], y - place[1], z - place[2]);
    let planar = [Kind::Parallelogram as u32, Kind::Triangle as u32].contains(&lights.kinds[row]);
    let behind = planar && DVec3::new(place[9], place[10], place[11]).dot(axis) <= -radius;
    if behind { 0.0 } else { opening((radius * radius / axis.length_squared()).min(1.0)) }
}

/// Points spread over a light, each with the normal there.
fn looks(lights: &LightTable, row: usize) -> Vec<(DVec3, Option<DVec3>)> {
    let place = lights.rows[row].map(f64::from);
    let triple = |at: usize| DVec3::new(place[at], place[at + 1], place[at + 2]);
    let steps = || (0..LOOKS * LOOKS).map(|k| (k % LOOKS, k / LOOKS)).map(|(i, j)| (middle(i), middle(j)));
    let kind = lights.kinds[row];
    if kind == Kind::Parallelogram as u32 {
        steps().map(|(u, v)| (triple(0) + u * triple(3) + v * triple(6), Some(triple(9)))).collect()
    } else if kind == Kind::Triangle as u32 {
        let folded = steps().map(|(u, v)| if u < v { (u / 2.0, v - u / 2.0) } else { (u - v / 2.0, v / 2.0) });
        folded.map(|(u, v)| (triple(0) + u * triple(3) + v * triple(6), Some(triple(9)))).collect()
    } else if kind == Kind::Sphere as u32 {
        let on = |(u, v): (f64, f64)| {
            let (z, turn) = (2.0 * u - 1.0, 2.0 * core::f64::consts::PI * v);
            let across = (1.0 - z * z).sqrt();
            DVec3::new(across * libm::cos(turn), across * libm::sin(turn), z)
        };
        steps().map(on).map(|normal| (triple(0) + place[3] * normal, Some(normal))).collect()
    } else {
        vec![(triple(0), None)]
    }
}

fn middle(step: u32) -> f64 {
    (f64::from(step) + 0.5) / f64::from(LOOKS)
}

/// At most [`MOST_TARGETS`] spheres around all of these: the two whose union is least coarse for the smaller of them are
/// united first.
fn united(spheres: &[[f32; 4]]) -> Vec<[f32; 4]> {
    let mut targets = spheres.to_vec();
    // Beyond this many, in the order in which they come: neighbours in a scene file are mostly neighbours in space.
    while targets.len() > 8 * MOST_TARGETS {
        targets = targets.chunks(2).map(|pair| pair.iter().copied().reduce(union).expect("not empty")).collect();
    }
    while targets.len() > MOST_TARGETS {
        let pairs = (0..targets.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
        // A small caster that is united with a large one would hardly be met.
        let coarseness = |(a, b): &(usize, usize)| {
            let (a, b) = (targets[*a], targets[*b]);
            union(a, b)[3] / a[3].min(b[3])
        };
        let (a, b) = pairs.min_by(|p, q| coarseness(p).total_cmp(&coarseness(q))).expect("several");
        targets[a] = union(targets[a], targets[b]);
        targets.remove(b);
    }
    targets
}

/// The smallest sphere around two, and a little more.
fn union(a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
    let centre = |s: [f32; 4]| DVec3::new(s[0].into(), s[1].into(), s[2].into());
    let (p, q, r, s) = (centre(a), centre(b), f64::from(a[3]), f64::from(b[3]));
    let distance = p.distance(q);
    if distance + s <= r {
        return a;
    }
    if distance + r <= s {
        return b;
    }
    let radius = (distance + r + s) / 2.0;
    let middle = p + (q - p) * ((radius - r) / distance);
    // The centre is rounded: the radius has to make up for it.
    [middle.x as f32, middle.y as f32, middle.z as f32, (radius * (1.0 + 1e-6) + 1e-7) as f32]
}
