use super::role::CORNERS;
use super::*;

const ASCII: &str = "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\nproperty uchar red\nproperty float x\n\
                     property double y\nproperty short z\nelement edge 1\nproperty int a\nelement face 2\n\
                     property float quality\nproperty list uchar int vertex_indices\nend_header\n\
                     255 0 0 0\n255 1 0.5 0\n255 1 1 -2\n255 0 1 0\n7\n0.1 3 0 1 2\n0.2 4 0 1 2 3\n";

fn expected() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let vertices = [[0.0, 0.0, 0.0], [1.0, 0.5, 0.0], [1.0, 1.0, -2.0], [0.0, 1.0, 0.0]].map(DVec3::from_array);
    (vertices.to_vec(), vec![[0, 1, 2], [0, 1, 2], [0, 2, 3]])
}

/// The file of `ASCII` in binary.
fn binary(big: bool) -> Vec<u8> {
    fn put<const N: usize>(out: &mut Vec<u8>, big: bool, mut little: [u8; N]) {
        if big {
            little.reverse();
        }
        out.extend(little);
    }
    let order = if big { "binary_big_endian" } else { "binary_little_endian" };
    let header = ASCII.split_inclusive("end_header\n").next().unwrap();
    let mut out = header.replace("ascii", order).into_bytes();
    for vertex in expected().0 {
        out.push(255);
        put(&mut out, big, (vertex.x as f32).to_le_bytes());
        put(&mut out, big, vertex.y.to_le_bytes());
        put(&mut out, big, (vertex.z as i16).to_le_bytes());
    }
    put(&mut out, big, 7i32.to_le_bytes());
    for face in [&[0i32, 1, 2][..], &[0, 1, 2, 3]] {
        put(&mut out, big, 0.1f32.to_le_bytes());
        out.push(face.len() as u8);
        face.iter().for_each(|corner| put(&mut out, big, corner.to_le_bytes()));
    }
    out
}

/// Vertices and faces: what is not used is looked at elsewhere.
fn mesh(bytes: &[u8]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let soup = read(bytes).unwrap_or_else(|flaw| panic!("{flaw:?}"));
    (soup.vertices, soup.faces)
}

/// A square of 1 × 1 whose faces are written by `element` and `rows`.
fn square(element: &str, rows: &str) -> Vec<u8> {
    let vertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
    format!("ply\nformat ascii 1.0\n{vertices}{element}\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n{rows}").into_bytes()
}

#[test]
fn all_encodings_give_the_same_mesh() {
    for bytes in [ASCII.as_bytes(), &binary(false), &binary(true)] {
        assert_eq!(mesh(bytes), expected());
        assert_eq!(read(bytes).unwrap().tally.unused(), "4 colours, 2 `quality` and 1 `edge`");
    }
}

#[test]
fn line_ends_and_a_mark_change_nothing() {
    let marked = |bytes: &[u8]| [b"\xef\xbb\xbf", bytes].concat();
    let ended = |end: &str| ASCII.replace('\n', end);
    for text in [ended("\r\n"), ended("\r"), ended("\n\n"), ended(" \n"), ended("\n").replace("by hand", "\u{e9}")] {
        assert_eq!(mesh(text.as_bytes()), expected(), "{text:?}");
        assert_eq!(mesh(&marked(text.as_bytes())), expected());
    }
    let latin = [&ASCII.as_bytes()[..30], b"\xe9\xff", &ASCII.as_bytes()[30..]].concat();
    assert_eq!(mesh(&latin), expected(), "{latin:?}");
    // The first byte behind the header is a line end, if the header's own are not looked at.
    for end in ["\r\n", "\r"] {
        let bytes = binary(false);
        let header = bytes.windows(11).position(|part| part == b"end_header\n").unwrap() + 11;
        let text = String::from_utf8_lossy(&bytes[..header]).replace('\n', end).into_bytes();
        let mut body = bytes[header..].to_vec();
        body[0] = b'\n';
        assert_eq!(mesh(&marked(&[text, body].concat())), expected(), "{end:?}");
    }
}

#[test]
fn values_that_are_not_used_may_be_anything() {
    for word in ["nan", "-nan", "inf", "-1.#IND", "1.#QNAN", "nan(ind)", "-1e999", "none", "\u{e9}"] {
        let text = ASCII.replace("255", word).replace("0.1 3", &format!("{word} 3"));
        assert_eq!(mesh(text.as_bytes()), expected(), "{word}");
    }
}

#[test]
fn indices_may_be_of_any_type() {
    for kind in ["char", "uchar", "short", "ushort", "int", "uint", "float", "double", "int8", "uint16", "float32"] {
        for name in CORNERS {
            let element = format!("element face 1\nproperty list {kind} {kind} {name}");
            assert_eq!(mesh(&square(&element, "4 0 1 2 3\n")).1, [[0, 1, 2], [0, 2, 3]], "{element}");
        }
    }
    let floats = "element face 1\nproperty list float float vertex_indices";
    assert_eq!(mesh(&square(floats, "4.0 0.0 1e0 2.0 3\n")).1, [[0, 1, 2], [0, 2, 3]]);
    let broken = read(&square(floats, "3 0 1.5 2\n")).unwrap_err();
    assert_eq!(broken, Flaw::at(14, "`1.5` is not the number of a vertex"));
    assert!(read(&square(floats, "3 0 nan 2\n")).unwrap_err().message.contains("`NaN` is not the number of a vertex"));
    assert_eq!(read(&square(floats, "-3 0 1 2\n")).unwrap_err().message, "a list has the length -3");
}

/// The dart 0 1 2 3 as a list of some type, of whose bytes each is put by `put`, the lowest first.
fn dart<const N: usize>(kind: &str, big: bool, put: impl Fn(u8) -> [u8; N]) -> Vec<u8> {
    let order = if big { "big" } else { "little" };
    let element = format!("element face 1\nproperty list {kind} {kind} vertex_index");
    let text = square(&element, "");
    let header = text.windows(11).position(|part| part == b"end_header\n").unwrap() + 11;
    let mut out =
        String::from_utf8_lossy(&text[..header]).replace("ascii", &format!("binary_{order}_endian")).into_bytes();
    let mut number = |mut little: Vec<u8>| {
        if big {
            little.reverse();
        }
        out.extend(little);
    };
    for coordinate in [0.0f32, 0.0, 0.0, 2.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.5, 1.0, 0.0] {
        number(coordinate.to_le_bytes().to_vec());
    }
    [4, 0, 1, 2, 3].into_iter().for_each(|index| number(put(index).to_vec()));
    out
}

#[test]
fn binary_indices_may_be_of_any_type() {
    for big in [false, true] {
        for bytes in [
            dart("char", big, |index| (index as i8).to_le_bytes()),
            dart("uint8", big, |index| [index]),
            dart("short", big, |index| i16::from(index).to_le_bytes()),
            dart("uint16", big, |index| u16::from(index).to_le_bytes()),
            dart("int32", big, |index| i32::from(index).to_le_bytes()),
            dart("uint", big, |index| u32::from(index).to_le_bytes()),
            dart("float", big, |index| f32::from(index).to_le_bytes()),
            dart("float64", big, |index| f64::from(index).to_le_bytes()),
        ] {
            assert_eq!(mesh(&bytes).1.len(), 2);
            assert!(mesh(&bytes).1.iter().all(|face| face.contains(&3) && face.contains(&1)), "cut at its dent");
        }
    }
}

#[test]
fn strips_are_wound_alike() {
    let strips = "element tristrips 1\nproperty list int int vertex_indices";
    assert_eq!(mesh(&square(strips, "4 0 1 3 2\n")).1, [[0, 1, 3], [3, 1, 2]]);
    assert_eq!(mesh(&square(strips, "8 0 1 3 -1 1 2 3 -1\n")).1, [[0, 1, 3], [1, 2, 3]], "each strip begins anew");
    assert_eq!(mesh(&square(strips, "7 0 1 2 2 3 3 0\n")).1, [[0, 1, 2]], "a corner twice leads elsewhere");
    let unsigned = strips.replace("int int", "uint uint");
    assert_eq!(mesh(&square(&unsigned, "7 0 1 2 4294967295 0 2 3\n")).1, [[0, 1, 2], [0, 2, 3]]);
    assert!(read(&square(strips, "3 0 1 4\n")).unwrap_err().message.contains("vertex 4"));
    let both = format!("element face 1\nproperty list uchar int vertex_indices\n{strips}");
    assert_eq!(mesh(&square(&both, "3 0 1 2\n3 0 2 3\n")).1, [[0, 1, 2], [0, 2, 3]]);
}

#[test]
fn other_elements_and_faces_before_vertices_are_read() {
    let early = "ply\nformat ascii 1.0\nelement material 1\nproperty list uchar uchar name\nelement face 1\n\
                 property list uchar int vertex_index\nelement vertex 3\nproperty float x\nproperty float y\n\
                 property float z\nelement edge 2\nproperty int a\nend_header\n3 65 66 67\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n\
                 1\n2\n";
    assert_eq!(mesh(early.as_bytes()).1, [[0, 1, 2]]);
    assert_eq!(read(early.as_bytes()).unwrap().tally.unused(), "2 `edge` and 1 `material`");
    let wrong = read(early.replace("3 0 1 2", "3 0 1 3").as_bytes()).unwrap_err();
    assert_eq!(wrong, Flaw::at(15, "a face asks for vertex 3, but they are numbered 0 to 2"));
}

#[test]
fn what_the_header_does_not_name_is_counted() {
    let faces = "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord";
    let soup = read(&square(faces, "3 0 1 2 0 9 9\n2 0 1 0\nmore\n")).unwrap();
    assert_eq!((soup.faces.len(), soup.tally.short), (1, 1));
    assert_eq!(soup.tally.unused(), "2 texture coordinates, 2 surplus numbers and 4 surplus bytes");
}

#[test]
fn a_file_that_is_cut_anywhere_is_refused() {
    for whole in [ASCII.as_bytes(), &binary(false), &binary(true)] {
        // The last digit of the ASCII file and its line end may be missing; no shorter file is whole.
        for length in 0..whole.len() - 2 {
            assert!(read(&whole[..length]).is_err(), "{length}");
        }
    }
}

#[test]
fn a_flaw_names_its_line_or_item() {
    let flaw = |from: &str, to: &str| read(ASCII.replace(from, to).as_bytes()).unwrap_err();
    assert_eq!(flaw("255 1 1 -2", "255 1e99 1 -2"), Flaw::at(17, "a vertex is not finite"));
    assert_eq!(flaw("255 1 1 -2", "255 nan 1 -2"), Flaw::at(17, "a vertex is not finite"));
    assert_eq!(flaw("255 1 1 -2", "255 1 x -2"), Flaw::at(17, "`x` is not a number"));
    assert_eq!(flaw("255 1 1 -2", "255 1 1"), Flaw::at(17, "the row ends too early"));
    assert_eq!(flaw("0.1 3 0 1 2", "0.1 3 0 1 4").line, Some(20));
    assert!(flaw("0.1 3 0 1 2", "0.1 3 0 1 -1").message.contains("vertex -1"));
    assert_eq!(flaw("property short z\n", "").line, None);
    let mut bytes = binary(false);
    let last = bytes.len() - 4;
    bytes[last] = 9;
    let message = "a face asks for vertex 9, but they are numbered 0 to 3 (`face` 1, counted from 0)";
    assert_eq!(read(&bytes).unwrap_err(), Flaw::new(message));
}

#[test]
fn a_header_that_is_none_is_answered_in_its_own_words() {
    let flaw = |from: &str, to: &str| read(ASCII.replace(from, to).as_bytes()).unwrap_err();
    for (from, to, line, words) in [
        ("ply\n", "plx\n", Some(1), "first line must be `ply`"),
        ("ascii", "text", Some(2), "`text` is no format"),
        ("format ascii 1.0\n", "", None, "no line `format`"),
        ("vertex 4", "vertex four", Some(4), "`four` is not a number of `vertex`"),
        ("vertex 4", "vertex -4", Some(4), "`-4` is not a number"),
        ("short z", "long z", Some(8), "`long` is not a type"),
        ("list uchar", "list", Some(13), "property list TYPE TYPE NAME"),
        ("edge 1", "vertex 1", Some(9), "`vertex` stands in the header twice"),
        ("element vertex 4\n", "", Some(4), "before the first element"),
        ("element edge 1", "elements edge 1", Some(9), "`elements`"),
        ("end_header", "end", Some(14), "`end`"),
        ("int vertex_indices", "int corners", None, "no face in it"),
    ] {
        let flaw = flaw(from, to);
        assert_eq!(flaw.line, line, "{to}: {}", flaw.message);
        assert!(flaw.message.contains(words), "{to}: {}", flaw.message);
    }
}

#[test]
fn no_byte_makes_it_panic() {
    for whole in [ASCII.as_bytes(), &binary(false), &binary(true)] {
        for place in 0..whole.len() {
            for byte in [0, 1, b'\n', b' ', b'-', b'9', 0x7f, 0x80, 0xff] {
                let mut bytes = whole.to_vec();
                bytes[place] = byte;
                if let Ok(soup) = read(&bytes) {
                    assert!(soup.faces.as_flattened().iter().all(|index| (*index as usize) < soup.vertices.len()));
                }
            }
        }
    }
}

#[test]
fn a_header_that_lies_costs_nothing() {
    for count in ["5", "4000000000", "18446744073709551615", "99999999999999999999999"] {
        let lie = ASCII.replace("element vertex 4", &format!("element vertex {count}"));
        assert!(read(lie.as_bytes()).is_err(), "{count}");
    }
    let endless = ASCII.replace("element edge 1\nproperty int a\n", "element edge 100000000\n");
    assert!(read(endless.as_bytes()).unwrap_err().message.contains("no properties"));
    let mut bytes = binary(false);
    let list = bytes.len() - 17;
    bytes[list] = 255;
    assert!(read(&bytes).is_err());
}
