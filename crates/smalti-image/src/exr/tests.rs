//! OpenEXR files as other programs write them, made by the library, and our own.

use std::io::Cursor;

use ::exr::image::write::WritableImage;
use ::exr::image::{
    AnyChannel, AnyChannels, Blocks, Encoding, FlatSamples, Image as ExrImage, Layer, Layers, Levels, SpecificChannels,
};
use ::exr::math::{RoundingMode, Vec2};
use ::exr::meta::attribute::{Chromaticities, IntegerBounds, LineOrder};
use ::exr::meta::header::{ImageAttributes, LayerAttributes};
use ::exr::prelude::{Compression, f16};
use smalti_core::film::Image;

use super::{decode, encode};
use crate::file::tests::{bits, extreme, sample};
use crate::{Picture, Provenance, Window, Windows};

/// The bytes of a whole picture.
fn whole(image: &Image) -> Vec<u8> {
    encode(image, Windows::whole(image.width, image.height), &provenance()).unwrap()
}

fn provenance() -> Provenance {
    let mut provenance = Provenance::new();
    for key in ["version", "scene", "seed", "hash", "reproduce", "spp"] {
        provenance.push(key, format!("of {key}"));
    }
    provenance
}

#[test]
fn keeps_every_bit() {
    for image in [sample(37, 41), sample(1, 1), extreme()] {
        assert_eq!(bits(&decode(&whole(&image)).unwrap().image), bits(&image));
    }
}

#[test]
fn the_same_image_gives_the_same_bytes() {
    let first = whole(&sample(300, 300));
    for _ in 0..4 {
        assert_eq!(whole(&sample(300, 300)), first);
    }
}

#[test]
fn carries_provenance() {
    let bytes = whole(&sample(37, 41));
    let reader = ::exr::block::read(Cursor::new(&bytes), true).unwrap();
    let attributes = &reader.headers()[0].own_attributes.other;
    assert_eq!(attributes.len(), 6);
    for (name, value) in provenance().named() {
        let held = attributes.get(&::exr::meta::attribute::Text::from(name.as_str())).unwrap();
        assert_eq!(held.to_text().unwrap().to_string(), value);
    }
}

#[test]
fn reads_half_floats_in_tiles_with_alpha() {
    let half = |at: Vec2<usize>| {
        let value = f16::from_f32((at.x() + 20 * at.y()) as f32 / 8.0);
        (value, value, value, value)
    };
    let layer = Layer::new((70, 70), LayerAttributes::default(), Encoding::FAST_LOSSLESS, SpecificChannels::rgba(half));
    let mut file = Cursor::new(Vec::new());
    ExrImage::from_layer(layer).write().non_parallel().to_buffered(&mut file).unwrap();
    let image = decode(file.get_ref()).unwrap().image;
    assert_eq!(image.pixels[70 * 69 + 65], [1445.0 / 8.0; 3]);
}

#[test]
fn broken_files_are_errors() {
    let bytes = whole(&sample(37, 41));
    for end in 0..bytes.len() {
        assert!(decode(&bytes[..end]).is_err(), "cut at {end} of {}", bytes.len());
    }
}

#[test]
fn damaged_files_do_not_panic() {
    let bytes = whole(&sample(13, 20));
    for at in 0..bytes.len() {
        for flip in [0x01, 0x80, 0xff] {
            let mut damaged = bytes.clone();
            damaged[at] ^= flip;
            let _ = decode(&damaged);
        }
    }
}

/// Columns and rows of the files below.
const SIZE: (usize, usize) = (5, 3);

/// A value for each pixel, different for every `channel`.
fn values(channel: usize) -> Vec<f32> {
    (0..SIZE.0 * SIZE.1).map(|pixel| (100 * channel + pixel) as f32 / 8.0).collect()
}

/// The image whose red, green and blue are these channels.
fn expected(channels: [usize; 3]) -> Vec<[f32; 3]> {
    let [r, g, b] = channels.map(values);
    (0..r.len()).map(|pixel| [r[pixel], g[pixel], b[pixel]]).collect()
}

/// A part with channels of these names; the values of each are those of its place in the list.
fn part(name: Option<&str>, channels: &[&str]) -> Layer<AnyChannels<FlatSamples>> {
    let channel = |(number, name): (usize, &&str)| AnyChannel::new(*name, FlatSamples::F32(values(number)));
    let channels = AnyChannels::sort(channels.iter().enumerate().map(channel).collect());
    let attributes = LayerAttributes { layer_name: name.map(Into::into), ..LayerAttributes::default() };
    let encoding = Encoding { compression: Compression::ZIP16, ..Encoding::UNCOMPRESSED };
    Layer::new(SIZE, attributes, encoding, channels)
}

/// A file with these parts.
fn file(parts: Vec<Layer<AnyChannels<FlatSamples>>>) -> Vec<u8> {
    let bounds = IntegerBounds::from_dimensions(SIZE);
    let mut file = Cursor::new(Vec::new());
    let image = ExrImage::from_layers(ImageAttributes::new(bounds), Layers::from(parts));
    image.write().non_parallel().to_buffered(&mut file).unwrap();
    file.into_inner()
}

/// The picture that is read from a file with one part, which has channels of these names.
fn read(channels: &[&str]) -> Result<Picture, String> {
    decode(&file(vec![part(None, channels)])).map_err(|error| error.to_string())
}

#[test]
fn layers_of_other_programs_are_read() {
    for (channels, rgb) in [
        (vec!["R", "G", "B"], [0, 1, 2]),
        (vec!["A", "R", "G", "B", "Z"], [1, 2, 3]),
        (
            vec!["ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B", "ViewLayer.Combined.A"],
            [0, 1, 2],
        ),
        (vec!["ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B", "ViewLayer.Depth.Z"], [0, 1, 2]),
        (vec!["r", "g", "b"], [0, 1, 2]),
        (vec!["diffuse.red", "diffuse.green", "diffuse.blue"], [0, 1, 2]),
        (vec!["beauty.b", "beauty.g", "beauty.r"], [2, 1, 0]),
        (vec!["Y"], [0, 0, 0]),
        (vec!["A", "y", "Z"], [1, 1, 1]),
        (vec!["Image.Y", "N.X", "N.Y", "N.Z"], [0, 0, 0]),
        (vec!["a.b.c.R", "a.b.c.G", "a.b.c.B", "a.b.R"], [0, 1, 2]),
    ] {
        let found = read(&channels).unwrap();
        assert_eq!(found.image.pixels, expected(rgb), "{channels:?}");
        assert!(found.notes.is_empty(), "{channels:?}: {:?}", found.notes);
    }
}

#[test]
fn of_several_layers_one_is_read_by_a_rule() {
    let layer = |name: &str| ["R", "G", "B"].map(|channel| format!("{name}{channel}"));
    for (layers, chosen, others) in [
        (["", "ViewLayer.Combined."], 0, "(without a name) is read; others are ViewLayer.Combined"),
        (["A.DiffCol.", "ViewLayer.Combined."], 1, "ViewLayer.Combined is read; others are A.DiffCol"),
        (["ViewLayer.Combined.left.", "ViewLayer.Combined.right."], 0, "ViewLayer.Combined.left is read"),
        (["specular.", "diffuse."], 1, "diffuse is read; others are specular"),
    ] {
        let names = layers.map(layer).concat();
        let found = read(&names.iter().map(String::as_str).collect::<Vec<_>>()).unwrap();
        assert_eq!(found.image.pixels, expected([3 * chosen, 3 * chosen + 1, 3 * chosen + 2]), "{layers:?}");
        assert!(found.notes[0].starts_with("its layer ") && found.notes[0].contains(others), "{:?}", found.notes);
    }
    // Colour before grey.
    let found = read(&["grey.Y", "z.R", "z.G", "z.B"]).unwrap();
    assert_eq!((found.image.pixels, found.notes.len()), (expected([1, 2, 3]), 1));
}

#[test]
fn files_of_several_parts_are_read() {
    let rgb = ["R", "G", "B"];
    let found = decode(&file(vec![part(Some("depth"), &["Z"]), part(Some("rgba"), &["A", "R", "G", "B"])])).unwrap();
    assert_eq!((found.image.pixels, found.notes.len()), (expected([1, 2, 3]), 0));
    let combined = ["R", "G", "B"].map(|channel| format!("ViewLayer.Combined.{channel}"));
    let combined: Vec<&str> = ["A"].into_iter().chain(combined.iter().map(String::as_str)).collect();
    let parts = vec![part(Some("ViewLayer.DiffCol"), &rgb), part(Some("ViewLayer.Combined"), &combined)];
    let found = decode(&file(parts)).unwrap();
    assert_eq!(found.image.pixels, expected([1, 2, 3]));
    assert_eq!(found.notes, ["its layer ViewLayer.Combined is read; others are ViewLayer.DiffCol"]);
    let parts = vec![part(Some("left"), &rgb), part(Some("right"), &["A", "R", "G", "B"])];
    let found = decode(&file(parts)).unwrap();
    assert_eq!((found.image.pixels, found.notes.len()), (expected([0, 1, 2]), 1));
}

#[test]
fn a_file_without_a_picture_is_answered_with_its_channels() {
    let message = |channels: &[&str]| read(channels).unwrap_err();
    assert_eq!(message(&["Z"]), "it has neither R, G and B nor Y; its channels are Z");
    assert_eq!(message(&["N.X", "N.Y", "N.Z"]), "it has neither R, G and B nor Y; its channels are N.X, N.Y, N.Z");
    assert_eq!(message(&["R", "G"]), "it has neither R, G and B nor Y; its channels are G, R");
    assert_eq!(message(&["a.R", "b.G", "c.B"]), "it has neither R, G and B nor Y; its channels are a.R, b.G, c.B");
    assert_eq!(message(&["Y", "RY"]), "it has neither R, G and B nor Y; its channels are RY, Y");
    let many: Vec<String> = (10..40).map(|n| format!("id{n}")).collect();
    let message = message(&many.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(message.ends_with("id20, id21 and 18 more"), "{message}");
}

#[test]
fn luminance_and_chroma_become_colours() {
    let found = read(&["Y", "RY", "BY"]).unwrap().image;
    // Y = 4 / 8, RY = 104 / 8, BY = 204 / 8 in the fifth pixel; weights of Rec. 709.
    let (red, blue): (f64, f64) = (0.5 * 14.0, 0.5 * 26.5);
    let green = (0.5 - 0.21264 * red - 0.07219 * blue) / 0.71517;
    for (found, expected) in found.pixels[4].iter().zip([red, green, blue]) {
        assert!((f64::from(*found) - expected).abs() < 2e-4 * expected.abs(), "{found} for {expected}");
    }
}

/// The file with `change` made to the bytes behind the first occurrence of `mark`.
fn changed(mut bytes: Vec<u8>, mark: &[u8], change: impl Fn(&mut [u8])) -> Vec<u8> {
    let at = bytes.windows(mark.len()).position(|window| window == mark).unwrap() + mark.len();
    change(&mut bytes[at..]);
    bytes
}

#[test]
fn chroma_of_lower_resolution_is_refused_by_name() {
    // Behind the name: type, linearity, then how many columns and rows each sample is of.
    let sparse = |channels: [&str; 3]| {
        let name = [&[0], channels[2].as_bytes(), &[0]].concat();
        let bytes = file(vec![part(Some("a"), &["Z"]), part(Some("b"), &channels)]);
        changed(bytes, &name, |about| (about[8], about[12]) = (2, 2))
    };
    for (channels, answer) in [
        (["Y", "RY", "BY"], "luminance and chroma (Y, RY, BY) of lower resolution"),
        (["l.Y", "l.RY", "l.BY"], "luminance and chroma (Y, RY, BY) of lower resolution"),
        (["R", "G", "B"], "its channels differ in resolution, which is not read"),
    ] {
        let message = decode(&sparse(channels)).unwrap_err().to_string();
        assert!(message.contains(answer), "{message}");
    }
}

#[test]
fn deep_data_is_refused_by_name() {
    // The version with its flag for deep data; the library takes no header of it.
    let bytes = changed(file(vec![part(None, &["R", "G", "B"])]), b"\x76\x2f\x31\x01\x02", |flags| flags[0] = 8);
    assert_eq!(decode(&bytes[..100]).unwrap_err().to_string(), "it holds deep data, which is not read");
}

#[test]
fn unknown_compressions_are_refused_by_name() {
    let compressed = |number: u8| {
        let bytes = file(vec![part(None, &["R", "G", "B"])]);
        changed(bytes, b"compression\0compression\0\x01\0\0\0", |about| about[0] = number)
    };
    let message = |number: u8| decode(&compressed(number)).unwrap_err().to_string();
    assert_eq!(message(10), "its compression (HTJ2K) is not read");
    assert_eq!(message(99), "its compression is not known");
    assert_eq!(
        decode(&file(vec![part(None, &["R"])])[..60]).unwrap_err().to_string(),
        "its header is damaged or cut short"
    );
}

#[test]
fn every_sample_type_is_read() {
    let of = |samples: fn(Vec<f32>) -> FlatSamples| {
        let mut part = part(None, &["B", "G", "R"]);
        part.channel_data.list[1].sample_data = samples(values(1));
        decode(&file(vec![part])).unwrap().image.pixels
    };
    assert_eq!(of(|values| FlatSamples::F16(values.into_iter().map(f16::from_f32).collect())), expected([2, 1, 0]));
    let whole = of(|values| FlatSamples::U32(values.into_iter().map(|value| value as u32).collect()));
    assert_eq!(whole[7], [207.0 / 8.0, 13.0, 7.0 / 8.0]);
}

#[test]
fn every_lossless_compression_is_read() {
    use Compression::{PIZ, RLE, Uncompressed, ZIP1, ZIP16};
    for compression in [Uncompressed, RLE, ZIP1, ZIP16, PIZ] {
        for blocks in [Blocks::ScanLines, Blocks::Tiles(Vec2(2, 2)), Blocks::Tiles(Vec2(64, 64))] {
            for line_order in [LineOrder::Increasing, LineOrder::Decreasing] {
                let mut part = part(None, &["R", "G", "B"]);
                part.encoding = Encoding { compression, blocks, line_order };
                assert_eq!(
                    decode(&file(vec![part])).unwrap().image.pixels,
                    expected([0, 1, 2]),
                    "{compression} {blocks:?}"
                );
            }
        }
    }
}

#[test]
fn of_several_resolutions_the_largest_is_read() {
    let levels = |channel: usize| {
        let small = |pixels: usize| FlatSamples::F32(vec![-1.0; pixels]);
        let level_data = vec![FlatSamples::F32(values(channel)), small(2), small(1)];
        Levels::Mip { rounding_mode: RoundingMode::Down, level_data }
    };
    let channels = ["B", "G", "R"].into_iter().enumerate().map(|(n, name)| AnyChannel::new(name, levels(n))).collect();
    let encoding = Encoding { blocks: Blocks::Tiles(Vec2(4, 4)), ..Encoding::UNCOMPRESSED };
    let layer = Layer::new(SIZE, LayerAttributes::default(), encoding, AnyChannels::sort(channels));
    let mut file = Cursor::new(Vec::new());
    ExrImage::from_layer(layer).write().non_parallel().to_buffered(&mut file).unwrap();
    assert_eq!(decode(file.get_ref()).unwrap().image.pixels, expected([2, 1, 0]));
}

#[test]
fn windows_are_read_as_they_were_written() {
    let (width, height) = (5, 3);
    for (data, display) in [
        (Window { x: 0, y: 0, width, height }, Window::of_size(5, 3)),
        (Window { x: 7, y: 9, width, height }, Window::of_size(40, 30)),
        (Window { x: -2, y: -1, width, height }, Window::of_size(1, 1)),
        (Window { x: 3, y: -100, width, height }, Window { x: 3, y: -100, width, height }),
    ] {
        let windows = Windows { data, display };
        let found = decode(&encode(&sample(5, 3), windows, &provenance()).unwrap()).unwrap();
        assert_eq!((found.windows, bits(&found.image)), (Some(windows), bits(&sample(5, 3))));
    }
}

#[test]
fn other_primaries_are_named() {
    let notes = |red: f32| {
        let primaries = Chromaticities {
            red: Vec2(red, 0.33),
            green: Vec2(0.3, 0.6),
            blue: Vec2(0.15, 0.06),
            white: Vec2(0.3127, 0.329),
        };
        let mut attributes = ImageAttributes::new(IntegerBounds::from_dimensions(SIZE));
        attributes.chromaticities = Some(primaries);
        let mut file = Cursor::new(Vec::new());
        let image = ExrImage::from_layers(attributes, Layers::from(vec![part(None, &["R", "G", "B"])]));
        image.write().non_parallel().to_buffered(&mut file).unwrap();
        decode(file.get_ref()).unwrap().notes
    };
    assert!(notes(0.64).is_empty());
    assert!(notes(0.7)[0].starts_with("its primaries (0.7 0.33 "));
}
