//! The scene twice: the [`World`] as a user describes it (f64), and the compiled [`Scene`] that is traced (f32).
//!
//! In a scene everything is an index into a flat table. Primitives are numbered through: faces (planar convex polygons;
//! those that emit first, then the others; of each the polygons, then the mesh triangles), then spheres. Ties between hits
//! at the same distance go to the lower number; where faces coincide they are numbered anew, so that it is the right one
//! ([`contact`]).

mod compile;
pub mod contact;
pub mod details;
pub mod double;
pub mod frame;
pub mod media;
pub mod soundness;
pub mod world;

pub use compile::{compile, newell};
pub use contact::{Joints, Room};
pub use frame::Frame;
pub use media::Media;
pub use world::World;

use crate::light::table::LightTable;

/// A compiled scene. Coordinates are in its [`Frame`], within [-1, 1].
pub struct Scene {
    /// Maps metres to the frame and back.
    pub frame: Frame,
    /// Unique corners of all faces.
    pub vertices: Vec<[f32; 3]>,
    /// Indices into `vertices`, face by face.
    pub corners: Vec<u32>,
    /// Planar convex polygons.
    pub faces: Vec<Face>,
    /// Centre and radius.
    pub spheres: Vec<[f32; 4]>,
    /// What shading reads of a primitive.
    pub shades: Vec<Shade>,
    /// For each primitive its [`Class`] and, above [`Class::BITS`], its emitter number + 1 (0: it does not emit).
    pub classes: Vec<u32>,
    /// Where each primitive comes from.
    pub origins: Vec<Origin>,
    /// Number of distinct planes; surface ids below are planes, from here on spheres.
    pub planes: u32,
    /// Everything that emits, but the environment.
    pub lights: LightTable,
    /// Radiance from infinity.
    pub environment: Option<[f32; 3]>,
    /// The cameras.
    pub views: Vec<View>,
    /// What rays travel in, where some of it absorbs.
    pub media: Option<Media>,
    /// How far rays may start off primitives, where some nearly touch.
    pub room: Option<Room>,
    /// Dielectrics in one place, where some are.
    pub joints: Option<Joints>,
    /// Primitives without area that were left out.
    pub dropped: usize,
}

/// A planar convex polygon.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// Index of its first corner in [`Scene::corners`].
    pub first: u32,
    /// Number of corners, at least 3.
    pub count: u32,
    /// Unit normal n and distance d: n·x = d.
    pub plane: [f32; 4],
    /// Id that all faces of one plane share.
    pub surface: u32,
}

/// What shading reads of a primitive: plane or sphere (4), colour (3; for a dielectric n, 1/n, (n−1)(n+1)),
/// surface id (bits).
pub type Shade = [f32; 8];

/// Which stage continues a path at a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Class {
    /// Reflects nothing: the path ends.
    Black = 0,
    /// Ideal diffuse.
    Lambert = 1,
    /// Ideal mirror.
    Mirror = 2,
    /// Smooth dielectric boundary.
    Dielectric = 3,
}

impl Class {
    /// Bits that a class takes in [`Scene::classes`].
    pub const BITS: u32 = 4;

    /// The class in an entry of [`Scene::classes`].
    pub(crate) fn of(code: u32) -> Self {
        let known = [Class::Black, Class::Lambert, Class::Mirror, Class::Dielectric];
        known[(code & ((1 << Class::BITS) - 1)) as usize % known.len()]
    }
}

/// Where a primitive comes from, for messages; in the order of the world's lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Origin {
    /// Index into the world's polygons.
    Polygon(u32),
    /// Index into the world's meshes and into that mesh's faces.
    Mesh(u32, u32),
    /// Index into the world's spheres.
    Sphere(u32),
}

/// A camera, ready to make rays: direction = forward + x·right + y·up with y in [-1, 1] over the picture's height.
#[derive(Clone, Debug)]
pub struct View {
    /// Name in the scene file.
    pub name: String,
    /// The pinhole.
    pub eye: [f32; 3],
    /// Unit vector into the picture.
    pub forward: [f32; 3],
    /// To the right, half the picture's height long at distance 1.
    pub right: [f32; 3],
    /// Up, half the picture's height long at distance 1.
    pub up: [f32; 3],
}

impl Scene {
    /// Corners of a face.
    pub fn face_corners(&self, face: &Face) -> &[u32] {
        &self.corners[face.first as usize..(face.first + face.count) as usize]
    }

    /// The surface id of a primitive.
    pub fn surface(&self, prim: u32) -> u32 {
        self.shades[prim as usize][7].to_bits()
    }

    /// The class of a primitive; `None` for no primitive.
    pub fn class(&self, prim: u32) -> Option<Class> {
        self.classes.get(prim as usize).map(|code| Class::of(*code))
    }

    /// Whether any primitive is of this class.
    pub fn has(&self, class: Class) -> bool {
        let mask = (1 << Class::BITS) - 1;
        self.classes.iter().any(|code| code & mask == class as u32)
    }

    /// Axis-aligned box of a primitive: low and high corner.
    pub fn bounds(&self, prim: u32) -> ([f32; 3], [f32; 3]) {
        match self.faces.get(prim as usize) {
            Some(face) => self.face_bounds(face),
            None => {
                let [x, y, z, r] = self.spheres[prim as usize - self.faces.len()];
                ([x - r, y - r, z - r].map(f32::next_down), [x + r, y + r, z + r].map(f32::next_up))
            }
        }
    }

    fn face_bounds(&self, face: &Face) -> ([f32; 3], [f32; 3]) {
        let mut low = [f32::INFINITY; 3];
        let mut high = [f32::NEG_INFINITY; 3];
        for &corner in self.face_corners(face) {
            for k in 0..3 {
                low[k] = low[k].min(self.vertices[corner as usize][k]);
                high[k] = high[k].max(self.vertices[corner as usize][k]);
            }
        }
        (low, high)
    }
}
