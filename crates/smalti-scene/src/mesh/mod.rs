//! `[[mesh]]`: faces from a file (PLY, OBJ) or written out, cut into triangles, transformed, and cleared of those without
//! area. What is not used of a file is counted.

mod face;
mod files;
mod inline;
mod kind;
mod obj;
mod ply;
mod soup;
mod tally;
mod text;
mod transform;

use std::path::Path;

use smalti_core::scene::world::Mesh;

use crate::document::{Key, Node, Section, key};
use crate::error::{Excerpt, Fault, Result};
use crate::file;
use crate::material::Palette;
use crate::note::Note;
use crate::surface::{Skin, skin};
use files::Files;
pub use files::{Reading, Watch};
use soup::{Flaw, Soup};
use text::{Lines, shown, without_mark};

const KEYS: &[Key] = &[
    key("material", "\"white\""),
    key("file", "\"blob.ply\""),
    key("vertices", "[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]"),
    key("faces", "[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]"),
    key("translate", "[0, 0, 1]"),
    key("rotate", "[0, 0, 90]"),
    key("scale", "2"),
    key("radiance", "[1, 1, 1]"),
];

/// All meshes, in file order; `file` is relative to the folder, and whoever watches hears of it. What is dropped is noted.
pub fn read_all(
    root: &Section,
    palette: &Palette,
    (folder, watch): (&Path, &Watch),
    notes: &mut Vec<Note>,
) -> Result<Vec<Mesh>> {
    let mut meshes = Vec::new();
    let sections = root.items("mesh", "`[[mesh]]`", KEYS)?;
    let mut files = Files::new(&sections, folder, watch);
    for (index, section) in sections.iter().enumerate() {
        let Skin { material, radiance } = skin(section, palette)?;
        let (name, mut soup) = soup(section, &mut files, index)?;
        transform::apply(section, &mut soup.vertices)?;
        let found = soup.tally.notes(&name).into_iter().chain(drop_degenerate(&name, &mut soup));
        // A file that is named twice has nothing new to say.
        found.for_each(|note| {
            if !notes.contains(&note) {
                notes.push(note)
            }
        });
        meshes.push(Mesh { vertices: soup.vertices, faces: soup.faces, material, radiance });
    }
    Ok(meshes)
}

/// The triangles as they are written, and what to call them.
fn soup(section: &Section, files: &mut Files<Soup>, index: usize) -> Result<(String, Soup)> {
    match (section.find("file"), section.find("vertices").or(section.find("faces"))) {
        (Some(file), None) => Ok((format!("`{}`", file.text()?), files.read(file, from_file)?)),
        (Some(file), Some(also)) => {
            Err(Fault::at(also.span(), "the mesh has both a file and triangles of its own", "")
                .help(format!("keep `{}`, or `vertices` and `faces`", file.name)))
        }
        (None, Some(_)) => Ok((format!("mesh {}", index + 1), inline::read(section)?)),
        (None, None) => Err(Fault::at(section.span.clone(), "the mesh has no triangles", "")
            .help("give it `file = \"blob.ply\"`, or `vertices` and `faces`")),
    }
}

fn from_file(node: Node, folder: &Path) -> Result<Soup> {
    let path = folder.join(node.text()?);
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let read = match extension.as_str() {
        "ply" => ply::read,
        "obj" => obj::read,
        _ => {
            let fault = Fault::at(node.span(), "unknown kind of mesh file", "");
            return Err(fault.help("its name must end in .ply or .obj"));
        }
    };
    let bytes = file::mesh_bytes(&path)
        .map_err(|(title, help)| Fault::at(node.span(), title, path.display().to_string()).maybe_help(help))?;
    if let Some(stranger) = kind::stranger(&bytes, &extension) {
        let title = format!("the mesh file is {}", stranger.is);
        return Err(Fault::at(node.span(), title, path.display().to_string()).help(stranger.help));
    }
    read(&bytes).map_err(|flaw| broken(node, &path, &bytes, flaw))
}

/// The answer to a broken mesh file: the place that names it, and the file's own line if it has lines.
fn broken(node: Node, path: &Path, bytes: &[u8], flaw: Flaw) -> Box<Fault> {
    let mut fault = Fault::at(node.span(), format!("broken mesh file: {}", flaw.message), "");
    fault.excerpt = flaw.line.map(|line| Excerpt {
        path: path.display().to_string(),
        line,
        text: line_of(bytes, line),
        label: String::new(),
    });
    fault
}

/// Line number `line` (from 1), cut where it is longer than anyone reads.
fn line_of(bytes: &[u8], line: usize) -> String {
    let found = Lines::new(without_mark(bytes), 1).nth(line - 1);
    found.map_or(String::new(), |(_, text)| shown(text).trim_end().to_owned())
}

/// Drops triangles whose cross product of edges is zero or not finite: they cannot be hit. Says how many.
fn drop_degenerate(name: &str, soup: &mut Soup) -> Option<Note> {
    let Soup { vertices, faces, .. } = soup;
    let all = faces.len();
    faces.retain(|face| {
        let [a, b, c] = face.map(|index| vertices[index as usize]);
        let cross = (b - a).cross(c - a);
        cross.is_finite() && cross != glam::DVec3::ZERO
    });
    let dropped = all - faces.len();
    (dropped > 0).then(|| Note::new(format!("{name}: {dropped} of {all} triangles have no area and are dropped")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn triangles_without_area_are_counted() {
        let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::X * 2.0, DVec3::Y, DVec3::X * 1e200, DVec3::Y * 1e200];
        let faces = vec![[0, 1, 3], [0, 1, 2], [1, 1, 3], [0, 4, 5]];
        let mut soup = Soup { vertices, faces, ..Soup::default() };
        let note = drop_degenerate("`a.ply`", &mut soup).unwrap();
        assert_eq!(note.text, "`a.ply`: 3 of 4 triangles have no area and are dropped");
        assert_eq!(soup.faces, [[0, 1, 3]]);
        assert_eq!(drop_degenerate("`a.ply`", &mut soup), None);
    }

    #[test]
    fn lines_are_cut_and_need_not_exist() {
        assert_eq!(line_of(b"a\r\nb\xff\n", 2), "b\u{fffd}");
        assert_eq!(line_of(b"a", 7), "");
        assert_eq!(line_of(&[b'x'; 1000], 1).len(), 100);
    }
}
