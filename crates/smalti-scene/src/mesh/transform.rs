//! `scale`, `rotate` and `translate`: applied in this order, in f64.

use glam::{DMat3, DVec3};

use crate::document::{Bounds, FARTHEST, Section};
use crate::error::{Fault, Result};

/// Moves `vertices` as the table says: `scale` (one factor or three, greater than 0), then `rotate` (degrees about the
/// world's x, then y, then z axis, each counter-clockwise seen from its positive end), then `translate`.
pub fn apply(section: &Section, vertices: &mut [DVec3]) -> Result<()> {
    let scale = section.read("scale", |node| node.triple(Bounds::POSITIVE))?;
    let rotate = section.read("rotate", |node| node.vector())?;
    let translate = section.read("translate", |node| node.vector())?.unwrap_or_default();
    let linear = rotate.map_or(DMat3::IDENTITY, rotation) * DMat3::from_diagonal(scale.unwrap_or([1.0; 3]).into());
    for vertex in vertices {
        *vertex = linear * *vertex + translate;
        if vertex.abs().max_element() > FARTHEST || !vertex.is_finite() {
            return Err(Fault::at(section.span.clone(), "the mesh reaches farther than 1e100", "")
                .help("its coordinates are those of its vertices, times `scale`, plus `translate`"));
        }
    }
    Ok(())
}

fn rotation(degrees: DVec3) -> DMat3 {
    let [(sx, cx), (sy, cy), (sz, cz)] = degrees.to_array().map(sin_cos);
    let about_x = DMat3::from_cols(DVec3::X, DVec3::new(0.0, cx, sx), DVec3::new(0.0, -sx, cx));
    let about_y = DMat3::from_cols(DVec3::new(cy, 0.0, -sy), DVec3::Y, DVec3::new(sy, 0.0, cy));
    let about_z = DMat3::from_cols(DVec3::new(cz, sz, 0.0), DVec3::new(-sz, cz, 0.0), DVec3::Z);
    about_z * about_y * about_x
}

/// Sine and cosine of an angle in degrees, exact at multiples of 90.
fn sin_cos(degrees: f64) -> (f64, f64) {
    let turns = degrees % 360.0;
    let quarter = (turns / 90.0).round();
    let (sin, cos) = libm::sincos((turns - quarter * 90.0).to_radians());
    match (quarter as i32).rem_euclid(4) {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        let v = DVec3::new(0.1, 0.2, 0.3);
        assert_eq!(rotation(DVec3::new(90.0, 0.0, 0.0)) * v, DVec3::new(0.1, -0.3, 0.2));
        assert_eq!(rotation(DVec3::new(0.0, 90.0, 0.0)) * v, DVec3::new(0.3, 0.2, -0.1));
        assert_eq!(rotation(DVec3::new(0.0, 0.0, 90.0)) * v, DVec3::new(-0.2, 0.1, 0.3));
        assert_eq!(rotation(DVec3::new(0.0, 0.0, -270.0 + 360e6)) * v, DVec3::new(-0.2, 0.1, 0.3));
        assert_eq!(rotation(DVec3::new(180.0, 0.0, 180.0)) * v, DVec3::new(-0.1, 0.2, -0.3));
    }

    #[test]
    fn the_axes_are_turned_about_in_order() {
        let both = rotation(DVec3::new(90.0, 0.0, 90.0)) * DVec3::Y;
        assert_eq!(both, DVec3::Z, "about x first takes y to z, and z stays");
    }

    #[test]
    fn angles_agree_with_radians() {
        for degrees in [-1000.0, -123.4, -45.0, 0.1, 30.0, 46.0, 89.9, 200.0, 359.0] {
            let (sin, cos) = sin_cos(degrees);
            let radians = f64::to_radians(degrees);
            assert!((sin - libm::sin(radians)).abs() < 4e-15, "{degrees}");
            assert!((cos - libm::cos(radians)).abs() < 4e-15, "{degrees}");
        }
    }
}
