//! Lights: `[[light.quad]]`, `[[light.triangle]]`, `[[light.sphere]]`, `[[light.point]]` and `[environment]`.
//!
//! An area light is a surface like any other, diffuse and black unless it is given an `albedo`.

use smalti_core::scene::World;
use smalti_core::scene::world::{PointLight, Rgb};

use crate::document::{Bounds, Key, Section, key};
use crate::error::Result;
use crate::material::Palette;
use crate::surface::{Flat, Skin, emission, flats, sphere};

const KINDS: &[Key] = &[key("quad", ""), key("triangle", ""), key("sphere", ""), key("point", "")];
const FLAT_KEYS: &[Key] = &[
    key("vertices", "[[0, 0, 2], [0, 1, 2], [1, 1, 2], [1, 0, 2]]"),
    key("radiance", "[10, 10, 10]"),
    key("albedo", "[0, 0, 0]"),
];
const SPHERE_KEYS: &[Key] =
    &[key("centre", "[0, 0, 2]"), key("radius", "0.1"), key("radiance", "[10, 10, 10]"), key("albedo", "[0, 0, 0]")];
const POINT_KEYS: &[Key] = &[key("position", "[0, 0, 2]"), key("intensity", "[10, 10, 10]")];
const ENVIRONMENT_KEYS: &[Key] = &[key("radiance", "[1, 1, 1]")];
const FLATS: &[Flat] = &[
    Flat { name: "quad", heading: "`[[light.quad]]`", corners: Some(4) },
    Flat { name: "triangle", heading: "`[[light.triangle]]`", corners: Some(3) },
];

/// Adds all lights to `world`: area lights behind the surfaces of their kind.
pub fn read(root: &Section, palette: &mut Palette, world: &mut World) -> Result<()> {
    world.environment = environment(root)?;
    let Some(node) = root.find("light") else { return Ok(()) };
    if node.value().is_array() {
        let fault = node.fault("must say of which kind", "a list");
        return Err(fault.help("write `[[light.quad]]`, `[[light.triangle]]`, `[[light.sphere]]` or `[[light.point]]`"));
    }
    let section = Section::open(node, "`light`", KINDS)?;
    world.polygons.extend(flats(&section, FLATS, FLAT_KEYS, |light| skin(light, palette))?);
    for light in section.items("sphere", "`[[light.sphere]]`", SPHERE_KEYS)? {
        world.spheres.push(sphere(&light, skin(&light, palette)?)?);
    }
    for light in section.items("point", "`[[light.point]]`", POINT_KEYS)? {
        world.point_lights.extend(point(&light)?);
    }
    Ok(())
}

fn environment(root: &Section) -> Result<Option<Rgb>> {
    let Some(node) = root.find("environment") else { return Ok(None) };
    emission(Section::open(node, "`[environment]`", ENVIRONMENT_KEYS)?.need("radiance")?)
}

fn skin(light: &Section, palette: &mut Palette) -> Result<Skin> {
    let albedo = light.read("albedo", |node| node.triple(Bounds::FRACTION))?.unwrap_or_default();
    Ok(Skin { material: palette.lambert(albedo), radiance: emission(light.need("radiance")?)? })
}

fn point(light: &Section) -> Result<Option<PointLight>> {
    let position = light.need("position")?.vector()?;
    Ok(emission(light.need("intensity")?)?.map(|intensity| PointLight { position, intensity }))
}
