//! What a scene holds that is hardly meant, in the words of its file.

use smalti_core::scene::contact::Pair;
use smalti_core::scene::soundness::{Names, examine};
use smalti_core::scene::{Frame, Origin, World};

use crate::note::Note;
use crate::place::Places;

/// The names that the scene file gives.
struct InFile<'a> {
    world: &'a World,
    text: &'a str,
    places: &'a Places,
    materials: &'a [&'a str],
}

impl Names for InFile<'_> {
    fn surface(&self, surface: Origin) -> String {
        self.places.name(self.text, self.world, surface)
    }

    fn material(&self, material: usize) -> String {
        self.materials.get(material).map_or("a light".to_owned(), |name| format!("`{name}`"))
    }
}

/// The notes on a world, which the file `text` describes; `materials` are the names of its first ones.
pub fn notes(
    (world, frame, pairs): (&World, &Frame, &[Pair]),
    (text, places, materials): (&str, &Places, &[&str]),
) -> Vec<Note> {
    let names = InFile { world, text, places, materials };
    examine(world, frame, pairs).iter().map(|finding| Note::warning(finding.says(&names))).collect()
}
