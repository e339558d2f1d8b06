//! What of a mesh file does not reach the picture: counted while it is read, and said once.

use std::collections::BTreeMap;
use std::fmt;

use crate::note::Note;

/// Something that a file holds and that is not used, in the order in which it is told.
#[derive(Clone, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum Content {
    /// Normals of vertices: smalti's surfaces are as flat as their triangles.
    Normals,
    /// Texture coordinates.
    TextureCoordinates,
    /// Colours of vertices or faces.
    Colours,
    /// Materials, by name.
    Materials,
    /// Groups and objects.
    Groups,
    /// Lines.
    Lines,
    /// Points that are drawn as such.
    Points,
    /// Curves and surfaces of free form.
    Curves,
    /// Statements of other kinds.
    Statements,
    /// A property of PLY elements, by name.
    Property(String),
    /// An element of PLY, by name.
    Element(String),
    /// Numbers of a row that the header does not name.
    Numbers,
    /// Bytes behind all that the header names.
    Bytes,
}

/// How much of a file is not used, and what had to be done with its faces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    unused: BTreeMap<Content, usize>,
    /// Faces that have fewer than three corners, and are dropped.
    pub short: usize,
    /// Faces that cross themselves.
    pub crossing: usize,
}

impl Tally {
    /// Counts `count` more of what is not used.
    pub fn add(&mut self, content: Content, count: usize) {
        if count > 0 {
            *self.unused.entry(content).or_default() += count;
        }
    }

    /// What is not used, as `4 normals and 1 group`; empty if everything is used.
    pub fn unused(&self) -> String {
        let parts: Vec<String> = self.unused.iter().map(|(content, count)| content.counted(*count)).collect();
        match &parts[..] {
            [] => String::new(),
            [part] => part.clone(),
            [first @ .., last] => format!("{} and {last}", first.join(", ")),
        }
    }

    /// The notes of the mesh that is called `name`.
    pub fn notes(&self, name: &str) -> Vec<Note> {
        let faces = |count: usize, one: &str, many: &str| match count {
            0 => None,
            1 => Some(format!("{name}: 1 face {one}")),
            count => Some(format!("{name}: {count} faces {many}")),
        };
        let short = "fewer than three different corners and";
        let short = faces(self.short, &format!("has {short} is dropped"), &format!("have {short} are dropped"));
        let crossing = faces(
            self.crossing,
            "crosses itself: its triangles may overlap",
            "cross themselves: their triangles may overlap",
        );
        let unused = Some(self.unused()).filter(|unused| !unused.is_empty());
        let unused = unused.map(|unused| format!("{name} also holds {unused}: not used"));
        let notes = short.into_iter().chain(unused).map(Note::new);
        notes.chain(crossing.map(Note::warning)).collect()
    }
}

impl Content {
    /// `1 normal`, `2 normals`; names from the file stand in backticks.
    fn counted(&self, count: usize) -> String {
        let plural = if count == 1 { "" } else { "s" };
        match self {
            Self::Property(_) | Self::Element(_) => format!("{count} `{self}`"),
            _ => format!("{count} {self}{plural}"),
        }
    }
}

/// In the singular.
impl fmt::Display for Content {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Normals => "normal",
            Self::TextureCoordinates => "texture coordinate",
            Self::Colours => "colour",
            Self::Materials => "material",
            Self::Groups => "group",
            Self::Lines => "line",
            Self::Points => "point",
            Self::Curves => "free-form statement",
            Self::Statements => "other statement",
            Self::Property(name) | Self::Element(name) => name,
            Self::Numbers => "surplus number",
            Self::Bytes => "surplus byte",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_used_is_said_in_one_note() {
        let mut tally = Tally::default();
        assert_eq!(tally.notes("`a.obj`"), []);
        for (content, count) in
            [(Content::Groups, 1), (Content::Normals, 2), (Content::Normals, 2), (Content::Lines, 0)]
        {
            tally.add(content, count);
        }
        assert_eq!(tally.notes("`a.obj`"), [Note::new("`a.obj` also holds 4 normals and 1 group: not used")]);
        tally.add(Content::Element("edge".to_owned()), 3);
        assert_eq!(tally.unused(), "4 normals, 1 group and 3 `edge`");
    }

    #[test]
    fn faces_are_counted() {
        let tally = Tally { short: 1, crossing: 2, ..Tally::default() };
        let short = Note::new("mesh 1: 1 face has fewer than three different corners and is dropped");
        let crossing = Note::warning("mesh 1: 2 faces cross themselves: their triangles may overlap");
        assert_eq!(tally.notes("mesh 1"), [short, crossing]);
    }
}
