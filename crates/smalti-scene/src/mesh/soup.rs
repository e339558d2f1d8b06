//! What the mesh readers make: vertices and triangles, with the checks that all of them need.

use glam::DVec3;

/// Vertices and triangles as they are written in a file or a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Soup {
    /// Corners.
    pub vertices: Vec<DVec3>,
    /// Indices into `vertices`.
    pub faces: Vec<[u32; 3]>,
}

/// What is wrong with a mesh file.
#[derive(Clone, Debug, PartialEq)]
pub struct Flaw {
    /// One sentence without a full stop.
    pub message: String,
    /// The line at fault, from 1, if the file has lines.
    pub line: Option<usize>,
}

/// Most vertices or faces of a file: 3.2 GB of vertices. More is a mistake sooner than a mesh.
pub const MOST: usize = 1 << 27;

impl Flaw {
    /// A flaw of the whole file.
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), line: None }
    }

    /// A flaw at a line.
    pub fn at(line: usize, message: impl Into<String>) -> Self {
        Self { message: message.into(), line: Some(line) }
    }
}

impl Soup {
    /// Adds the face with these corners, cut into a fan of triangles from its first; which corner is wrong otherwise.
    /// `base` is the first vertex as the user counts them; here they count from 0.
    pub fn add_face(&mut self, corners: &[i64], base: i64) -> Result<(), String> {
        let count = self.vertices.len();
        let exists = |corner: i64| usize::try_from(corner).is_ok_and(|corner| corner < count);
        if let Some(bad) = corners.iter().find(|corner| !exists(**corner)) {
            let last = base + count as i64 - 1;
            return Err(format!("a face asks for vertex {}, but they are numbered {base} to {last}", bad + base));
        }
        let [first, rest @ ..] = corners else { return Err("a face has no vertices".to_owned()) };
        if rest.len() < 2 {
            return Err(format!("a face has {} vertices: it needs at least 3", corners.len()));
        }
        self.faces.extend(rest.windows(2).map(|pair| [*first as u32, pair[0] as u32, pair[1] as u32]));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_become_fans() {
        let mut soup = Soup { vertices: vec![DVec3::ZERO; 5], faces: Vec::new() };
        soup.add_face(&[4, 3, 2, 1, 0], 0).unwrap();
        assert_eq!(soup.faces, [[4, 3, 2], [4, 2, 1], [4, 1, 0]]);
        for bad in [&[0, 1, 5][..], &[0, 1, -1], &[0, 1], &[]] {
            assert!(soup.add_face(bad, 0).is_err(), "{bad:?}");
        }
        assert_eq!(soup.faces.len(), 3, "a bad face adds nothing");
    }
}
