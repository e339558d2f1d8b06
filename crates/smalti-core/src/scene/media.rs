//! What rays travel in: the insides of dielectrics, where some of them absorb light.
//!
//! A ray knows the number of its medium; a boundary that it crosses gives it another. What is outside of a dielectric is
//! what the dielectric as a whole lies in: another one, or the vacuum. So bubbles in glass are a dielectric in a
//! dielectric, and a camera or a lamp may be inside of one.

use glam::DVec3;

use super::world::{Material, World};
use super::{Class, Origin, Scene};
use crate::lanes::{Lanes, Rgb, V3, math};
use crate::light::table::{Kind, NO_SURFACE};
use crate::mutant::mutant;

/// The number of what absorbs nothing.
pub const CLEAR: u32 = 0;

/// Media of a scene in which something absorbs.
pub struct Media {
    /// For each medium and channel the absorption coefficient, by frame unit: its leading bits, then the rest. (As one f32
    /// it would be too coarse where much is absorbed.)
    absorption: Vec<[f32; 8]>,
    /// For each primitive the medium inside and the one outside; of meaning for dielectrics.
    sides: Vec<u32>,
    /// What the light of each row of the light table is emitted into.
    pub lights: Vec<u32>,
    /// What each camera is in.
    pub views: Vec<u32>,
}

impl Media {
    /// The media of `world`, of which `scene` is compiled but for them; `None` if none absorbs.
    pub fn of(world: &World, scene: &Scene) -> Option<Self> {
        if !world.materials.iter().any(Material::absorbs) {
            return None;
        }
        let mut absorption = vec![[0.0; 8]];
        let numbers: Vec<u32> =
            world.materials.iter().map(|material| number(material, scene, &mut absorption)).collect();
        let nested = Nested { scene, boundaries: boundaries(world, scene) };
        let inside = |material: Option<usize>| material.map_or(CLEAR, |material| numbers[material]);
        let mut sides = vec![CLEAR; 2 * scene.shades.len()];
        let mut last: Option<(Origin, u32)> = None;
        for boundary in &nested.boundaries {
            let origin = boundary.origin();
            let outside = match last {
                Some((same, outside)) if same == origin => outside,
                _ => inside(nested.around(&boundary.start(scene))),
            };
            last = Some((origin, outside));
            sides[2 * boundary.prim as usize] = numbers[boundary.material];
            sides[2 * boundary.prim as usize + 1] = outside;
        }
        let lights = (0..scene.lights.rows.len()).map(|row| inside(nested.around(&light(scene, row)))).collect();
        let views =
            scene.views.iter().map(|view| inside(nested.around(&Start::in_air(view.eye, view.forward)))).collect();
        Some(Self { absorption, sides, lights, views })
    }

    /// The part of the light of each channel that is left of it after `distance` in `medium`.
    #[inline(always)]
    pub fn transmittance<L: Lanes>(&self, l: L, medium: L::U, distance: L::F) -> Rgb<L> {
        let [r, g, b, rest_r, rest_g, rest_b, ..] = l.gather_record(&self.absorption, medium);
        V3::new(
            math::exp_minus(l, (r, rest_r), distance),
            math::exp_minus(l, (g, rest_g), distance),
            math::exp_minus(l, (b, rest_b), distance),
        )
    }

    /// What rays travel in that went through primitive `prim`, from `outside` or from inside; of the lanes `lanes`.
    #[inline(always)]
    pub fn beyond<L: Lanes>(&self, l: L, prim: L::U, outside: L::M, lanes: L::M) -> L::U {
        let side = if mutant!("outside_is_inside") { l.u(0) } else { l.select_u(outside, l.u(0), l.u(1)) };
        l.gather_u(&self.sides, l.select_u(lanes, l.add_u(l.shl::<1>(prim), side), l.u(0)))
    }

    /// The medium inside of a dielectric primitive.
    pub fn inside(&self, prim: u32) -> u32 {
        self.sides[2 * prim as usize]
    }

    /// The medium that a dielectric primitive's body lies in.
    pub fn outside(&self, prim: u32) -> u32 {
        self.sides[2 * prim as usize + 1]
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        let numbers = self.sides.len() + self.lights.len() + self.views.len();
        (size_of_val(&self.absorption[..]) + numbers * size_of::<u32>()) as u64
    }
}

/// The number of a material's inside, which is entered into the table.
fn number(material: &Material, scene: &Scene, absorption: &mut Vec<[f32; 8]>) -> u32 {
    let Material::Dielectric { absorption: coefficients, .. } = material else { return CLEAR };
    if !material.absorbs() {
        return CLEAR;
    }
    let mut row = [0.0; 8];
    for (channel, coefficient) in coefficients.iter().enumerate() {
        let scale = if mutant!("absorption_without_scale") { 1.0 } else { scene.frame.scale };
        let by_unit = (coefficient / scale).min(f32::MAX.into());
        row[channel] = math::leading_bits(by_unit as f32);
        row[3 + channel] = (by_unit - f64::from(row[channel])) as f32;
    }
    absorption.push(row);
    absorption.len() as u32 - 1
}

/// A primitive that bounds a dielectric.
#[derive(Clone, Copy)]
struct Boundary {
    prim: u32,
    material: usize,
    origin: Origin,
}

impl Boundary {
    /// What all of a surface has in common: the mesh, not its triangle.
    fn origin(&self) -> Origin {
        match self.origin {
            Origin::Mesh(mesh, _) => Origin::Mesh(mesh, 0),
            other => other,
        }
    }

    /// A place outside of it.
    fn start(&self, scene: &Scene) -> Start {
        match scene.faces.get(self.prim as usize) {
            Some(face) => {
                let corners = scene.face_corners(face).iter().map(|corner| wide(scene.vertices[*corner as usize]));
                let middle = corners.sum::<DVec3>() / f64::from(face.count);
                let start = Start::off(middle, wide([face.plane[0], face.plane[1], face.plane[2]]), face.surface);
                Start { enters_what_touches: true, ..start }
            }
            None => {
                let sphere = self.prim as usize - scene.faces.len();
                let [x, y, z, radius] = scene.spheres[sphere];
                let from = wide([x, y, z]) + f64::from(radius) * WAY.normalize();
                Start::off(from, WAY, scene.surface(self.prim))
            }
        }
    }
}

fn boundaries(world: &World, scene: &Scene) -> Vec<Boundary> {
    let bounds = |prim: u32| {
        let origin = scene.origins[prim as usize];
        let material = match origin {
            Origin::Polygon(index) => world.polygons[index as usize].material,
            Origin::Mesh(index, _) => world.meshes[index as usize].material,
            Origin::Sphere(index) => world.spheres[index as usize].material,
        };
        (scene.class(prim) == Some(Class::Dielectric)).then_some(Boundary { prim, material, origin })
    };
    (0..scene.shades.len() as u32).filter_map(bounds).collect()
}

/// A direction along no edge and no axis.
const WAY: DVec3 = DVec3::new(0.537_251, 0.684_133, 0.493_306);

/// Where a ray starts that tells what is around it.
struct Start {
    from: DVec3,
    way: DVec3,
    /// The surface that it leaves.
    leaves: u32,
    /// Whether it goes into what touches that surface, and is then not around it.
    enters_what_touches: bool,
}

impl Start {
    /// On a surface, to the side of its normal.
    fn off(from: DVec3, normal: DVec3, leaves: u32) -> Self {
        let way = if WAY.dot(normal) < 0.0 { -WAY } else { WAY };
        Self { from, way, leaves, enters_what_touches: false }
    }

    /// Anywhere.
    fn at(from: DVec3) -> Self {
        Self { from, way: WAY, leaves: NO_SURFACE, enters_what_touches: false }
    }

    /// Before `eye`: what is on a surface is on the side to which it looks.
    fn in_air(eye: [f32; 3], forward: [f32; 3]) -> Self {
        Self::at(wide(eye) + wide(forward) / f64::from(1u32 << 20))
    }
}

/// In front of the light of a row.
fn light(scene: &Scene, row: usize) -> Start {
    let [x, y, z, radius, ..] = scene.lights.rows[row];
    let surface = scene.lights.surfaces[row];
    let corner = wide([x, y, z]);
    match scene.lights.kinds[row] {
        kind if kind == Kind::Sphere as u32 => Start::off(corner + f64::from(radius) * WAY.normalize(), WAY, surface),
        kind if kind == Kind::Point as u32 => Start::at(corner),
        // The sky is around everything.
        kind if kind == Kind::Sky as u32 => Start::at(DVec3::splat(8.0)),
        _ => {
            let [_, _, _, a, b, c, d, e, f, nx, ny, nz, ..] = scene.lights.rows[row];
            Start::off(corner + (wide([a, b, c]) + wide([d, e, f])) / 3.0, wide([nx, ny, nz]), surface)
        }
    }
}

/// Dielectrics, some of them in others.
struct Nested<'s> {
    scene: &'s Scene,
    boundaries: Vec<Boundary>,
}

impl Nested<'_> {
    /// Material of the innermost dielectric around a place: the first one that a ray from there leaves without having
    /// entered it.
    fn around(&self, start: &Start) -> Option<usize> {
        let mut met: Vec<(f64, bool, usize)> = Vec::new();
        for boundary in &self.boundaries {
            self.meet(boundary, start, &mut |t, enters| met.push((t, enters, boundary.material)));
        }
        met.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut entered: Vec<usize> = Vec::new();
        for (_, enters, material) in met {
            if enters {
                entered.push(material);
            } else if let Some(at) = entered.iter().rposition(|other| *other == material) {
                entered.remove(at);
            } else {
                return Some(material);
            }
        }
        None
    }

    /// Tells of each point where the ray goes through the boundary: how far it is, and whether to the inside.
    fn meet(&self, boundary: &Boundary, start: &Start, tell: &mut impl FnMut(f64, bool)) {
        let scene = self.scene;
        let Some(face) = scene.faces.get(boundary.prim as usize) else {
            return self.meet_sphere(boundary.prim as usize - scene.faces.len(), start, tell);
        };
        let [x, y, z, distance] = face.plane;
        let normal = wide([x, y, z]);
        let slope = normal.dot(start.way);
        let own = face.surface == start.leaves;
        let t = if own { 0.0 } else { (f64::from(distance) - normal.dot(start.from)) / slope };
        let enters = own && start.enters_what_touches && slope < 0.0;
        if slope == 0.0 || (t <= 0.0 && !enters) {
            return;
        }
        let point = start.from + t * start.way;
        let corners: Vec<DVec3> =
            scene.face_corners(face).iter().map(|corner| wide(scene.vertices[*corner as usize])).collect();
        let is_left = |(a, b): (&DVec3, &DVec3)| (*b - *a).cross(point - *a).dot(normal) >= 0.0;
        if corners.iter().zip(corners.iter().cycle().skip(1)).all(is_left) {
            tell(t, slope < 0.0);
        }
    }

    fn meet_sphere(&self, sphere: usize, start: &Start, tell: &mut impl FnMut(f64, bool)) {
        let [x, y, z, radius] = self.scene.spheres[sphere];
        if self.scene.surface((self.scene.faces.len() + sphere) as u32) == start.leaves {
            return;
        }
        let way = start.way.normalize();
        let to = wide([x, y, z]) - start.from;
        let nearest = to.dot(way);
        let beside = (to - nearest * way).length_squared();
        let half = f64::from(radius) * f64::from(radius) - beside;
        if half > 0.0 {
            let scale = way.dot(start.way);
            let ends = [(nearest - half.sqrt(), true), (nearest + half.sqrt(), false)];
            ends.into_iter().filter(|end| end.0 > 0.0).for_each(|(t, enters)| tell(t / scale, enters));
        }
    }
}

fn wide(v: [f32; 3]) -> DVec3 {
    DVec3::from_array(v.map(f64::from))
}
