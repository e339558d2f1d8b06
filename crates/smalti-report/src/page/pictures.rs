//! The pictures of a page, as PNG files in memory.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;

/// The pictures that a page shows; whatever is missing is left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pictures {
    /// Of each arm of the study, in its order.
    pub arms: Vec<ArmPictures>,
    /// Each reference of the study, in its order, tone-mapped.
    pub references: Vec<Option<Vec<u8>>>,
    /// The difference that has the last colour of the difference pictures, for each reference, in the images' units.
    pub full_scales: Vec<Option<f32>>,
}

/// The pictures of an arm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArmPictures {
    /// Its first image, tone-mapped.
    pub picture: Option<Vec<u8>>,
    /// What that is brighter (red to yellow) and darker (blue to cyan) than the reference.
    pub difference: Option<Vec<u8>>,
}

/// A PNG file within an address.
pub(super) fn png(bytes: &[u8]) -> String {
    data("image/png", bytes)
}

/// `bytes` within an address.
pub(super) fn data(kind: &str, bytes: &[u8]) -> String {
    format!("data:{kind};base64,{}", BASE64_STANDARD.encode(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_hold_the_bytes() {
        assert_eq!(png(b"smalti"), "data:image/png;base64,c21hbHRp");
    }
}
