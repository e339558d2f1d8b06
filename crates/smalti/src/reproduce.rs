//! The command line that makes the same image again, bit for bit, by anyone.

use std::path::Path;

use smalti_core::settings::{Rect, Settings};

use crate::downsample;

/// A command that renders what `settings` say with `spp` samples a pixel, down-sampled `by` so much, independent of the
/// scene's own settings. `camera` is the name of the camera, empty for the only one.
pub fn command(scene: &Path, (settings, by): (&Settings, u32), spp: u32, camera: &str) -> String {
    // Photons that are not asked for are by the size of what is rendered.
    let photons = Some(settings.photons_of_round());
    let image = Settings { photons, ..downsample::image(settings, by) };
    let downsample = if by > 1 { format!(" --downsample {by}") } else { String::new() };
    format!("smalti render {}{}{downsample}", scene_argument(scene), flags(&image, spp, camera))
}

/// A command that replays one sample of the same image.
pub fn replay_command(scene: &Path, settings: &Settings, camera: &str, pixel: (u32, u32), sample: u32) -> String {
    let flags = flags(settings, settings.spp, camera);
    format!("smalti pixel {} {} {} --sample {sample}{flags}", scene_argument(scene), pixel.0, pixel.1)
}

/// A command that shows the same photon map again; `map` and `colour` are the names that users write.
pub fn photons_command(scene: &Path, settings: &Settings, (map, colour): (&str, &str), camera: &str) -> String {
    let Settings { width, height, spp, seed, fresnel, .. } = settings;
    let (photons, fresnel) = (settings.photons_of_round(), fresnel.name());
    let mut command = format!(
        "smalti photons {} --photons {photons} --map {map} --colour {colour} --size {width}x{height} --spp {spp} \
         --seed {seed} --fresnel {fresnel}",
        scene_argument(scene)
    );
    command += &settings.radius.map(|radius| format!(" --radius {radius}")).unwrap_or_default();
    command + &part(settings, camera)
}

/// Crop and camera as flags.
fn part(settings: &Settings, camera: &str) -> String {
    let crop = settings.crop.map(|Rect { x, y, width, height }| format!(" --crop {x},{y},{width},{height}"));
    let camera = (!camera.is_empty()).then(|| format!(" --camera={}", quoted(camera)));
    crop.unwrap_or_default() + &camera.unwrap_or_default()
}

/// Every setting as a flag; those that a scene cannot have set either are left out.
fn flags(settings: &Settings, spp: u32, camera: &str) -> String {
    let Settings { integrator, width, height, shadow_rays, sampler, seed, fresnel, .. } = settings;
    let (integrator, sampler, fresnel) = (integrator.name(), sampler.name(), fresnel.name());
    let mut flags = format!(
        " --integrator {integrator} --size {width}x{height} --spp {spp} --shadow-rays {shadow_rays} \
         --sampler {sampler} --seed {seed} --fresnel {fresnel}"
    );
    if let Some(bounces) = settings.max_bounces {
        flags += &format!(" --max-bounces {bounces}");
    }
    flags += &part(settings, camera);
    if settings.integrator.asks_photons() {
        flags += &format!(" --photons {}", settings.photons_of_round());
        flags += &settings.radius.map(|radius| format!(" --radius {radius}")).unwrap_or_default();
    }
    if !settings.jitter {
        flags += " --no-jitter";
    }
    if settings.adaptive {
        flags += " --adaptive on";
    }
    flags
}

/// The scene's path; one that looks like a flag is made to look like a path.
fn scene_argument(scene: &Path) -> String {
    let path = scene.to_string_lossy();
    if path.starts_with('-') { quoted(&format!("./{path}")) } else { quoted(&path) }
}

/// As a shell reads it back.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/._-+=:,@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', r"'\''")) }
}

#[cfg(test)]
mod tests {
    use clap::Parser;
    use smalti_core::settings::{Fresnel, Integrator, SamplerKind};

    use super::*;
    use crate::args::{Cli, Command, ImageArgs};
    use crate::parse::Size;

    fn unusual() -> Settings {
        Settings {
            integrator: Integrator::Whitted,
            width: 640,
            height: 48,
            crop: Some(Rect { x: 5, y: 6, width: 7, height: 8 }),
            spp: 3,
            shadow_rays: 0,
            max_bounces: Some(4),
            sampler: SamplerKind::Independent,
            seed: u64::MAX,
            fresnel: Fresnel::Schlick,
            jitter: false,
            adaptive: true,
            camera: 1,
            photons: Some(77),
            radius: Some(0.125),
        }
    }

    /// What the image flags of a typed line say.
    fn read_back(line: &str) -> (String, ImageArgs) {
        match Cli::try_parse_from(line.split(' ')).unwrap().command {
            Command::Render(args) => (args.scene.display().to_string(), args.image),
            Command::Pixel(args) => (args.scene.display().to_string(), args.image),
            other => panic!("{other:?}"),
        }
    }

    fn assert_says_all(flags: &ImageArgs) {
        let wanted = unusual();
        assert_eq!(flags.integrator.map(Into::into), Some(wanted.integrator));
        assert_eq!(flags.size, Some(Size { width: wanted.width, height: wanted.height }));
        assert_eq!(flags.crop, wanted.crop);
        assert_eq!(flags.shadow_rays, Some(wanted.shadow_rays));
        assert_eq!(flags.max_bounces, wanted.max_bounces);
        assert_eq!(flags.sampler.map(Into::into), Some(wanted.sampler));
        assert_eq!(flags.seed, Some(wanted.seed));
        assert_eq!(flags.fresnel.map(Into::into), Some(wanted.fresnel));
        assert_eq!(flags.camera.as_deref(), Some("-left"));
        assert!(flags.no_jitter && flags.adaptive == Some(crate::names::SwitchArg::On));
    }

    #[test]
    fn every_setting_is_read_back() {
        let (scene, flags) = read_back(&command(Path::new("a/b.toml"), (&unusual(), 1), 12, "-left"));
        assert_eq!((scene.as_str(), flags.spp), ("a/b.toml", Some(12)));
        assert_says_all(&flags);
    }

    #[test]
    fn a_replay_has_the_same_flags() {
        let line = replay_command(Path::new("a/b.toml"), &unusual(), "-left", (3, 4), 7);
        assert!(line.starts_with("smalti pixel a/b.toml 3 4 --sample 7 --integrator whitted"), "{line}");
        assert_says_all(&read_back(&line).1);
    }

    #[test]
    fn defaults_need_no_optional_flags() {
        let line = command(Path::new("-x.toml"), (&Settings::default(), 1), 64, "");
        let expected = "smalti render ./-x.toml --integrator path --size 400x400 --spp 64 --shadow-rays 1 \
                        --sampler sobol --seed 0 --fresnel exact";
        assert_eq!(line, expected);
    }

    #[test]
    fn sizes_are_those_of_the_image() {
        let (width, height) = (3 * unusual().width, 3 * unusual().height);
        let crop = Some(Rect { x: 15, y: 18, width: 21, height: 24 });
        let rendered = Settings { integrator: Integrator::Auto, photons: None, width, height, crop, ..unusual() };
        let line = command(Path::new("a/b.toml"), (&rendered, 3), 12, "");
        assert!(line.contains("--size 640x48 ") && line.contains("--crop 5,6,7,8 "), "{line}");
        assert!(line.contains(&format!("--photons {} ", rendered.photons_of_round())), "{line}");
        assert!(line.ends_with("--downsample 3"), "{line}");
    }

    #[test]
    fn quotes() {
        assert_eq!(quoted("plain/path-1.toml"), "plain/path-1.toml");
        assert_eq!(quoted("my room.toml"), "'my room.toml'");
        assert_eq!(quoted("it's"), r"'it'\''s'");
        assert_eq!(quoted(""), "''");
        assert_eq!(quoted("$HOME"), "'$HOME'");
    }
}
