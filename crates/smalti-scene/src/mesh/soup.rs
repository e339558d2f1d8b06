//! What the mesh readers make: vertices and triangles, with the checks that all of them need.

use glam::DVec3;

use super::face;
use super::tally::Tally;

/// Vertices and triangles as they are written in a file or a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Soup {
    /// Corners.
    pub vertices: Vec<DVec3>,
    /// Indices into `vertices`.
    pub faces: Vec<[u32; 3]>,
    /// What is not used.
    pub tally: Tally,
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
    /// Adds the face with these corners, cut into triangles; which corner is wrong otherwise. A face with fewer than
    /// three different corners is counted instead. `base` is the first vertex as the user counts them; here from 0.
    pub fn add_face(&mut self, corners: &[i64], base: i64) -> Result<(), String> {
        let count = self.vertices.len();
        let exists = |corner: i64| usize::try_from(corner).is_ok_and(|corner| corner < count);
        if let Some(bad) = corners.iter().find(|corner| !exists(**corner)) {
            let last = base + count as i64 - 1;
            // No vertex at all is numbered then.
            let numbered =
                if count == 0 { "there is none".to_owned() } else { format!("they are numbered {base} to {last}") };
            return Err(format!("a face asks for vertex {}, but {numbered}", i128::from(*bad) + i128::from(base)));
        }
        if has_three(corners) {
            self.cut(corners);
        } else {
            self.tally.short += 1;
        }
        Ok(())
    }

    /// The fan from the first corner where it covers the face, as it does every convex one.
    fn cut(&mut self, corners: &[i64]) {
        let vertices = &self.vertices;
        let at = |corner: usize| vertices[corners[corner] as usize];
        if let [a, b, c] = *corners {
            self.faces.push([a as u32, b as u32, c as u32]);
        } else if face::fan_covers(corners.len(), at) {
            let pairs = corners[1..].windows(2);
            self.faces.extend(pairs.map(|pair| [corners[0] as u32, pair[0] as u32, pair[1] as u32]));
        } else {
            let places: Vec<DVec3> = (0..corners.len()).map(at).collect();
            let cut = face::cut(&places);
            self.tally.crossing += usize::from(cut.crosses);
            self.faces.extend(cut.triangles.iter().map(|triangle| triangle.map(|corner| corners[corner] as u32)));
        }
    }
}

/// Whether at least three of the corners differ.
fn has_three(corners: &[i64]) -> bool {
    let Some(&first) = corners.first() else { return false };
    let Some(&second) = corners.iter().find(|&&corner| corner != first) else { return false };
    corners.iter().any(|&corner| corner != first && corner != second)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Corners of a regular pentagon, all of the same vertex beside.
    fn pentagon() -> Vec<DVec3> {
        let corner = |k: i32| libm::sincos(f64::from(k) * 1.256_637_061_435_917_3);
        (0..5).map(corner).map(|(y, x)| DVec3::new(x, y, 7.0)).collect()
    }

    #[test]
    fn convex_faces_become_fans_of_their_first_corner() {
        let mut soup = Soup { vertices: pentagon(), ..Soup::default() };
        soup.add_face(&[4, 3, 2, 1, 0], 0).unwrap();
        assert_eq!(soup.faces, [[4, 3, 2], [4, 2, 1], [4, 1, 0]]);
        soup.add_face(&[2, 3, 4, 0, 1], 0).unwrap();
        assert_eq!(soup.faces[3..], [[2, 3, 4], [2, 4, 0], [2, 0, 1]]);
        for bad in [&[0, 1, 5][..], &[0, 1, -1], &[0, i64::MAX, 1]] {
            assert!(soup.add_face(bad, 1).is_err(), "{bad:?}");
        }
        assert_eq!((soup.faces.len(), soup.tally), (6, Tally::default()), "a bad face adds nothing");
    }

    #[test]
    fn faces_without_three_corners_are_counted() {
        let mut soup = Soup { vertices: pentagon(), ..Soup::default() };
        for short in [&[][..], &[1], &[1, 2], &[1, 1, 1], &[1, 2, 1, 2]] {
            soup.add_face(short, 0).unwrap();
        }
        assert_eq!((soup.faces.len(), soup.tally.short), (0, 5));
        soup.add_face(&[0, 0, 1, 2], 0).unwrap();
        assert_eq!((&soup.faces[..], soup.tally.short), (&[[0, 1, 2]][..], 5), "a corner twice is one corner");
    }
}
