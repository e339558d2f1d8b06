//! What the elements of a PLY file are for, and what of them is not used.

use super::super::soup::Flaw;
use super::super::tally::{Content, Tally};
use super::header::{Element, Kind, Property};

/// Names under which programs store the corners of a face.
pub const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// What an element is for.
#[derive(Debug, PartialEq)]
pub enum Role {
    Vertices,
    Corners(Part),
    Unused,
}

/// How lists of corners become triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    Faces,
    Strips,
}

/// The role of each element; what is missing otherwise.
pub fn roles(elements: &[Element]) -> Result<Vec<Role>, Flaw> {
    let roles: Vec<Role> = elements.iter().map(role).collect();
    if !roles.contains(&Role::Vertices) {
        return Err(Flaw::new("there is no element `vertex` with numbers x, y and z"));
    }
    let has_corners = |(element, role): (&Element, &Role)| element.count > 0 && matches!(role, Role::Corners(_));
    if !elements.iter().zip(&roles).any(has_corners) {
        return Err(Flaw::new("there is no face in it (element `face` or `tristrips` with `vertex_indices`)"));
    }
    Ok(roles)
}

fn role(element: &Element) -> Role {
    let is_number = |name: &str| element.properties.iter().any(|p| p.name == name && matches!(p.kind, Kind::One(_)));
    let has_corners = element.properties.iter().any(is_corners);
    match element.name.as_str() {
        "vertex" if ["x", "y", "z"].into_iter().all(is_number) => Role::Vertices,
        "face" if has_corners => Role::Corners(Part::Faces),
        "tristrips" if has_corners => Role::Corners(Part::Strips),
        _ => Role::Unused,
    }
}

/// Whether the property holds the corners of a face or strip.
pub fn is_corners(property: &Property) -> bool {
    CORNERS.contains(&property.name.as_str()) && matches!(property.kind, Kind::List { .. })
}

/// Counts what an element holds and is not used: each kind of it once for each item.
pub fn unused(element: &Element, role: &Role, tally: &mut Tally) {
    let mut found: Vec<Content> = match role {
        Role::Vertices => {
            element.properties.iter().filter(|p| !["x", "y", "z"].contains(&p.name.as_str())).map(content).collect()
        }
        Role::Corners(_) => element.properties.iter().filter(|p| !is_corners(p)).map(content).collect(),
        Role::Unused => vec![Content::Element(element.name.clone())],
    };
    found.sort();
    found.dedup();
    found.into_iter().for_each(|content| tally.add(content, element.count));
}

fn content(property: &Property) -> Content {
    match property.name.as_str() {
        "nx" | "ny" | "nz" => Content::Normals,
        "red" | "green" | "blue" | "alpha" | "diffuse_red" | "diffuse_green" | "diffuse_blue" => Content::Colours,
        "s" | "t" | "u" | "v" | "texture_u" | "texture_v" | "texcoord" | "texnumber" => Content::TextureCoordinates,
        name => Content::Property(name.to_owned()),
    }
}
