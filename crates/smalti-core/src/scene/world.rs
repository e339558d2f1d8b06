//! The world: what a scene file says, checked, in f64 and in the user's own units; names already indices.
//!
//! A world is what a scene reader (or a test) hands to the core. [`Scene`](super::Scene) is what the kernels trace:
//! the same thing recentred, scaled to about 1 and rounded to f32.

use glam::DVec3;

use super::Origin;

/// A linear RGB triple in f64: an albedo, a radiance (W m⁻² sr⁻¹) or an intensity (W sr⁻¹).
pub type Rgb = [f64; 3];

/// Everything that a render needs to know about the scene. Lengths in metres, right-handed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct World {
    /// What the surfaces are made of; other items name them by index.
    pub materials: Vec<Material>,
    /// Planar convex polygons.
    pub polygons: Vec<Polygon>,
    /// Spheres.
    pub spheres: Vec<Sphere>,
    /// Indexed triangle meshes.
    pub meshes: Vec<Mesh>,
    /// Lights without extent.
    pub point_lights: Vec<PointLight>,
    /// Radiance that arrives from infinity, the same from every direction.
    pub environment: Option<Rgb>,
    /// At least one camera.
    pub cameras: Vec<Camera>,
    /// In which order the surfaces were written.
    pub order: Order,
}

/// In which order surfaces were written: of those in one place the first is seen. Each list has a place for each item of
/// the world's list of that name, or is empty: then polygons come before meshes, and both as they are listed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Order {
    /// Places of the polygons.
    pub polygons: Vec<usize>,
    /// Places of the meshes.
    pub meshes: Vec<usize>,
}

impl World {
    /// Where a surface stands among all: lower is earlier. Of one mesh the triangles are as they are listed.
    pub fn place(&self, surface: Origin) -> (usize, u32) {
        match surface {
            Origin::Polygon(index) => (*self.order.polygons.get(index as usize).unwrap_or(&(index as usize)), 0),
            Origin::Mesh(index, triangle) => {
                let default = self.polygons.len() + index as usize;
                (*self.order.meshes.get(index as usize).unwrap_or(&default), triangle)
            }
            Origin::Sphere(index) => (index as usize, 0),
        }
    }

    /// Corners of a face, metres; none for a sphere.
    pub fn corners(&self, face: Origin) -> Vec<DVec3> {
        match face {
            Origin::Polygon(index) => self.polygons[index as usize].vertices.clone(),
            Origin::Mesh(index, triangle) => {
                let mesh = &self.meshes[index as usize];
                mesh.faces[triangle as usize].map(|corner| mesh.vertices[corner as usize]).to_vec()
            }
            Origin::Sphere(_) => Vec::new(),
        }
    }

    /// Index of the material that a surface is of, and its radiance.
    pub fn skin(&self, surface: Origin) -> (usize, Option<Rgb>) {
        match surface {
            Origin::Polygon(index) => {
                let polygon = &self.polygons[index as usize];
                (polygon.material, polygon.radiance)
            }
            Origin::Mesh(index, _) => (self.meshes[index as usize].material, self.meshes[index as usize].radiance),
            Origin::Sphere(index) => (self.spheres[index as usize].material, self.spheres[index as usize].radiance),
        }
    }

    /// Low and high corner of all geometry and of the lights without extent; `None` if there is nothing.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let polygons = self.polygons.iter().flat_map(|polygon| polygon.vertices.iter().copied());
        let meshes = self.meshes.iter().flat_map(|mesh| mesh.vertices.iter().copied());
        let spheres = self.spheres.iter().flat_map(|ball| [ball.centre - ball.radius, ball.centre + ball.radius]);
        let lights = self.point_lights.iter().map(|light| light.position);
        let points = polygons.chain(meshes).chain(spheres).chain(lights).map(|point| (point, point));
        points.reduce(|(low, high), (point, _)| (low.min(point), high.max(point)))
    }

    /// The same world elsewhere: every point put where `place` says, with radii × `scale`, point lights × `scale`² and
    /// absorption ÷ `scale`, so that it looks the same where `place` multiplies all lengths by `scale`. What is up for a
    /// camera stays up.
    pub fn placed(&self, scale: f64, place: impl Fn(DVec3) -> DVec3) -> Self {
        let mut world = self.clone();
        world.polygons.iter_mut().flat_map(|polygon| &mut polygon.vertices).for_each(|v| *v = place(*v));
        world.meshes.iter_mut().flat_map(|mesh| &mut mesh.vertices).for_each(|v| *v = place(*v));
        for sphere in &mut world.spheres {
            (sphere.centre, sphere.radius) = (place(sphere.centre), sphere.radius * scale);
        }
        for light in &mut world.point_lights {
            light.position = place(light.position);
            light.intensity = light.intensity.map(|channel| channel * scale * scale);
        }
        for material in &mut world.materials {
            if let Material::Dielectric { absorption, .. } = material {
                *absorption = absorption.map(|each| each / scale);
            }
        }
        for camera in &mut world.cameras {
            (camera.eye, camera.look_at) = (place(camera.eye), place(camera.look_at));
        }
        world
    }

    /// Number of polygons, spheres and meshes that emit.
    pub fn emitting(&self) -> usize {
        let polygons = self.polygons.iter().filter(|polygon| polygon.radiance.is_some()).count();
        let spheres = self.spheres.iter().filter(|sphere| sphere.radiance.is_some()).count();
        let meshes = self.meshes.iter().filter(|mesh| mesh.radiance.is_some()).count();
        polygons + spheres + meshes
    }
}

/// How a surface scatters light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Material {
    /// Ideal diffuse reflection on both sides; albedo in [0, 1].
    Lambert {
        /// Fraction of the light that is reflected, per channel.
        albedo: Rgb,
    },
    /// Ideal mirror on both sides; reflectance in [0, 1].
    Mirror {
        /// Fraction of the light that is reflected, per channel.
        reflectance: Rgb,
    },
    /// Smooth boundary of a medium, as seen from a vacuum: the outside is where the normal points.
    Dielectric {
        /// Index of refraction of the inside, > 0.
        ior: f64,
        /// Absorption coefficient of the inside, m⁻¹, at least 0: of the light that goes a distance d in it the part
        /// e^(−absorption · d) is left (Beer and Lambert).
        absorption: Rgb,
    },
}

impl Material {
    /// A dielectric that absorbs nothing.
    pub const fn clear(ior: f64) -> Self {
        Self::Dielectric { ior, absorption: [0.0; 3] }
    }

    /// Whether light that goes through it gets less.
    pub fn absorbs(&self) -> bool {
        matches!(self, Self::Dielectric { absorption, .. } if *absorption != [0.0; 3])
    }

    /// Whether it bounds a medium.
    pub fn is_dielectric(&self) -> bool {
        matches!(self, Self::Dielectric { .. })
    }

    /// Whether it sends all light one or two ways, and so casts caustics.
    pub fn is_specular(&self) -> bool {
        matches!(self, Self::Mirror { .. } | Self::Dielectric { .. })
    }
}

/// A planar convex polygon with at least three vertices. Its normal follows the right-hand rule.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// Corners in order.
    pub vertices: Vec<DVec3>,
    /// Index into [`World::materials`].
    pub material: usize,
    /// Radiance that leaves the front side (where the normal points), W m⁻² sr⁻¹.
    pub radiance: Option<Rgb>,
}

/// A sphere; its normal points outward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre, metres.
    pub centre: DVec3,
    /// Radius, metres, > 0.
    pub radius: f64,
    /// Index into [`World::materials`].
    pub material: usize,
    /// Radiance that leaves the outside, W m⁻² sr⁻¹.
    pub radiance: Option<Rgb>,
}

/// An indexed triangle mesh with flat normals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Corners, metres, already transformed.
    pub vertices: Vec<DVec3>,
    /// Three indices into `vertices` a triangle, right-hand winding.
    pub faces: Vec<[u32; 3]>,
    /// Index into [`World::materials`].
    pub material: usize,
    /// Radiance that leaves the front side of every triangle, W m⁻² sr⁻¹.
    pub radiance: Option<Rgb>,
}

/// A light without extent, the same in all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// Where it is, metres.
    pub position: DVec3,
    /// Radiant intensity, W sr⁻¹.
    pub intensity: Rgb,
}

/// A pinhole camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// The name in the scene file; empty for the only camera.
    pub name: String,
    /// The pinhole, metres.
    pub eye: DVec3,
    /// A point in the middle of the picture, metres.
    pub look_at: DVec3,
    /// A direction that is up in the picture.
    pub up: DVec3,
    /// Vertical field of view, radians, in (0, π).
    pub fov: f64,
}
