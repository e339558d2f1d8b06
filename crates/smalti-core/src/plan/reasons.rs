//! The plan in words: each decision with its reason, for `explain`.

use super::{Decision, MOST_BOUNCES, Plan, Stage, photons};
use crate::film::Pixel;
use crate::light::place::{Lamp, Lamps, MOST};
use crate::light::table::Kind;
use crate::photon::pass::Pass;
use crate::photon::{self, SUB_MAPS};
use crate::scene::{Class, Joints, Room, Scene};
use crate::settings::{Integrator, Settings};
use crate::stream::dielectric::FORK;

/// Everything that was decided.
pub fn of(plan: &Plan, scene: &Scene, settings: &Settings) -> Vec<Decision> {
    let mut decisions = vec![accelerator(plan, scene)];
    decisions.extend(occluders(plan, scene));
    decisions.extend(lights(scene));
    decisions.extend(glints(plan));
    decisions.extend(photon_maps(plan, scene, settings));
    decisions.extend(plan.stages.iter().map(|stage| stage_reason(stage, scene, settings)));
    decisions.extend(absent(plan, scene));
    decisions.push(columns(plan));
    decisions.push(ending(plan, settings));
    decisions.push(film(settings));
    decisions
}

fn decision(subject: &'static str, choice: impl Into<String>, reason: impl Into<String>, bytes: u64) -> Decision {
    Decision { subject, choice: choice.into(), reason: reason.into(), bytes }
}

/// "1 mirror", "2 mirrors".
fn counted(count: usize, name: &str) -> String {
    format!("{count} {name}{}", if count == 1 { "" } else { "s" })
}

fn accelerator(plan: &Plan, scene: &Scene) -> Decision {
    let tables = (scene.shades.len() * 44 + scene.faces.len() * 28 + scene.vertices.len() * 12) as u64
        + scene.room.as_ref().map_or(0, Room::bytes)
        + scene.joints.as_ref().map_or(0, Joints::bytes);
    let list = plan.everything.list.len();
    match &plan.everything.tree {
        None => {
            let reason = "few enough that testing all of them for many rays at a time is fastest";
            decision("accelerator", format!("list of {list} primitives"), reason, tables)
        }
        Some(tree) => {
            let choice = format!("tree of {} primitives, list of {list}", tree.len());
            let reason = "many: a tree for the meshes; what was declared one by one is large and stays in the list";
            decision("accelerator", choice, reason, tables + tree.bytes())
        }
    }
}

fn occluders(plan: &Plan, scene: &Scene) -> Option<Decision> {
    plan.has(|stage| matches!(stage, Stage::Direct { .. })).then(|| {
        let parts = counted(plan.parts.len(), "part");
        let choice = format!("{} of {} primitives, in {parts}", plan.occluders.len(), scene.shades.len());
        let reason = "the others have everything on one side, or all lights in their plane: they stop no shadow ray; \
                      a ray is traced where it may meet the bounding sphere of a part";
        decision("occluders", choice, reason, 0)
    })
}

fn lights(scene: &Scene) -> Option<Decision> {
    let rows = scene.lights.rows.len();
    match rows {
        0 => None,
        1 => Some(decision("lights", "1 light, no choice", "a choice table is needed only with several", 0)),
        _ => Some(choice_of_lights(scene, rows)),
    }
}

fn choice_of_lights(scene: &Scene, rows: usize) -> Decision {
    let table = rows as u64 * 76;
    match &scene.lights.by_place {
        Some(Lamps { lamps, .. }) => decision(
            "lights",
            format!("{rows} lights, chosen by what they can bring to the place"),
            "one light sample goes to one light: a small one near by may bring most",
            table + (lamps.len() * size_of::<Lamp>() + rows * size_of::<f32>()) as u64,
        ),
        None => decision(
            "lights",
            format!("{rows} lights, chosen by power"),
            format!("one light sample goes to one light; chances go by place with 2 to {MOST} lamps"),
            table,
        ),
    }
}

fn glints(plan: &Plan) -> Option<Decision> {
    (!plan.glints.is_empty()).then(|| {
        let choice = format!("{} looked for", counted(plan.glints.len(), "lamp"));
        let reason = "seen directly or in what is specular, their pictures may be far smaller than a pixel: half of the \
                      samples of such a pixel go there";
        decision("glints", choice, reason, 0)
    })
}

/// The photon maps, or why there are none.
fn photon_maps(plan: &Plan, scene: &Scene, settings: &Settings) -> Vec<Decision> {
    if !settings.integrator.asks_photons() {
        return Vec::new();
    }
    let Some(photons) = &plan.photons else {
        return vec![decision("left out", "photons", photons::missing(scene, settings), 0)];
    };
    let caustic = photons.caustic.as_ref().map(|pass| caustic_map(pass, photons, scene));
    let all = |pass| map(pass, "map of all light", "asked behind the first diffuse bounce".into());
    let global = photons.global.as_ref().map(all);
    let shadow = photons.shadow.as_ref().map(|pass| {
        let choice = format!("shadow photons: {}", pass.photons);
        let bytes = u64::from(pass.photons) * photon::Photons::BYTES;
        let reason = format!("where they decide, one shadow ray in {} is asked", photon::visibility::ONE_IN);
        decision("photons", choice, reason, bytes)
    });
    let radius = match settings.radius {
        Some(radius) => format!("radius {radius} m"),
        None => "radius by the density of photons sent ahead".into(),
    };
    let shrinks = "shrinks from round to round, so that noise and bias both vanish";
    let surfaces = "photons count on their own surface only, by the part of their disc that lies on it";
    let how = [
        decision("photons", radius, shrinks, 0),
        decision("photons", "surfaces and their borders", surfaces, photons.surfaces.bytes()),
    ];
    let lacking = "no photons come from the sky: paths look for it behind the first diffuse bounce too";
    let left_out = photons::lacks_sky(scene, settings).then(|| decision("left out", "map of all light", lacking, 0));
    caustic.into_iter().chain(global).chain(shadow).chain(how).chain(left_out).collect()
}

fn caustic_map(pass: &Pass, photons: &super::Photons, scene: &Scene) -> Decision {
    let (in_map, all) = (photons.in_map.iter().filter(|light| **light == 1).count(), photons.in_map.len());
    let points = scene.lights.kinds.iter().filter(|kind| **kind == Kind::Point as u32).count();
    let mut from = Vec::new();
    from.extend(
        (in_map > 0).then(|| format!("{in_map} of {}, found by chance too seldom", counted(all, "emitting primitive"))),
    );
    from.extend((points > 0).then(|| format!("{}, found by no chance", counted(points, "point light"))));
    let targets = counted(pass.aim.targets.len(), "group");
    let then = if pass.goes_on { ", and on from where they land" } else { "" };
    map(pass, "caustic map", format!("from {}; aimed at {targets} of specular surfaces{then}", from.join(" and ")))
}

fn map(pass: &Pass, name: &str, reason: String) -> Decision {
    let count = pass.of_sub_map() * SUB_MAPS;
    let choice = format!("{name}: {count} photons a round, in {SUB_MAPS} sub-maps");
    decision("photons", choice, reason, u64::from(count) * photon::Photons::BYTES)
}

fn stage_reason(stage: &Stage, scene: &Scene, settings: &Settings) -> Decision {
    let count = |class: Class| {
        let mask = (1 << Class::BITS) - 1;
        scene.classes.iter().filter(|code| *code & mask == class as u32).count()
    };
    let of = |class: Class, name: &str| counted(count(class), &format!("{name} primitive"));
    let rays = settings.shadow_rays;
    let (choice, reason) = match stage {
        Stage::Intersect => ("intersect", "every ray hits something or nothing".into()),
        Stage::Absorb => ("absorb", "light gets less on its way through what absorbs".into()),
        Stage::Sort => ("sort", "one stream for each stage that follows".into()),
        Stage::Emission => ("emission", counted(scene.lights.emitters.len(), "emitting primitive")),
        Stage::Environment => ("environment", "light arrives from infinity; scattered rays find it".into()),
        Stage::Surface => ("surface", of(Class::Lambert, "diffuse")),
        Stage::Direct { weighed: true } => (
            "direct light",
            format!("{} a vertex, weighed against the scattered ray", counted(rays as usize, "light sample")),
        ),
        Stage::Direct { weighed: false } => {
            ("direct light", format!("{} a vertex", counted(rays as usize, "light sample")))
        }
        Stage::Caustic => ("caustic map", "light by way of specular surfaces first, from photons".into()),
        Stage::Gather => ("final gather", "all light behind a diffuse bounce, from photons".into()),
        Stage::Show(_) => ("photon map", "asked where the first diffuse surface is seen; the path ends there".into()),
        Stage::Diffuse => ("diffuse bounce", "indirect light by cosine-distributed rays".into()),
        Stage::Mirror(_) => ("mirror", of(Class::Mirror, "mirror")),
        Stage::Dielectric(..) => ("dielectric", of(Class::Dielectric, "dielectric")),
        Stage::Fork(..) => {
            let share = 100.0 * FORK;
            let both = format!("{}, both ways where both carry {share} % or more", of(Class::Dielectric, "dielectric"));
            ("dielectric", both)
        }
        Stage::Split(_) => ("dielectric tree", of(Class::Dielectric, "dielectric")),
    };
    decision("stage", choice, reason, 0)
}

/// What a reader might look for and the scene does not use.
fn absent(plan: &Plan, scene: &Scene) -> Vec<Decision> {
    let mut absent = Vec::new();
    let mut note = |missing: bool, name: &str, reason: &str| {
        if missing {
            absent.push(decision("left out", name, reason, 0));
        }
    };
    note(!scene.has(Class::Mirror), "mirror", "no primitive is a mirror");
    note(!scene.has(Class::Dielectric), "dielectric", "no primitive is a dielectric");
    note(scene.environment.is_none(), "environment", "nothing arrives from infinity");
    note(scene.lights.rows.is_empty(), "direct light", "the scene has no light with a place");
    let hit = !scene.lights.emitters.is_empty();
    note(hit && plan.glints.is_empty(), "glints", "no lamp is looked for that is seen far smaller than a pixel");
    note(
        !plan.has(|stage| *stage == Stage::Diffuse) && scene.has(Class::Lambert),
        "diffuse bounce",
        "whitted has no indirect diffuse light: the picture is darker than the truth",
    );
    absent
}

fn columns(plan: &Plan) -> Decision {
    let mut names = vec!["ray, throughput, slot, hit"];
    let mut reasons = vec!["always"];
    if plan.columns.pdf {
        names.push("previous pdf");
        reasons.push("light is found in two ways");
    }
    if plan.columns.eta {
        names.push("factor of radiance");
        reasons.push(if plan.glints.is_empty() {
            "n² where something refracts"
        } else {
            "n² where something refracts, density of the place in pixels with glints"
        });
    }
    if plan.columns.medium {
        names.push("medium");
        reasons.push("something absorbs");
    }
    decision("columns", names.join(" + "), reasons.join("; "), 0)
}

fn ending(plan: &Plan, settings: &Settings) -> Decision {
    let choice = format!("at most {} bounces", plan.max_bounces);
    let reason = match (settings.max_bounces, settings.integrator) {
        (Some(_), _) => "asked for; what longer paths carry is missing".into(),
        (None, Integrator::Path | Integrator::Auto | Integrator::Photon) => {
            format!("roulette ends paths without bias; {MOST_BOUNCES} is a counted cap")
        }
        (None, Integrator::Whitted) => {
            format!("branches end at diffuse surfaces or below 1/1024; {MOST_BOUNCES} is a counted cap")
        }
    };
    decision("ending", choice, reason, 0)
}

fn film(settings: &Settings) -> Decision {
    let pixels = settings.area().pixels() as u64;
    let reason = "sum, spread of rounds and the current round, in f64";
    decision(
        "film",
        format!("{pixels} pixels of {} bytes", size_of::<Pixel>()),
        reason,
        pixels * size_of::<Pixel>() as u64,
    )
}
