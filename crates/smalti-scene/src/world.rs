//! From the document to the world: all kinds of tables in turn, then what only the whole can show.

use std::path::Path;

use smalti_core::scene::world::{Material, Rgb};
use smalti_core::scene::{Frame, World, contact};
use toml::Spanned;
use toml::de::DeTable;

use crate::document::{Key, Section, key};
use crate::error::Result;
use crate::material::Palette;
use crate::mesh::Watch;
use crate::note::Note;
use crate::place::Places;
use crate::render_table::RenderTable;
use crate::{Loaded, camera, hash, light, mesh, soundness, surface};

const KINDS: &[Key] = &[
    key("camera", ""),
    key("render", ""),
    key("material", ""),
    key("polygon", ""),
    key("quad", ""),
    key("triangle", ""),
    key("sphere", ""),
    key("mesh", ""),
    key("light", ""),
    key("environment", ""),
];

/// The document as a table whose keys are the kinds.
pub fn root<'d>(document: &'d Spanned<DeTable<'d>>) -> Result<Section<'d>> {
    Section::of_entries(document.get_ref(), "the scene file".to_owned(), document.span(), KINDS)
}

/// Reads the scene that a document describes; `text` is its file. Mesh files are relative to the folder, and the watch is
/// called for each of them.
pub fn read<'d>(document: &'d Spanned<DeTable<'d>>, text: &str, meshes: (&Path, &Watch)) -> Result<Loaded> {
    let root = root(document)?;
    let mut notes = Vec::new();
    let cameras = camera::read(&root)?;
    let settings = RenderTable::read(&root)?;
    let mut palette = Palette::read(&root)?;
    let mut world = World {
        polygons: surface::polygons(&root, &palette)?,
        spheres: surface::spheres(&root, &palette)?,
        meshes: mesh::read_all(&root, &palette, meshes, &mut notes)?,
        cameras,
        ..World::default()
    };
    light::read(&root, &mut palette, &mut world)?;
    let names = palette.names;
    world.materials = palette.materials;
    let mut places = Places::of(&root)?;
    remove_clear(&mut world, &mut places, &names, &mut notes);
    world.order = places.order();
    if !has_light(&world) {
        notes.push(Note::warning("nothing in the scene emits light: the image will be black"));
    }
    let frame = Frame::of(&world);
    let pairs = contact::pairs(&world, &frame);
    notes.extend(soundness::notes((&world, &frame, &pairs), (text, &places, &names)));
    Ok(Loaded { scene_hash: hash::of(&world, &pairs), world, settings, notes })
}

/// Removes surfaces that cannot be seen: a dielectric with an index of exactly 1 that neither absorbs nor emits.
fn remove_clear(world: &mut World, places: &mut Places, names: &[&str], notes: &mut Vec<Note>) {
    let World { materials, polygons, spheres, meshes, .. } = world;
    let mut removed = vec![0usize; materials.len()];
    let mut keep = |material: usize, radiance: Option<Rgb>| {
        let clear = materials[material] == Material::clear(1.0) && radiance.is_none();
        removed[material] += usize::from(clear);
        !clear
    };
    let kept = [
        retain(polygons, |polygon| keep(polygon.material, polygon.radiance)),
        retain(spheres, |sphere| keep(sphere.material, sphere.radiance)),
        retain(meshes, |mesh| keep(mesh.material, mesh.radiance)),
    ];
    places.retain([&kept[0], &kept[1], &kept[2]]);
    for (name, count) in names.iter().zip(removed).filter(|(_, count)| *count > 0) {
        let what = if count == 1 { "1 surface is".to_owned() } else { format!("{count} surfaces are") };
        let why = "has an index of exactly 1 and cannot be seen";
        notes.push(Note::new(format!("material `{name}` {why}: {what} removed")));
    }
}

/// [`Vec::retain`], and which were kept.
fn retain<T>(list: &mut Vec<T>, keep: impl FnMut(&T) -> bool) -> Vec<bool> {
    let kept: Vec<bool> = list.iter().map(keep).collect();
    let mut these = kept.iter();
    list.retain(|_| these.next() == Some(&true));
    kept
}

fn has_light(world: &World) -> bool {
    world.environment.is_some()
        || !world.point_lights.is_empty()
        || world.polygons.iter().any(|polygon| polygon.radiance.is_some())
        || world.spheres.iter().any(|sphere| sphere.radiance.is_some())
        || world.meshes.iter().any(|mesh| mesh.radiance.is_some())
}
