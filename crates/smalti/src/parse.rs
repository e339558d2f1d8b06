//! Values of flags that have a form or a range of their own.

use smalti_core::settings::Rect;

use crate::args::{MAX_THREADS, Threads};

/// The largest side of an image in pixels; scene files have the same limit.
pub const MAX_SIDE: u32 = 65_536;

/// Width and height in pixels, each from 1 to 65,536.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// Reads `800x600`.
pub fn parse_size(text: &str) -> Result<Size, String> {
    let form = "expected WIDTHxHEIGHT in pixels, for example 800x600";
    let (width, height) = text.split_once(['x', 'X', '×']).ok_or(form)?;
    let size = Size { width: whole(width).ok_or(form)?, height: whole(height).ok_or(form)? };
    if size.width == 0 || size.height == 0 {
        return Err("an image has at least 1x1 pixels".into());
    }
    if size.width.max(size.height) > MAX_SIDE {
        return Err(format!("an image has at most {MAX_SIDE}x{MAX_SIDE} pixels"));
    }
    Ok(size)
}

/// Reads `X,Y,W,H`.
pub fn parse_crop(text: &str) -> Result<Rect, String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(whole).collect();
    let Some(&[x, y, width, height]) = numbers.as_deref() else {
        return Err("expected X,Y,W,H: four whole numbers, for example 120,80,64,64".into());
    };
    if width == 0 || height == 0 {
        return Err("a crop has at least 1x1 pixels".into());
    }
    Ok(Rect { x, y, width, height })
}

/// Reads `1,2,4` or `1,max`; `max` becomes 0.
pub fn parse_threads(text: &str) -> Result<Threads, String> {
    text.split(',').map(thread_count).collect::<Result<Vec<u32>, String>>().map(Threads)
}

fn thread_count(text: &str) -> Result<u32, String> {
    match (text.trim(), whole(text)) {
        ("max", _) => Ok(0),
        (_, Some(count)) if (1..=MAX_THREADS).contains(&i64::from(count)) => Ok(count),
        _ => Err(format!("'{text}' is neither a number from 1 to {MAX_THREADS} nor 'max'")),
    }
}

/// Reads a finite number.
pub fn parse_finite(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.trim().parse().ok();
    number.filter(|number| number.is_finite()).ok_or("expected a number".into())
}

/// Reads a length above 0.
pub fn parse_length(text: &str) -> Result<f64, String> {
    parse_finite(text).ok().filter(|number| *number > 0.0).ok_or("expected a length greater than 0".into())
}

/// Reads a share above 0: `3%` or `0.03`.
pub fn parse_share(text: &str) -> Result<f64, String> {
    let number = match text.strip_suffix('%') {
        Some(percent) => parse_finite(percent).map(|percent| percent / 100.0),
        None => parse_finite(text),
    };
    number.ok().filter(|share| *share > 0.0).ok_or("expected a share greater than 0, for example 3% or 0.03".into())
}

/// Reads a finite number that is at least 0.
pub fn parse_threshold(text: &str) -> Result<f64, String> {
    parse_finite(text).ok().filter(|number| *number >= 0.0).ok_or("expected a number, 0 or larger".into())
}

fn whole(text: &str) -> Option<u32> {
    text.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(parse_size("800x600"), Ok(Size { width: 800, height: 600 }));
        assert_eq!(parse_size("1X1"), Ok(Size { width: 1, height: 1 }));
        for wrong in ["800", "800x", "x600", "800x600x3", "-1x5", "1.5x2", "99999999999x1", "", "0x5", "5x0", "65537x1"]
        {
            assert!(parse_size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn crops() {
        assert_eq!(parse_crop("1,2,3,4"), Ok(Rect { x: 1, y: 2, width: 3, height: 4 }));
        assert_eq!(parse_crop("0, 0, 8, 8"), Ok(Rect { x: 0, y: 0, width: 8, height: 8 }));
        for wrong in ["1,2,3", "1,2,3,4,5", "1,2,3,x", "1,2,0,4", "1,2,4,0", "-1,2,3,4", ""] {
            assert!(parse_crop(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn lists_of_threads() {
        assert_eq!(parse_threads("1,2,max"), Ok(Threads(vec![1, 2, 0])));
        for wrong in ["0", "1,,2", "all", "-1", "4097", ""] {
            assert!(parse_threads(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn numbers() {
        assert_eq!(parse_finite("-1.5"), Ok(-1.5));
        assert_eq!(parse_threshold("1e-3"), Ok(1e-3));
        for wrong in ["nan", "inf", "1e999", "one", ""] {
            assert!(parse_finite(wrong).is_err() && parse_threshold(wrong).is_err(), "{wrong}");
        }
        assert!(parse_threshold("-1").is_err());
        assert_eq!((parse_share("3%"), parse_share("0.25")), (Ok(0.03), Ok(0.25)));
        for wrong in ["0", "-1", "s", "%", ""] {
            assert!(parse_share(wrong).is_err(), "{wrong}");
        }
    }
}
