//! Polygons and spheres: `[[polygon]]`, `[[quad]]`, `[[triangle]]` and `[[sphere]]`.

use smalti_core::scene::world::{Polygon, Rgb, Sphere};

use crate::document::{Bounds, Key, Node, Section, key};
use crate::error::Result;
use crate::material::Palette;
use crate::polygon;

/// What covers a surface.
pub struct Skin {
    /// Index of the material.
    pub material: usize,
    /// Radiance that it emits, if any.
    pub radiance: Option<Rgb>,
}

/// A kind of table that becomes a polygon.
pub struct Flat {
    /// Its key in the table above.
    pub name: &'static str,
    /// As the user writes it.
    pub heading: &'static str,
    /// How many corners it has; `None`: three or more.
    pub corners: Option<usize>,
}

const POLYGON_KEYS: &[Key] = &[
    key("material", "\"white\""),
    key("vertices", "[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]"),
    key("radiance", "[1, 1, 1]"),
];
const SPHERE_KEYS: &[Key] =
    &[key("material", "\"white\""), key("centre", "[0, 0, 1]"), key("radius", "1"), key("radiance", "[1, 1, 1]")];
const FLATS: &[Flat] = &[
    Flat { name: "polygon", heading: "`[[polygon]]`", corners: None },
    Flat { name: "quad", heading: "`[[quad]]`", corners: Some(4) },
    Flat { name: "triangle", heading: "`[[triangle]]`", corners: Some(3) },
];

/// All polygons, quads and triangles, in file order.
pub fn polygons(root: &Section, palette: &Palette) -> Result<Vec<Polygon>> {
    flats(root, FLATS, POLYGON_KEYS, |section| skin(section, palette))
}

/// The tables of several kinds of polygons, in file order.
pub fn flats(
    above: &Section,
    kinds: &[Flat],
    keys: &'static [Key],
    mut skin: impl FnMut(&Section) -> Result<Skin>,
) -> Result<Vec<Polygon>> {
    let mut found = Vec::new();
    for kind in kinds {
        for section in above.items(kind.name, kind.heading, keys)? {
            found.push((section, kind.corners));
        }
    }
    found.sort_by_key(|(section, _)| section.span.start);
    let polygon = |(section, corners): (Section, _)| {
        let Skin { material, radiance } = skin(&section)?;
        Ok(Polygon { vertices: polygon::read(section.need("vertices")?, corners)?, material, radiance })
    };
    found.into_iter().map(polygon).collect()
}

/// All spheres, in file order.
pub fn spheres(root: &Section, palette: &Palette) -> Result<Vec<Sphere>> {
    let sections = root.items("sphere", "`[[sphere]]`", SPHERE_KEYS)?;
    sections.iter().map(|section| sphere(section, skin(section, palette)?)).collect()
}

/// The sphere of a table with `centre` and `radius`.
pub fn sphere(section: &Section, Skin { material, radiance }: Skin) -> Result<Sphere> {
    let centre = section.need("centre")?.vector()?;
    let radius = section.need("radius")?.number(Bounds::POSITIVE)?;
    Ok(Sphere { centre, radius, material, radiance })
}

/// What the keys `material` and `radiance` say.
pub fn skin(section: &Section, palette: &Palette) -> Result<Skin> {
    let material = palette.find(section.need("material")?)?;
    Ok(Skin { material, radiance: section.read("radiance", emission)?.flatten() })
}

/// An amount of light; `None` if it is none.
pub fn emission(node: Node) -> Result<Option<Rgb>> {
    let light = node.triple(Bounds::LIGHT)?;
    Ok((light != [0.0; 3]).then_some(light))
}
