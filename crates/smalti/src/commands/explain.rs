//! `smalti explain`: what a scene requires, and why.

use console::style;
use serde::Serialize;
use smalti_core::render::{Decision, Level, Renderer};
use smalti_core::scene::World;
use smalti_core::scene::world::Material;

use crate::args::ExplainArgs;
use crate::exit::{Failure, Status};
use crate::frontend::{self, Mode};
use crate::job::Job;
use crate::record::{self, Subject};
use crate::table::{Align, table};
use crate::{memory, print};

#[derive(Serialize)]
struct Explanation<'a> {
    #[serde(flatten)]
    subject: Subject<'a>,
    contents: Contents,
    simd: &'static str,
    simd_available: Vec<&'static str>,
    decisions: Vec<DecisionRecord<'a>>,
    /// Sum over the decisions.
    bytes: u64,
}

/// What the scene file holds.
#[derive(Debug, Default, PartialEq, Serialize)]
struct Contents {
    lambert: usize,
    mirror: usize,
    dielectric: usize,
    polygons: usize,
    spheres: usize,
    meshes: usize,
    triangles: usize,
    /// Polygons, spheres and meshes that emit.
    area_lights: usize,
    point_lights: usize,
    environment: bool,
    cameras: usize,
}

#[derive(Serialize)]
struct DecisionRecord<'a> {
    subject: &'a str,
    choice: &'a str,
    reason: &'a str,
    bytes: u64,
}

/// Runs the command.
pub fn run(args: &ExplainArgs) -> Result<Status, Failure> {
    let mode = Mode::of_terminal();
    let job = frontend::set_up(mode, |told| Job::load(&args.scene, &args.image, args.simd.simd, told))?;
    let renderer = frontend::set_up(mode, |told| job.renderer(told))?;
    match args.json {
        true => print::json(&explanation(&job, &renderer))?,
        false => print::result(&text(&job, &renderer))?,
    }
    Ok(Status::Done)
}

fn explanation<'a>(job: &'a Job, renderer: &'a Renderer) -> Explanation<'a> {
    Explanation {
        subject: record::subject(job),
        contents: contents(&job.world),
        simd: renderer.level().name(),
        simd_available: available(),
        decisions: renderer.decisions().iter().map(decision_record).collect(),
        bytes: bytes(renderer),
    }
}

fn bytes(renderer: &Renderer) -> u64 {
    renderer.decisions().iter().map(|decision| decision.bytes).sum()
}

fn decision_record(decision: &Decision) -> DecisionRecord<'_> {
    let Decision { subject, choice, reason, bytes } = decision;
    DecisionRecord { subject, choice, reason, bytes: *bytes }
}

fn available() -> Vec<&'static str> {
    Level::available().into_iter().map(Level::name).collect()
}

fn contents(world: &World) -> Contents {
    let materials = |wanted: fn(&Material) -> bool| world.materials.iter().filter(|material| wanted(material)).count();
    Contents {
        lambert: materials(|material| matches!(material, Material::Lambert { .. })),
        mirror: materials(|material| matches!(material, Material::Mirror { .. })),
        dielectric: materials(|material| matches!(material, Material::Dielectric { .. })),
        polygons: world.polygons.len(),
        spheres: world.spheres.len(),
        meshes: world.meshes.len(),
        triangles: world.meshes.iter().map(|mesh| mesh.faces.len()).sum(),
        area_lights: world.emitting(),
        point_lights: world.point_lights.len(),
        environment: world.environment.is_some(),
        cameras: world.cameras.len(),
    }
}

fn text(job: &Job, renderer: &Renderer) -> String {
    let settings = &job.settings;
    let mut text = format!(
        "{}: {} {}x{}, {} spp\n",
        job.path.display(),
        settings.integrator.name(),
        settings.width,
        settings.height,
        settings.spp
    );
    text += &facts(job, renderer);
    text += "\nThe plan\n";
    text += &plan(renderer.decisions());
    text += &job.notes.iter().map(|note| format!("\n{note}\n")).collect::<String>();
    text
}

/// What is there before anything is planned.
fn facts(job: &Job, renderer: &Renderer) -> String {
    let contents = contents(&job.world);
    let rows = [
        ("materials", in_words(&contents.materials())),
        ("surfaces", in_words(&contents.surfaces())),
        ("lights", in_words(&contents.lights())),
        ("memory", memory::in_words(bytes(renderer))),
        ("simd", format!("{}; this machine has {}", renderer.level().name(), available().join(", "))),
        ("scene hash", job.scene_hash.clone()),
    ];
    table(&[Align::Left, Align::Left], &rows.map(|(name, value)| vec![name.into(), value]))
}

impl Contents {
    fn materials(&self) -> [(usize, &'static str); 3] {
        [(self.lambert, "lambert"), (self.mirror, "mirror"), (self.dielectric, "dielectric")]
    }

    fn surfaces(&self) -> [(usize, &'static str); 4] {
        [
            (self.polygons, "polygons"),
            (self.spheres, "spheres"),
            (self.meshes, "meshes"),
            (self.triangles, "mesh triangles"),
        ]
    }

    fn lights(&self) -> [(usize, &'static str); 3] {
        [
            (self.area_lights, "emitting surfaces"),
            (self.point_lights, "points"),
            (usize::from(self.environment), "environment"),
        ]
    }
}

/// `lambert 3, mirror 1`; what is not there is not named.
fn in_words(counts: &[(usize, &str)]) -> String {
    let there: Vec<String> =
        counts.iter().filter(|(count, _)| *count > 0).map(|(count, name)| format!("{name} {count}")).collect();
    if there.is_empty() { "none".into() } else { there.join(", ") }
}

/// Each decision with its reason below it.
fn plan(decisions: &[Decision]) -> String {
    let lines = |decision: &Decision| {
        let Decision { subject, choice, reason, bytes } = decision;
        let memory = if *bytes == 0 { String::new() } else { format!(" ({})", memory::in_words(*bytes)) };
        [vec![subject.to_string(), format!("{choice}{memory}")], vec![String::new(), style(reason).dim().to_string()]]
    };
    let rows: Vec<Vec<String>> = decisions.iter().flat_map(lines).collect();
    table(&[Align::Left, Align::Left], &rows)
}

#[cfg(test)]
mod tests {
    use smalti_core::scene::world::{Mesh, Polygon, Sphere};

    use super::*;

    #[test]
    fn contents_are_counted() {
        let sphere = Sphere { centre: [0.0; 3].into(), radius: 1.0, material: 0, radiance: Some([1.0; 3]) };
        let world = World {
            materials: vec![Material::Lambert { albedo: [0.5; 3] }, Material::Mirror { reflectance: [1.0; 3] }],
            polygons: vec![Polygon { vertices: vec![], material: 0, radiance: None }],
            spheres: vec![sphere, Sphere { radiance: None, ..sphere }],
            meshes: vec![Mesh { faces: vec![[0, 1, 2]; 4], radiance: Some([1.0; 3]), ..Mesh::default() }],
            ..World::default()
        };
        let counted = contents(&world);
        assert_eq!((counted.lambert, counted.mirror, counted.dielectric), (1, 1, 0));
        assert_eq!((counted.polygons, counted.spheres, counted.meshes, counted.triangles), (1, 2, 1, 4));
        assert_eq!((counted.area_lights, counted.point_lights, counted.environment), (2, 0, false));
    }

    #[test]
    fn only_what_is_there_is_named() {
        assert_eq!(in_words(&[(2, "spheres"), (0, "meshes"), (1, "points")]), "spheres 2, points 1");
        assert_eq!(in_words(&[(0, "meshes")]), "none");
    }
}
