//! What can be turned: one table for the command line, the arms, their names and what is tried of each knob.

use smalti_core::scene::World;
use smalti_core::scene::world::Material;
use smalti_core::settings::MOST_SHADOW_RAYS;

use super::values::{choice, half_and_twice, names, on_or_off, or_none, photons, threads, whole};
use super::way::Way;
use crate::args::MOST_DOWNSAMPLE;
use crate::names::{FresnelArg, IntegratorArg, SamplerArg};
use crate::parse;

/// A setting that a study may try several values of.
#[derive(Debug)]
pub struct Knob {
    /// The flag's name.
    pub name: &'static str,
    /// What it is, for `--help`.
    pub help: &'static str,
    /// The value in words; `#` stands for it. A plural of 1 loses its s.
    pub words: &'static str,
    /// The value in the name of a file.
    pub short: &'static str,
    /// Reads a value and sets it.
    pub set: fn(&mut Way, &str) -> Result<(), String>,
    /// The value, resolved, as `set` reads it.
    pub get: fn(&Way) -> String,
    /// Whether it makes a difference.
    pub applies: fn(&Way, &World) -> bool,
    /// Values around that of a way, worth trying one at a time.
    pub around: fn(&Way) -> Vec<String>,
}

/// Every knob, in the order of names and tables.
pub const KNOBS: &[Knob] = &[
    Knob {
        name: "integrator",
        help: "Light transport algorithms: auto, path, photon, whitted",
        words: "#",
        short: "#",
        set: |way, text| choice::<IntegratorArg>(text).map(|typed| way.image.integrator = typed.into()),
        get: |way| way.image.integrator.name().into(),
        applies: always,
        around: |_| names::<IntegratorArg>(),
    },
    Knob {
        name: "size",
        help: "Sizes of the image, WxH",
        words: "#",
        short: "#",
        set: |way, text| {
            parse::parse_size(text).map(|size| (way.image.width, way.image.height) = (size.width, size.height))
        },
        get: |way| format!("{}x{}", way.image.width, way.image.height),
        applies: always,
        around: |_| Vec::new(),
    },
    Knob {
        name: "downsample",
        help: "Render NxN pixels for each one of the image and average them",
        words: "down-sampled #x#",
        short: "down#",
        set: |way, text| whole(text, 1, MOST_DOWNSAMPLE as u32).map(|by| way.downsample = by),
        get: |way| way.downsample.to_string(),
        applies: always,
        around: |_| Vec::new(),
    },
    Knob {
        name: "spp",
        help: "Samples for each pixel that is rendered",
        words: "# spp",
        short: "#spp",
        set: |way, text| whole(text, 1, u32::MAX).map(|spp| way.image.spp = spp),
        get: |way| way.image.spp.to_string(),
        applies: always,
        around: |way| half_and_twice(way.image.spp),
    },
    Knob {
        name: "shadow-rays",
        help: "Light samples at each diffuse vertex",
        words: "# shadow rays",
        short: "#rays",
        set: |way, text| whole(text, 0, MOST_SHADOW_RAYS).map(|rays| way.image.shadow_rays = rays),
        get: |way| way.image.shadow_rays.to_string(),
        applies: always,
        around: |way| half_and_twice(way.image.shadow_rays),
    },
    Knob {
        name: "sampler",
        help: "Where the random numbers come from: sobol, independent",
        words: "#",
        short: "#",
        set: |way, text| choice::<SamplerArg>(text).map(|typed| way.image.sampler = typed.into()),
        get: |way| way.image.sampler.name().into(),
        applies: always,
        around: |_| names::<SamplerArg>(),
    },
    Knob {
        name: "jitter",
        help: "Whether samples lie anywhere in their pixel (on) or in its centre (off)",
        words: "jitter #",
        short: "jitter-#",
        set: |way, text| on_or_off(text).map(|on| way.image.jitter = on),
        get: |way| if way.image.jitter { "on" } else { "off" }.into(),
        applies: always,
        around: |_| ["on", "off"].map(String::from).to_vec(),
    },
    Knob {
        name: "adaptive",
        help: "Whether samples go where the noise is: on, off",
        words: "adaptive #",
        short: "adaptive-#",
        set: |way, text| on_or_off(text).map(|on| way.image.adaptive = on),
        get: |way| if way.image.adaptive { "on" } else { "off" }.into(),
        applies: always,
        around: |_| ["on", "off"].map(String::from).to_vec(),
    },
    Knob {
        name: "max-bounces",
        help: "Scattering events after which a path ends; none: roulette alone ends it",
        words: "max bounces #",
        short: "bounces-#",
        set: |way, text| or_none(text, |text| whole(text, 0, u32::MAX)).map(|most| way.image.max_bounces = most),
        get: |way| in_words(way.image.max_bounces),
        applies: always,
        around: |_| ["none", "4", "16"].map(String::from).to_vec(),
    },
    Knob {
        name: "fresnel",
        help: "Reflectance of dielectrics: exact, schlick",
        words: "fresnel #",
        short: "#",
        set: |way, text| choice::<FresnelArg>(text).map(|typed| way.image.fresnel = typed.into()),
        get: |way| way.image.fresnel.name().into(),
        applies: |_, world| world.materials.iter().any(|material| matches!(material, Material::Dielectric { .. })),
        around: |_| names::<FresnelArg>(),
    },
    Knob {
        name: "photons",
        help: "Photons of each round of 16 samples and each map; auto: by the size of the image",
        words: "# photons",
        short: "#photons",
        set: |way, text| photons(text).map(|photons| way.image.photons = photons),
        get: |way| way.photons().to_string(),
        applies: |way, _| way.image.integrator.asks_photons(),
        around: |way| half_and_twice(way.photons()),
    },
    Knob {
        name: "radius",
        help: "How far photons count in the first round, metres; none: by their density",
        words: "radius #",
        short: "radius-#",
        set: |way, text| or_none(text, parse::parse_length).map(|radius| way.image.radius = radius),
        get: |way| in_words(way.image.radius),
        applies: |way, _| way.image.integrator.asks_photons() && way.photons() > 0,
        around: |way| {
            way.image.radius.map_or(Vec::new(), |r| vec!["none".into(), (r / 2.0).to_string(), (r * 2.0).to_string()])
        },
    },
    Knob {
        name: "threads",
        help: "Worker threads; max: one for each logical core",
        words: "# threads",
        short: "#threads",
        set: |way, text| threads(text).map(|threads| way.threads = threads),
        get: |way| way.threads.to_string(),
        applies: always,
        around: |way| if way.threads > 1 { vec!["1".into()] } else { vec!["max".into()] },
    },
];

impl Knob {
    /// The knob with that flag.
    ///
    /// # Panics
    /// If there is none: only names of the table are asked for.
    pub fn named(name: &str) -> &'static Self {
        KNOBS.iter().find(|knob| knob.name == name).expect("the table has every knob")
    }

    /// The value in words: `64 spp`, `1 shadow ray`.
    pub fn in_words(&self, value: &str) -> String {
        say(self.words, value)
    }

    /// The value as a part of a file's name: `64spp`.
    pub fn in_short(&self, value: &str) -> String {
        say(self.short, value)
    }
}

fn say(words: &str, value: &str) -> String {
    let words = if value == "1" { words.strip_suffix('s').unwrap_or(words) } else { words };
    words.replace('#', value)
}

fn always(_: &Way, _: &World) -> bool {
    true
}

fn in_words(value: Option<impl ToString>) -> String {
    value.map_or("none".into(), |value| value.to_string())
}

#[cfg(test)]
mod tests {
    use smalti_core::settings::{Integrator, Settings};

    use super::*;
    use crate::study::way::cores;

    fn way() -> Way {
        let image = Settings { integrator: Integrator::Auto, ..Settings::default() };
        Way { image, downsample: 1, threads: cores() }
    }

    #[test]
    fn every_knob_reads_what_it_says() {
        for knob in KNOBS {
            let mut turned = way();
            for value in (knob.around)(&way()).into_iter().chain([(knob.get)(&way())]) {
                (knob.set)(&mut turned, &value).unwrap();
                assert!(value == "max" || (knob.get)(&turned) == value, "{} {value}", knob.name);
            }
            assert_eq!((knob.get)(&turned), (knob.get)(&way()), "{}", knob.name);
            assert!((knob.set)(&mut turned, "x").is_err() && (knob.set)(&mut turned, "").is_err(), "{}", knob.name);
        }
    }

    #[test]
    fn values_have_words_and_short_names() {
        let told = |name, value| (Knob::named(name).in_words(value), Knob::named(name).in_short(value));
        assert_eq!(told("shadow-rays", "10"), ("10 shadow rays".into(), "10rays".into()));
        assert_eq!(told("shadow-rays", "1").0, "1 shadow ray");
        assert_eq!(told("downsample", "2"), ("down-sampled 2x2".into(), "down2".into()));
        assert_eq!(told("integrator", "photon").0, "photon");
    }

    #[test]
    fn mistakes_are_answered_with_what_was_meant() {
        let wrong = |name, text| (Knob::named(name).set)(&mut way(), text).unwrap_err();
        assert!(wrong("integrator", "pth").contains("did you mean 'path'?"));
        assert!(wrong("sampler", "zzz").ends_with("sobol, independent"));
        assert!(wrong("spp", "0").contains("from 1"));
        assert!(wrong("threads", "many").contains("'max'"));
        assert!(wrong("max-bounces", "-1").contains("'none'"));
        assert!(wrong("size", "400").contains("WIDTHxHEIGHT"));
    }

    #[test]
    fn photons_are_for_those_who_ask_them_and_fresnel_for_glass() {
        let mut path = way();
        path.image.integrator = Integrator::Path;
        let mut world = World::default();
        let applies = |name, way: &Way, world: &World| (Knob::named(name).applies)(way, world);
        assert!(!applies("photons", &path, &world) && !applies("radius", &path, &world));
        assert!(applies("photons", &way(), &world) && applies("radius", &way(), &world));
        assert!(!applies("fresnel", &path, &world));
        world.materials.push(Material::clear(1.5));
        assert!(applies("fresnel", &path, &world));
    }
}
