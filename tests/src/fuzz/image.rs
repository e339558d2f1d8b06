//! Image files of every format.

use smalti_image::{Format, Provenance, read, write};

use super::file;

/// An image file, behind one byte that says of which format.
pub fn ask(bytes: &[u8]) {
    let Some((which, bytes)) = bytes.split_first() else { return };
    let format = Format::ALL[usize::from(*which) % Format::ALL.len()];
    let name = format!("image.{}", format.extension());
    let Ok(image) = read(&file(&name, bytes)) else { return };
    assert_eq!(image.pixels.len() as u64, u64::from(image.width) * u64::from(image.height));
    // What was read can be written and, where every bit is kept, read again.
    let copy = file("copy.pfm", &[]);
    write(&copy, &image, &Provenance::new(), 0.0).expect("it has pixels");
    let again = read(&copy).expect("it was just written");
    let bits = |image: &smalti_core::film::Image| -> Vec<u32> {
        image.pixels.as_flattened().iter().map(|value| value.to_bits()).collect()
    };
    assert_eq!(bits(&again), bits(&image));
    for format in Format::ALL {
        let _ = write(&file(&format!("again.{}", format.extension()), &[]), &image, &Provenance::new(), 1.0);
    }
}
