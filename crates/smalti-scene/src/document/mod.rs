//! The scene file as TOML, with the place of every value: [`Section`] is a table of known keys, [`Node`] one value.

mod bounds;
mod node;
mod section;

use toml::Spanned;
use toml::de::DeTable;

pub use bounds::{Bounds, FARTHEST};
pub use node::Node;
pub use section::{Key, Section, key};

use crate::error::{Fault, Result};

/// The document, or the first place where it is not TOML.
pub fn parse(text: &str) -> Result<Spanned<DeTable<'_>>> {
    DeTable::parse(text).map_err(|error| {
        let span = error.span().unwrap_or(0..0);
        if error.message() == "duplicate key" {
            let name = &text[span.clone()];
            return Fault::at(span, format!("`{name}` is defined twice"), "the second time").help(
                "a name stands once in its table; lists are written `[[sphere]]`, named tables `[material.NAME]`",
            );
        }
        match error.message().split_once(", expected ") {
            Some((what, expected)) => {
                Fault::at(span, format!("this is not TOML: {what}"), format!("expected {expected}"))
            }
            None => Fault::at(span, format!("this is not TOML: {}", error.message()), ""),
        }
    })
}

/// The known word that `word` was perhaps meant to be: a third of its letters may be wrong, capitals do not count.
pub fn nearest<'k>(word: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    let word = word.to_lowercase();
    let distance = |known: &str| strsim::osa_distance(&word, &known.to_lowercase());
    let allowed = (word.chars().count() / 3).max(1);
    let scored = known.into_iter().map(|known| (distance(known), known));
    scored.filter(|(distance, _)| *distance <= allowed).min_by_key(|(distance, _)| *distance).map(|(_, known)| known)
}

/// Words of other programs, and ours for the same thing.
const FOREIGN: &[(&str, &str)] = &[
    ("samples", "spp"),
    ("resolution", "size"),
    ("position", "eye"),
    ("origin", "eye"),
    ("target", "look_at"),
    ("position", "centre"),
    ("color", "albedo"),
    ("colour", "albedo"),
    ("reflectance", "albedo"),
    ("albedo", "reflectance"),
    ("diffuse", "lambert"),
    ("glass", "dielectric"),
    ("index", "ior"),
    ("radiance", "intensity"),
    ("intensity", "radiance"),
    ("emission", "radiance"),
    ("points", "vertices"),
    ("indices", "faces"),
    ("triangles", "faces"),
];

/// Advice for an unknown word: the known one of the same meaning or the nearest one, else all of them.
pub fn advice<'k>(word: &str, known: impl IntoIterator<Item = &'k str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    let foreign = FOREIGN.iter().find(|(theirs, ours)| *theirs == word && known.contains(ours));
    match foreign.map(|(_, ours)| *ours).or_else(|| nearest(word, known.iter().copied())) {
        Some(name) => format!("did you mean `{name}`?"),
        None => format!("known are {}", list(&known)),
    }
}

/// `a`, `b` and `c`.
fn list(words: &[&str]) -> String {
    match words {
        [] => "none".to_owned(),
        [word] => format!("`{word}`"),
        [first @ .., last] => {
            let first: Vec<String> = first.iter().map(|word| format!("`{word}`")).collect();
            format!("{} and `{last}`", first.join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_word_is_found_and_a_far_one_is_not() {
        let known = ["centre", "radius", "material"];
        assert_eq!(nearest("center", known), Some("centre"));
        assert_eq!(nearest("Radius", known), Some("radius"));
        assert_eq!(nearest("smooth", known), None);
        assert_eq!(advice("smooth", known), "known are `centre`, `radius` and `material`");
    }

    #[test]
    fn words_of_other_programs_are_understood_where_they_fit() {
        assert_eq!(advice("position", ["eye", "fov"]), "did you mean `eye`?");
        assert_eq!(advice("position", ["centre", "radius"]), "did you mean `centre`?");
        assert_eq!(advice("samples", ["sampler", "spp"]), "did you mean `spp`?");
    }

    #[test]
    fn what_is_not_toml_is_located() {
        let fault = parse("[camera\nfov = 1\n").unwrap_err();
        assert_eq!(fault.title, "this is not TOML: unclosed table");
        assert_eq!(fault.span, Some(7..7));
        assert_eq!(parse("a = 1\na = 2\n").unwrap_err().title, "`a` is defined twice");
    }
}
