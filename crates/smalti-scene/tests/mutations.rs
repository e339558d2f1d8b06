//! Scene files with random damage: whatever stands in them, the answer is a world or a message, never a panic.

use std::fs;
use std::path::Path;

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;

const TOKENS: &[&str] = &[
    "nan",
    "-inf",
    "1e999",
    "0",
    "-1",
    "1.0",
    "[",
    "]",
    "[[",
    "{}",
    "\"",
    "'''",
    "=",
    ".",
    ",",
    "\n",
    "\r\n",
    "\t",
    "#",
    "é",
    "\u{1b}[31m",
    "\u{200b}",
    "camera",
    "light",
    "material",
    "99999999999999999999",
    "true",
    "1979-05-27",
];

/// `text` with one part removed, replaced by a token or by another part of itself.
fn damage(text: &str, random: &mut Xoshiro128PlusPlus) -> String {
    let mut place = |end: usize| random.next_u32() as usize % (end + 1);
    let boundary = |at: usize| (0..=at).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0);
    let start = boundary(place(text.len()));
    let end = boundary((start + place(12)).min(text.len())).max(start);
    let from = boundary(place(text.len()));
    let part = &text[from..boundary((from + place(60)).min(text.len())).max(from)];
    let middle = match place(2) {
        0 => "",
        1 => TOKENS[place(TOKENS.len() - 1)],
        _ => part,
    };
    format!("{}{middle}{}", &text[..start], &text[end..])
}

#[test]
fn damaged_scenes_never_panic() {
    let folder = tempfile::tempdir().unwrap();
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let damaged = folder.path().join("damaged.toml");
    let (mut loaded, mut refused) = (0, 0);
    for (seed, name) in ["hexroom", "hexroom-caustic", "blob", "cornell", "furnace"].into_iter().enumerate() {
        let text = fs::read_to_string(scenes.join(name).with_extension("toml")).unwrap();
        let mut random = Xoshiro128PlusPlus::seed_from_u64(seed as u64);
        for _ in 0..200 {
            fs::write(&damaged, damage(&text, &mut random)).unwrap();
            match smalti_scene::load(&damaged) {
                Ok(_) => loaded += 1,
                Err(error) => refused += usize::from(error.render(true).contains("error")),
            }
        }
    }
    assert_eq!(loaded + refused, 1000);
    assert!(loaded > 50 && refused > 250, "{loaded} loaded and {refused} refused: the damage is not what it was");
}
