//! `[camera]`, or `[camera.NAME]` for each of several.

use glam::DVec3;
use smalti_core::scene::world::Camera;

use crate::document::{Bounds, Key, Node, Section, key};
use crate::error::{Fault, Result};

const KEYS: &[Key] = &[key("eye", "[0, -5, 1]"), key("look_at", "[0, 0, 1]"), key("up", "[0, 0, 1]"), key("fov", "60")];

/// Sine of the angle between two directions below which they count as parallel.
const PARALLEL: f64 = 1e-9;

/// All cameras, in file order; the only one has no name.
pub fn read(root: &Section) -> Result<Vec<Camera>> {
    let Some(node) = root.find("camera") else {
        let example = "[camera] with eye = [0, -5, 1], look_at = [0, 0, 1], up = [0, 0, 1] and fov = 60";
        return Err(Fault::of_file("the scene has no camera").help(format!("add for example {example}")));
    };
    if node.value().is_array() {
        let fault = node.fault("must be a table", "a list");
        return Err(fault.help("write `[camera]`, or `[camera.NAME]` for each of several"));
    }
    let entries = Section::named(node, "`[camera]`")?;
    let several = !entries.is_empty() && entries.iter().all(|entry| entry.value().is_table());
    if !several {
        return Ok(vec![camera(&Section::open(node, "`[camera]`", KEYS)?, "")?]);
    }
    let named = |entry: Node| camera(&Section::open(entry, format!("`[camera.{}]`", entry.name), KEYS)?, entry.name);
    entries.into_iter().map(named).collect()
}

fn camera(section: &Section, name: &str) -> Result<Camera> {
    let eye = section.need("eye")?.vector()?;
    let look_at_node = section.need("look_at")?;
    let look_at = look_at_node.vector()?;
    let up_node = section.need("up")?;
    let up = up_node.vector()?;
    let fov = section.need("fov")?.number(Bounds::OPENING)?;
    let Some(forward) = direction(look_at - eye) else {
        return Err(look_at_node
            .fault("is the same point as `eye`", "")
            .help("the camera looks from `eye` to `look_at`: they must differ"));
    };
    let Some(upward) = direction(up) else {
        return Err(up_node.fault("has no direction", "").help("for example `up = [0, 0, 1]`"));
    };
    if forward.cross(upward).length() < PARALLEL {
        return Err(up_node
            .fault("is parallel to the direction of view", "")
            .help("`up` says which way is up in the picture: choose one across the line from `eye` to `look_at`"));
    }
    Ok(Camera { name: name.to_owned(), eye, look_at, up, fov: fov.to_radians() })
}

/// The unit vector along `v`, of whatever length; `None` if it has none.
fn direction(v: DVec3) -> Option<DVec3> {
    let extent = v.abs().max_element();
    (extent > 0.0).then(|| (v / extent).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_has_unit_length_at_any_scale() {
        for scale in [1e-300, 1.0, 1e100] {
            let unit = direction(DVec3::new(3.0, 0.0, 4.0) * scale).unwrap();
            assert!((unit - DVec3::new(0.6, 0.0, 0.8)).length() < 1e-15);
        }
        assert_eq!(direction(DVec3::ZERO), None);
    }
}
