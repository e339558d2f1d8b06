//! `[material.NAME]`: exactly one of `lambert`, `mirror` and `dielectric`.

use smalti_core::scene::world::{Material, Rgb};

use crate::document::{Bounds, Key, Node, Section, advice, key};
use crate::error::{Fault, Result};

const KINDS: &[Key] = &[
    key("lambert", "{ albedo = [0.8, 0.8, 0.8] }"),
    key("mirror", "{ reflectance = [1, 1, 1] }"),
    key("dielectric", "{ ior = 1.5 }"),
];
const LAMBERT: &[Key] = &[key("albedo", "[0.8, 0.8, 0.8]")];
const MIRROR: &[Key] = &[key("reflectance", "[1, 1, 1]")];
const DIELECTRIC: &[Key] = &[key("ior", "1.5"), key("absorption", "[0.5, 0.2, 0.1]")];

/// The materials of a scene, in file order; behind them those that lights are made of.
pub struct Palette<'d> {
    /// Names of the user's materials.
    pub names: Vec<&'d str>,
    /// All materials.
    pub materials: Vec<Material>,
}

impl<'d> Palette<'d> {
    /// Reads all `[material.NAME]`.
    pub fn read(root: &Section<'d>) -> Result<Self> {
        let mut palette = Self { names: Vec::new(), materials: Vec::new() };
        let Some(node) = root.find("material") else { return Ok(palette) };
        for entry in Section::named(node, "`[material.NAME]`")? {
            palette.materials.push(material(entry)?);
            palette.names.push(entry.name);
        }
        Ok(palette)
    }

    /// Index of the material that `node` names.
    pub fn find(&self, node: Node) -> Result<usize> {
        let name = node.text()?;
        self.names.iter().position(|known| *known == name).ok_or_else(|| {
            let help = if self.names.is_empty() {
                format!("define it: `[material.{name}]` and below `lambert = {{ albedo = [0.8, 0.8, 0.8] }}`")
            } else {
                advice(name, self.names.iter().copied())
            };
            Fault::at(node.span(), format!("unknown material `{name}`"), "").help(help)
        })
    }

    /// Index of a diffuse material of a light.
    pub fn lambert(&mut self, albedo: Rgb) -> usize {
        let material = Material::Lambert { albedo };
        let known = self.materials.iter().skip(self.names.len()).position(|other| *other == material);
        known.map_or_else(
            || {
                self.materials.push(material);
                self.materials.len() - 1
            },
            |index| self.names.len() + index,
        )
    }
}

fn material(entry: Node) -> Result<Material> {
    let section = Section::open(entry, format!("`[material.{}]`", entry.name), KINDS)?;
    let mut kinds: Vec<Node> =
        ["lambert", "mirror", "dielectric"].iter().filter_map(|kind| section.find(kind)).collect();
    kinds.sort_by_key(|kind| kind.span().start);
    match kinds[..] {
        [] => Err(Fault::at(section.span, format!("material `{}` is of no kind", entry.name), "").help(
            "give it `lambert = { albedo = ... }`, `mirror = { reflectance = ... }` or `dielectric = { ior = ... }`",
        )),
        [kind] => of_kind(kind),
        [first, second, ..] => {
            Err(Fault::at(second.span(), format!("material `{}` is of two kinds", entry.name), "the second")
                .help(format!("it is `{}` already: keep one of them", first.name)))
        }
    }
}

fn of_kind(kind: Node) -> Result<Material> {
    let open = |keys| Section::open(kind, format!("`{}`", kind.name), keys);
    Ok(match kind.name {
        "lambert" => Material::Lambert { albedo: open(LAMBERT)?.need("albedo")?.triple(Bounds::FRACTION)? },
        "mirror" => Material::Mirror { reflectance: open(MIRROR)?.need("reflectance")?.triple(Bounds::FRACTION)? },
        _ => dielectric(&open(DIELECTRIC)?)?,
    })
}

fn dielectric(section: &Section) -> Result<Material> {
    let ior = section.need("ior")?.number(Bounds::IOR)?;
    let absorption = section.find("absorption").map(|node| node.triple(Bounds::LIGHT)).transpose()?;
    Ok(Material::Dielectric { ior, absorption: absorption.unwrap_or_default() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn materials_keep_their_order_and_lights_share_theirs() {
        let text = "[material.z]\nlambert = { albedo = 0 }\n[material.a]\nmirror.reflectance = [1, 0.5, 0]\n";
        let document = crate::document::parse(text).unwrap();
        let mut palette = Palette::read(&crate::world::root(&document).unwrap()).unwrap();
        assert_eq!(palette.names, ["z", "a"]);
        assert_eq!(palette.materials[1], Material::Mirror { reflectance: [1.0, 0.5, 0.0] });
        assert_eq!((palette.lambert([0.0; 3]), palette.lambert([0.1; 3]), palette.lambert([0.0; 3])), (2, 3, 2));
    }
}
