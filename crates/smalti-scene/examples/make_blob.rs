//! Writes the blob of `scenes/blob.toml`: an icosphere with bumps, as binary PLY.
//!
//! `cargo run --release -p smalti-scene --example make_blob -- 6 scenes/blob.ply`; 6 subdivisions give 81,920
//! triangles, 8 give 1,310,720, 9 give 5,242,880.

use std::collections::BTreeMap;
use std::error::Error;
use std::{env, fs};

use glam::DVec3;
use libm::sin;

type Mesh = (Vec<DVec3>, Vec<[u32; 3]>);

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [subdivisions, path] = &arguments[..] else { return Err("usage: make_blob SUBDIVISIONS FILE.ply".into()) };
    let subdivisions: u32 = subdivisions.parse()?;
    if subdivisions > 10 {
        return Err("at most 10 subdivisions: 20,971,520 triangles".into());
    }
    let (directions, faces) = (0..subdivisions).fold(icosahedron(), |mesh, _| subdivide(mesh));
    let vertices: Vec<DVec3> = directions.into_iter().map(|d| d * radius(d)).collect();
    fs::write(path, ply(&vertices, &faces))?;
    println!("{path}: {} vertices, {} triangles", vertices.len(), faces.len());
    Ok(())
}

/// Distance of the blob's surface from its centre in the unit direction `d`.
fn radius(d: DVec3) -> f64 {
    1.0 + 0.05 * sin(13.0 * d.x) * sin(17.0 * d.y) * sin(11.0 * d.z)
        + 0.02 * sin(41.0 * d.x + 3.0) * sin(37.0 * d.y + 1.0) * sin(43.0 * d.z + 2.0)
}

#[rustfmt::skip]
fn icosahedron() -> Mesh {
    let p = (1.0 + 5f64.sqrt()) / 2.0;
    let vertices = [
        [-1.0, p, 0.0], [1.0, p, 0.0], [-1.0, -p, 0.0], [1.0, -p, 0.0], [0.0, -1.0, p], [0.0, 1.0, p],
        [0.0, -1.0, -p], [0.0, 1.0, -p], [p, 0.0, -1.0], [p, 0.0, 1.0], [-p, 0.0, -1.0], [-p, 0.0, 1.0],
    ];
    let faces = vec![
        [0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2], [10, 7, 6],
        [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11], [6, 2, 10], [8, 6, 7],
        [9, 8, 1],
    ];
    (vertices.into_iter().map(|v| unit(DVec3::from_array(v))).collect(), faces)
}

/// Cuts every triangle into four. New vertices are numbered in the order of their edges, all corner triangles come
/// before all middle ones: the numbering is that of the renderers that this mesh is compared on.
fn subdivide((mut vertices, faces): Mesh) -> Mesh {
    let edges = |[a, b, c]: [u32; 3]| [(a.min(b), a.max(b)), (b.min(c), b.max(c)), (c.min(a), c.max(a))];
    let mut middles: BTreeMap<(u32, u32), u32> =
        faces.iter().flat_map(|face| edges(*face)).map(|edge| (edge, 0)).collect();
    for ((a, b), middle) in &mut middles {
        *middle = vertices.len() as u32;
        vertices.push(unit(vertices[*a as usize] + vertices[*b as usize]));
    }
    let middles: Vec<[u32; 3]> = faces.iter().map(|face| edges(*face).map(|edge| middles[&edge])).collect();
    let mut finer = Vec::with_capacity(4 * faces.len());
    finer.extend(faces.iter().zip(&middles).map(|([a, _, _], [ab, _, ca])| [*a, *ab, *ca]));
    finer.extend(faces.iter().zip(&middles).map(|([_, b, _], [ab, bc, _])| [*b, *bc, *ab]));
    finer.extend(faces.iter().zip(&middles).map(|([_, _, c], [_, bc, ca])| [*c, *ca, *bc]));
    finer.extend(middles);
    (vertices, finer)
}

fn unit(v: DVec3) -> DVec3 {
    v / v.length()
}

fn ply(vertices: &[DVec3], faces: &[[u32; 3]]) -> Vec<u8> {
    let mut out = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        vertices.len(),
        faces.len()
    )
    .into_bytes();
    for vertex in vertices {
        out.extend(vertex.as_vec3().to_array().map(f32::to_le_bytes).as_flattened());
    }
    for face in faces {
        out.push(3);
        out.extend(face.map(u32::to_le_bytes).as_flattened());
    }
    out
}
