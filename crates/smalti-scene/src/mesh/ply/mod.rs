//! PLY: text, and binary of both byte orders. A scene of 1.3 M triangles loads in 0.3 s of one core.
//!
//! Our own reader, because the crate `ply-rs-bw` parses what is not used (and so refuses `nan` among normals), cannot
//! read indices that are written as floats, and answers in its own words.
//!
//! The header is checked before the numbers are read, so that a header that lies neither allocates nor spins.

mod body;
mod header;
mod role;

use glam::DVec3;

use super::soup::{Flaw, Soup};
use super::tally::Content;
use super::text::without_mark;
use body::Body;
use header::{Element, Kind};
use role::{Part, Role, is_corners, roles, unused};

/// Reads a PLY file: the elements `vertex` (`x`, `y`, `z`), `face` and `tristrips` (`vertex_indices`). All others are
/// counted, and are not used.
pub fn read(bytes: &[u8]) -> Result<Soup, Flaw> {
    let (header, lines) = header::read(without_mark(bytes))?;
    let roles = roles(&header.elements)?;
    let mut body = Body::new(header.encoding, lines);
    let mut soup = Soup::default();
    // Triangles can be cut once vertices are known, which may come later.
    let (mut has_vertices, mut early) = (false, Vec::new());
    for (element, role) in header.elements.iter().zip(&roles) {
        match role {
            Role::Vertices => vertices(element, &mut body, &mut soup)?,
            Role::Corners(part) if has_vertices => part.read(element, &mut body, &mut soup)?,
            Role::Corners(part) => {
                early.push((element, part, body.clone()));
                skip(element, &mut body)?;
            }
            Role::Unused => skip(element, &mut body)?,
        }
        has_vertices |= *role == Role::Vertices;
        unused(element, role, &mut soup.tally);
    }
    for (element, part, mut body) in early {
        part.read(element, &mut body, &mut soup)?;
    }
    let behind = body.behind().iter().filter(|byte| !byte.is_ascii_whitespace() && **byte != 0);
    soup.tally.add(Content::Bytes, behind.count());
    if soup.faces.is_empty() && soup.tally.short > 0 {
        return Err(Flaw::new("none of its faces has three different corners"));
    }
    Ok(soup)
}

fn skip(element: &Element, body: &mut Body) -> Result<(), Flaw> {
    rows(element, body, |body| element.properties.iter().try_for_each(|property| body.skip(property.kind))).map(drop)
}

/// Reads every row of an element by `read`; where one is wrong, its line or number. Returns how many words were left.
fn rows(
    element: &Element,
    body: &mut Body,
    mut read: impl FnMut(&mut Body) -> Result<(), String>,
) -> Result<usize, Flaw> {
    let mut surplus = 0;
    for row in 0..element.count {
        body.begin_row();
        read(body).map_err(|wrong| match body.line() {
            Some(line) => Flaw::at(line, wrong),
            None => Flaw::new(format!("{wrong} (`{}` {row}, counted from 0)", element.name)),
        })?;
        surplus += body.surplus();
    }
    Ok(surplus)
}

fn vertices(element: &Element, body: &mut Body, soup: &mut Soup) -> Result<(), Flaw> {
    soup.vertices.reserve(element.count);
    let surplus = rows(element, body, |body| {
        soup.vertices.push(vertex(element, body)?);
        Ok(())
    })?;
    soup.tally.add(Content::Numbers, surplus);
    Ok(())
}

fn vertex(element: &Element, body: &mut Body) -> Result<DVec3, String> {
    let mut place = DVec3::ZERO;
    for property in &element.properties {
        match (property.name.as_str(), property.kind) {
            ("x", Kind::One(number)) => place.x = body.number(number)?,
            ("y", Kind::One(number)) => place.y = body.number(number)?,
            ("z", Kind::One(number)) => place.z = body.number(number)?,
            (_, kind) => body.skip(kind)?,
        }
    }
    if place.is_finite() { Ok(place) } else { Err("a vertex is not finite".to_owned()) }
}

impl Part {
    fn read(self, element: &Element, body: &mut Body, soup: &mut Soup) -> Result<(), Flaw> {
        soup.faces.reserve(element.count);
        let mut corners = Vec::new();
        let surplus = rows(element, body, |body| {
            read_corners(element, body, &mut corners)?;
            match self {
                Self::Faces => soup.add_face(&corners, 0),
                Self::Strips => add_strips(soup, &corners),
            }
        })?;
        soup.tally.add(Content::Numbers, surplus);
        Ok(())
    }
}

fn read_corners(element: &Element, body: &mut Body, corners: &mut Vec<i64>) -> Result<(), String> {
    corners.clear();
    for property in &element.properties {
        match property.kind {
            Kind::List { length, item } if is_corners(property) => {
                for _ in 0..body.length(length)? {
                    corners.push(body.index(item)?);
                }
            }
            kind => body.skip(kind)?,
        }
    }
    Ok(())
}

/// Adds strips of triangles, each of which shares its first edge with the one before and is wound like it: every second
/// one has its first corners swapped. -1 ends a strip (in a list of unsigned numbers the largest does). Triangles with a
/// corner twice only lead from one place to another.
fn add_strips(soup: &mut Soup, corners: &[i64]) -> Result<(), String> {
    for strip in corners.split(|&corner| corner == -1 || corner == u32::MAX.into()) {
        for (index, triangle) in strip.windows(3).enumerate() {
            let [a, b, c] = [triangle[0], triangle[1], triangle[2]];
            if a != b && b != c && c != a {
                soup.add_face(&if index % 2 == 0 { [a, b, c] } else { [b, a, c] }, 0)?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
