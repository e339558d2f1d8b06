//! Surfaces that hang together by their edges, whatever primitives they are made of: where they end, and which way they
//! are wound.

use std::collections::HashMap;

use glam::DVec3;

use crate::accel::cones::leader;
use crate::scene::contact::STEP;
use crate::scene::world::World;
use crate::scene::{Frame, Origin};

/// With more free edges than this, corners on the middle of an edge are no longer looked for: the surface is open.
const MOST_SPLIT: usize = 2000;

/// A corner this near to an edge, as part of the frame, lies on it.
const ON_EDGE: f64 = 1e-6;

/// Corners that are nearer than this along every axis, as part of the frame, are one.
const ONE_CORNER: f64 = 4.0 * STEP;

/// A surface that hangs together.
#[derive(Clone, Debug, Default)]
pub struct Body {
    /// Its faces.
    pub faces: Vec<Origin>,
    /// Where it ends: edges that belong to no other face of it, or to one that is wound against it.
    pub free: Vec<[DVec3; 2]>,
    /// Six times the volume that it encloses, in the frame; negative where its normals point inwards.
    pub volume: f64,
}

/// An edge, between the numbers of two corners.
type Edge = [u32; 2];

/// The bodies of the faces for which `wanted`, which is given the material and whether it emits.
pub fn bodies(world: &World, frame: &Frame, wanted: impl Fn(usize, bool) -> bool) -> Vec<Body> {
    let mut corners = Corners::default();
    let mut faces: Vec<Numbered> = Vec::new();
    for (index, polygon) in world.polygons.iter().enumerate() {
        if wanted(polygon.material, polygon.radiance.is_some()) {
            let ids = polygon.vertices.iter().map(|v| corners.id(frame.point(*v))).collect();
            faces.push((Origin::Polygon(index as u32), ids));
        }
    }
    for (index, mesh) in world.meshes.iter().enumerate() {
        if wanted(mesh.material, mesh.radiance.is_some()) {
            let ids: Vec<u32> = mesh.vertices.iter().map(|v| corners.id(frame.point(*v))).collect();
            let of_mesh = |(number, face): (usize, &[u32; 3])| {
                (Origin::Mesh(index as u32, number as u32), face.map(|corner| ids[corner as usize]).to_vec())
            };
            faces.extend(mesh.faces.iter().enumerate().map(of_mesh));
        }
    }
    let bodies = apart(&corners.points, &faces);
    bodies.into_iter().map(|faces| body(&corners.points, &faces)).collect()
}

/// Corners by place: those that are as near to each other as files round them are one. What was closed stays closed by
/// that, however thin it is.
#[derive(Default)]
struct Corners {
    /// Numbers of the corners in each cell of a grid.
    cells: HashMap<[i32; 3], Vec<u32>>,
    points: Vec<DVec3>,
}

impl Corners {
    fn id(&mut self, point: DVec3) -> u32 {
        self.known(point).unwrap_or_else(|| {
            let id = self.points.len() as u32;
            self.points.push(point);
            self.cells.entry(cell(point)).or_default().push(id);
            id
        })
    }

    fn known(&self, point: DVec3) -> Option<u32> {
        let (low, high) = (cell(point - ONE_CORNER), cell(point + ONE_CORNER));
        let is_here = |id: &u32| (self.points[*id as usize] - point).abs().max_element() <= ONE_CORNER;
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let here = self.cells.get(&[x, y, z]).and_then(|ids| ids.iter().copied().find(is_here));
                    if here.is_some() {
                        return here;
                    }
                }
            }
        }
        None
    }
}

fn cell(point: DVec3) -> [i32; 3] {
    (point / (8.0 * ONE_CORNER)).floor().to_array().map(|x| x as i32)
}

/// A face and the numbers of its corners.
type Numbered = (Origin, Vec<u32>);

/// The faces, those together that share a corner.
fn apart<'f>(points: &[DVec3], faces: &'f [Numbered]) -> Vec<Vec<&'f Numbered>> {
    let mut leaders: Vec<u32> = (0..points.len() as u32).collect();
    for (_, corners) in faces {
        for corner in &corners[1..] {
            let (a, b) = (leader(&mut leaders, corners[0]), leader(&mut leaders, *corner));
            leaders[a.max(b) as usize] = a.min(b);
        }
    }
    let mut numbers: HashMap<u32, usize> = HashMap::new();
    let mut bodies: Vec<Vec<&Numbered>> = Vec::new();
    for face in faces {
        let next = bodies.len();
        let number = *numbers.entry(leader(&mut leaders, face.1[0])).or_insert(next);
        bodies.resize(next.max(number + 1), Vec::new());
        bodies[number].push(face);
    }
    bodies
}

fn body(points: &[DVec3], faces: &[&Numbered]) -> Body {
    let sides = faces.iter().flat_map(|(_, corners)| corners.iter().zip(corners.iter().cycle().skip(1)));
    let mut runs = netted(sides.map(|(a, b)| run(*a, *b, 1)).collect());
    if runs.len() <= MOST_SPLIT {
        runs = split(points, &runs);
    }
    let middle = points[faces[0].1[0] as usize];
    let volume = |corners: &[u32]| {
        let at = |k: usize| points[corners[k] as usize] - middle;
        (1..corners.len() - 1).map(|k| at(0).dot(at(k).cross(at(k + 1)))).sum::<f64>()
    };
    Body {
        faces: faces.iter().map(|face| face.0).collect(),
        free: runs.into_iter().map(|(edge, _)| edge.map(|corner| points[corner as usize])).collect(),
        volume: faces.iter().map(|(_, corners)| volume(corners)).sum(),
    }
}

/// An edge, and how often faces run along it from its lower corner to its higher one, less how often the other way.
type Run = (Edge, i32);

fn run(a: u32, b: u32, count: i32) -> Run {
    if a < b { ([a, b], count) } else { ([b, a], -count) }
}

/// Each edge once, where faces do not run along it as often one way as the other.
fn netted(mut runs: Vec<Run>) -> Vec<Run> {
    runs.sort_unstable_by_key(|run| run.0);
    let of_edges = runs.chunk_by(|a, b| a.0 == b.0);
    let sums = of_edges.map(|same| (same[0].0, same.iter().map(|run| run.1).sum()));
    sums.filter(|(edge, sum)| *sum != 0 && edge[0] != edge[1]).collect()
}

/// The edges cut where corners of others lie on them: two short faces may end at one long one.
fn split(points: &[DVec3], runs: &[Run]) -> Vec<Run> {
    let mut ends: Vec<u32> = runs.iter().flat_map(|run| run.0).collect();
    ends.sort_unstable();
    ends.dedup();
    let mut cut = Vec::new();
    for &([a, b], count) in runs {
        let (from, along) = (points[a as usize], points[b as usize] - points[a as usize]);
        let place = |corner: &u32| {
            let to = points[*corner as usize] - from;
            let share = to.dot(along) / along.length_squared();
            let beside = (to - share * along).abs().max_element();
            (share > 0.0 && share < 1.0 && beside < ON_EDGE).then_some((share, *corner))
        };
        let mut between: Vec<(f64, u32)> =
            ends.iter().filter(|end| **end != a && **end != b).filter_map(place).collect();
        between.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut last = a;
        for corner in between.into_iter().map(|(_, corner)| corner).chain([b]) {
            cut.push(run(last, corner, count));
            last = corner;
        }
    }
    netted(cut)
}
