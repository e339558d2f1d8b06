//! What a render needs of memory, and the refusal where there is less.

use std::path::Path;

use smalti_core::film::{Pixel, Shift, Shifted};
use smalti_core::photon::{Kind, Photons};
use smalti_core::scene::World;
use smalti_core::settings::{Integrator, Settings};

use super::{Limit, in_words};
use crate::exit::Failure;
use crate::frontend::numbers;

/// What a render needs beside the scene as it was read.
#[derive(Clone, Copy, Debug)]
pub struct Need<'a> {
    /// What is rendered.
    pub settings: &'a Settings,
    /// Pixels that become one of the image, in each direction.
    pub downsample: u32,
    /// Bytes of photon maps.
    pub photons: u64,
    /// Whether the film notes what photon radii add.
    pub shifts: bool,
    /// Triangles, polygons and spheres that are compiled and put into trees.
    pub shapes: u64,
}

/// Bytes that a triangle takes at most while scene and tree are built, beside the mesh as it was read. Measured: 295 of a
/// grid of a million, 343 of three of them.
const SHAPE_BYTES: u64 = 400;

/// Bytes that film and image take at most. `None`: more than can be counted.
fn film_bytes(settings: &Settings, downsample: u32, shifts: bool) -> Option<u64> {
    let (shift, shifted) = if shifts { (size_of::<Shift>(), size_of::<Shifted>()) } else { (0, 0) };
    let film = (size_of::<Pixel>() + shift) as u64;
    let image = (size_of::<[f32; 3]>() + shifted) as u64;
    // The film becomes a smaller one, and that the image.
    let image = if downsample > 1 { film + image } else { image };
    let area = settings.area();
    let [pixels, smaller] = [1, downsample.max(1)].map(|by| [area.width / by, area.height / by].map(u64::from));
    let film = pixels[0].checked_mul(pixels[1])?.checked_mul(film)?;
    film.checked_add(smaller[0].checked_mul(smaller[1])?.checked_mul(image)?)
}

/// Bytes that everything else takes: buffers of the workers, what is kept of each tile, the files while they are encoded.
/// Measured: 1 to 13 MB with 1 to 8 threads.
const ELSE_BYTES: u64 = 32_000_000;

/// Bytes that the photon maps of a render may take at most while they are built.
pub fn photon_bytes(settings: &Settings) -> u64 {
    let maps: &[Kind] = match settings.integrator {
        // Its caustic photons go on, and are stored as often as those of all light.
        Integrator::Auto => &[Kind::Global],
        Integrator::Photon => &[Kind::Caustic, Kind::Global],
        Integrator::Path | Integrator::Whitted => &[],
    };
    maps.iter().map(|map| map_bytes(*map, settings.photons_of_round())).sum()
}

/// Bytes that a map of `photons` emitted ones may take at most while it is built.
pub fn map_bytes(map: Kind, photons: u32) -> u64 {
    let stored = match map {
        Kind::Caustic | Kind::Shadow => 1,
        // A photon is stored at every diffuse bounce.
        Kind::Global => 7,
    };
    u64::from(photons) * stored * 2 * Photons::BYTES
}

/// Triangles, polygons and spheres of a world.
pub fn shapes(world: &World) -> u64 {
    triangles(world) + (world.polygons.len() + world.spheres.len()) as u64
}

/// Triangles of a world's meshes.
pub fn triangles(world: &World) -> u64 {
    world.meshes.iter().map(|mesh| mesh.faces.len() as u64).sum()
}

impl Need<'_> {
    /// A render that does not fit below `limit` is refused before anything of it is allocated.
    ///
    /// # Errors
    /// What takes too much, what there is, and what to do.
    pub fn check(&self, limit: &Limit) -> Result<(), Failure> {
        let scene = self.shapes.saturating_mul(SHAPE_BYTES);
        let film = film_bytes(self.settings, self.downsample, self.shifts);
        let needed = film.and_then(|film| film.checked_add(self.photons)?.checked_add(scene)?.checked_add(ELSE_BYTES));
        if needed.is_some_and(|needed| needed <= limit.left()) {
            return Ok(());
        }
        let film = film.unwrap_or(u64::MAX);
        let (what, advice) = match film >= self.photons.max(scene) {
            true => self.of_film(film),
            false if self.photons >= scene => self.of_photons(),
            false => self.of_scene(scene),
        };
        Err(Failure::user(format!("{what}; {limit}{}. {advice}", limit.taken_in_words())))
    }

    fn of_film(&self, bytes: u64) -> (String, &'static str) {
        let area = self.settings.area();
        let bytes =
            if bytes < u64::MAX { in_words(bytes) + " of memory" } else { "more memory than can be counted".into() };
        let what = format!("{}x{} pixels need {bytes}", area.width, area.height);
        (what, "Make it smaller with --size, or in parts with --crop")
    }

    fn of_photons(&self) -> (String, &'static str) {
        let (count, bytes) = (self.settings.photons_of_round(), in_words(self.photons));
        (format!("{count} photons need up to {bytes} of memory"), "Take fewer with --photons")
    }

    fn of_scene(&self, bytes: u64) -> (String, &'static str) {
        let (count, bytes) = (numbers::count(self.shapes), in_words(bytes));
        let what = format!("a tree of {count} shapes needs up to {bytes} of memory while it is built");
        (what, "Take meshes with fewer triangles")
    }
}

/// Refuses a mesh file of so many bytes if what is read of it would not fit below `limit`; the reason is a sentence
/// without a full stop.
pub fn check_mesh(path: &Path, bytes: u64, limit: &Limit) -> Result<(), String> {
    let needed = (bytes as f64 * mesh_factor(path)) as u64;
    match needed <= limit.left() {
        true => Ok(()),
        false => {
            let (file, needed, taken) = (in_words(bytes), in_words(needed), limit.taken_in_words());
            Err(format!("the mesh file of {file} takes about {needed} of memory to be read; {limit}{taken}"))
        }
    }
}

/// Bytes of memory for a byte of a mesh file while it is read. Measured: 1.4 for OBJ and 4.7 for binary PLY; PLY as text
/// takes less.
fn mesh_factor(path: &Path) -> f64 {
    let is_obj = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj"));
    if is_obj { 1.4 } else { 3.0 }
}

#[cfg(test)]
mod tests {
    use super::super::By;
    use super::*;

    fn limit(bytes: u64, taken: u64) -> Limit {
        Limit { bytes, taken, by: By::Process('v') }
    }

    fn said(need: Need, limit: &Limit) -> String {
        need.check(limit).err().map(|failure| failure.message).unwrap_or_default()
    }

    #[test]
    fn absurd_sizes_are_refused_with_a_number() {
        let sized = |width, height| Settings { integrator: Integrator::Path, width, height, ..Settings::default() };
        let of = |settings: &Settings, limit: &Limit| {
            said(Need { settings, downsample: 1, photons: 0, shifts: false, shapes: 0 }, limit)
        };
        assert_eq!(of(&sized(100, 100), &limit(1_080_000 + ELSE_BYTES, 0)), "");
        let message = of(&sized(100, 100), &limit(1_080_000 + ELSE_BYTES, 1));
        assert!(message.contains("100x100 pixels need 1.1 MB") && message.contains("(ulimit -v)"), "{message}");
        let message = of(&sized(100_000, 100_000), &limit(16_000_000_000, 0));
        assert!(message.contains("1.1 TB") && message.contains("16 GB") && message.contains("--size"), "{message}");
        let message = of(&sized(u32::MAX, u32::MAX), &limit(isize::MAX as u64, 0));
        assert!(message.contains("more memory than can be counted"), "{message}");
    }

    #[test]
    fn a_pixel_takes_108_bytes_and_96_more_where_there_are_photons() {
        let of = |width, height, by, shifts| film_bytes(&Settings { width, height, ..Settings::default() }, by, shifts);
        assert_eq!((of(10, 10, 1, false), of(10, 10, 1, true)), (Some(10_800), Some(20_400)));
        assert_eq!(of(10, 10, 2, false), Some(100 * 96 + 25 * 108));
        assert_eq!(of(u32::MAX, u32::MAX, 1, false), None);
    }

    #[test]
    fn the_largest_part_is_named() {
        let settings =
            Settings { integrator: Integrator::Path, width: 100, height: 100, photons: Some(7), ..Settings::default() };
        let need = |photons, shapes| {
            said(
                Need { settings: &settings, downsample: 1, photons, shifts: false, shapes },
                &limit(2_000_000 + ELSE_BYTES, 500_000),
            )
        };
        assert_eq!(need(200_000, 500), "");
        assert!(need(2_000_000, 0).contains("7 photons need up to 2.0 MB") && need(2_000_000, 0).contains("--photons"));
        assert!(need(0, 1_000_000).contains("a tree of 1.00 M shapes needs up to 400 MB"), "{}", need(0, 1_000_000));
        // None of them alone.
        let message = need(300_000, 1000);
        assert!(message.contains("100x100 pixels"), "{message}");
    }

    #[test]
    fn a_mesh_file_that_cannot_fit_is_refused() {
        let check = |name: &str, bytes| check_mesh(Path::new(name), bytes, &limit(400_000_000, 100_000_000));
        assert_eq!((check("a.obj", 210_000_000), check("a.ply", 100_000_000)), (Ok(()), Ok(())));
        for (name, bytes) in [("a.OBJ", 220_000_000), ("a.ply", 101_000_000), ("a.obj", u64::MAX)] {
            let why = check(name, bytes).unwrap_err();
            assert!(why.contains("of memory to be read; this process may use 400 MB (ulimit -v)"), "{why}");
        }
    }
}
