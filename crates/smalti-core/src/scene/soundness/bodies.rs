//! Surfaces that hang together by their edges, whatever primitives they are made of: where they end, and which way they
//! are wound.

use std::collections::HashMap;

use glam::DVec3;

use crate::accel::cones::leader;
use crate::scene::world::World;
use crate::scene::{Frame, Origin};

/// With more free edges than this, corners on the middle of an edge are no longer looked for: the surface is open.
const MOST_SPLIT: usize = 2000;

/// A corner this near to an edge, as part of the frame, lies on it.
const ON_EDGE: f64 = 1e-6;

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
    let mut faces: Vec<(Origin, Vec<u32>)> = Vec::new();
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

/// Corners by place: those that are one in the frame's f32 are one.
#[derive(Default)]
struct Corners {
    ids: HashMap<[u32; 3], u32>,
    points: Vec<DVec3>,
}

impl Corners {
    fn id(&mut self, point: DVec3) -> u32 {
        let key = point.as_vec3().to_array().map(|x| (x + 0.0).to_bits());
        *self.ids.entry(key).or_insert_with(|| {
            self.points.push(point);
            self.points.len() as u32 - 1
        })
    }
}

type Faces = Vec<(Origin, Vec<u32>)>;

/// The faces, those together that share a corner.
fn apart(points: &[DVec3], faces: &[(Origin, Vec<u32>)]) -> Vec<Faces> {
    let mut leaders: Vec<u32> = (0..points.len() as u32).collect();
    for (_, corners) in faces {
        for corner in &corners[1..] {
            let (a, b) = (leader(&mut leaders, corners[0]), leader(&mut leaders, *corner));
            leaders[a.max(b) as usize] = a.min(b);
        }
    }
    let mut numbers: HashMap<u32, usize> = HashMap::new();
    let mut bodies: Vec<Faces> = Vec::new();
    for face in faces {
        let group = leader(&mut leaders, face.1[0]);
        let number = *numbers.entry(group).or_insert(bodies.len());
        bodies.resize(bodies.len().max(number + 1), Vec::new());
        bodies[number].push(face.clone());
    }
    bodies
}

fn body(points: &[DVec3], faces: &[(Origin, Vec<u32>)]) -> Body {
    // How often faces run along an edge from its lower corner to its higher one, less how often the other way.
    let mut runs: HashMap<Edge, i32> = HashMap::new();
    for (_, corners) in faces {
        for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            run(&mut runs, *a, *b, 1);
        }
    }
    runs.retain(|_, count| *count != 0);
    if runs.len() <= MOST_SPLIT {
        runs = split(points, &runs);
    }
    let mut free: Vec<Edge> = runs.into_iter().filter(|(_, count)| *count != 0).map(|(edge, _)| edge).collect();
    free.sort_unstable();
    let middle = points[faces[0].1[0] as usize];
    let volume = |corners: &[u32]| {
        let at = |k: usize| points[corners[k] as usize] - middle;
        (1..corners.len() - 1).map(|k| at(0).dot(at(k).cross(at(k + 1)))).sum::<f64>()
    };
    Body {
        faces: faces.iter().map(|face| face.0).collect(),
        free: free.into_iter().map(|edge| edge.map(|corner| points[corner as usize])).collect(),
        volume: faces.iter().map(|(_, corners)| volume(corners)).sum(),
    }
}

fn run(runs: &mut HashMap<Edge, i32>, a: u32, b: u32, count: i32) {
    if a != b {
        *runs.entry([a.min(b), a.max(b)]).or_default() += if a < b { count } else { -count };
    }
}

/// The edges cut where corners of others lie on them: two short faces may end at one long one.
fn split(points: &[DVec3], runs: &HashMap<Edge, i32>) -> HashMap<Edge, i32> {
    let mut ends: Vec<u32> = runs.keys().flatten().copied().collect();
    ends.sort_unstable();
    ends.dedup();
    let mut cut = HashMap::new();
    for (&[a, b], &count) in runs {
        let (from, along) = (points[a as usize], points[b as usize] - points[a as usize]);
        let length = along.length_squared();
        let place = |corner: &u32| {
            let to = points[*corner as usize] - from;
            let share = to.dot(along) / length;
            let beside = (to - share * along).abs().max_element();
            (share > 0.0 && share < 1.0 && beside < ON_EDGE).then_some((share, *corner))
        };
        let mut between: Vec<(f64, u32)> =
            ends.iter().filter(|end| **end != a && **end != b).filter_map(place).collect();
        between.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut last = a;
        for corner in between.into_iter().map(|(_, corner)| corner).chain([b]) {
            run(&mut cut, last, corner, count);
            last = corner;
        }
    }
    cut
}
