//! The hash that names a linear image.

use smalti_core::film::Image;
use xxhash_rust::xxh3::Xxh3;

/// XXH3-128 in lower-case hex over linear RGB as little-endian f32, row 0 on top, left to right.
///
/// Anyone can recompute it from the PFM, which stores the bottom row first, for example with `xxhsum -H2`.
pub fn hash(image: &Image) -> String {
    let mut hasher = Xxh3::new();
    for row in image.pixels.chunks(image.width.max(1) as usize) {
        let bytes: Vec<u8> = row.as_flattened().iter().flat_map(|value| value.to_le_bytes()).collect();
        hasher.update(&bytes);
    }
    format!("{:032x}", hasher.digest128())
}

#[cfg(test)]
mod tests {
    use xxhash_rust::xxh3::xxh3_128;

    use super::*;

    #[test]
    fn of_no_bytes_is_the_published_value() {
        assert_eq!(hash(&Image::default()), "99aa06d3014798d86001c324468d497f");
    }

    #[test]
    fn is_that_of_the_rows_of_the_pfm_in_reverse() {
        let image = crate::file::tests::sample(5, 3);
        let file = crate::pfm::encode(&image);
        let data = &file[file.len() - 5 * 3 * 12..];
        let rows: Vec<u8> = data.chunks(5 * 12).rev().flatten().copied().collect();
        assert_eq!(hash(&image), format!("{:032x}", xxh3_128(&rows)));
    }

    #[test]
    fn tells_zeros_of_different_sign_apart() {
        let mut image = Image::black(1, 1);
        let positive = hash(&image);
        image.pixels[0][2] = -0.0;
        assert_ne!(hash(&image), positive);
    }
}
