use super::*;

const SOURCE: &[u8] = b"# a comment\no thing\r\nv 0 0 0\nv 1 0.5 0\n  v\t1 1 -1e-3\nvn 0 0 1\nvt 0 0\nv 0 1 0\n\
                      f 1/1/1 2/1 3//1 4\nf -1 -2 -3\nl 1 2\nv 5 5 5\nf 5 1 2\nusemtl \xe9\n";

#[test]
fn it_reads_what_tobj_reads() {
    let options = tobj::LoadOptions { triangulate: true, ignore_lines: true, ..Default::default() };
    // `tobj` reads no Latin-1.
    let source = String::from_utf8_lossy(SOURCE);
    let (models, _) =
        tobj::load_obj_buf(&mut source.as_bytes(), &options, |_| Err(tobj::LoadError::ReadError)).unwrap();
    let theirs: Vec<DVec3> = models
        .iter()
        .flat_map(|model| {
            let at = |index: &u32| DVec3::from_slice(&model.mesh.positions[3 * *index as usize..]);
            model.mesh.indices.iter().map(at).collect::<Vec<_>>()
        })
        .collect();
    let ours = read(SOURCE).unwrap();
    assert_eq!(ours.faces, [[0, 1, 2], [0, 2, 3], [3, 2, 1], [4, 0, 1]]);
    let corners: Vec<DVec3> = ours.faces.as_flattened().iter().map(|i| ours.vertices[*i as usize]).collect();
    assert_eq!(corners, theirs);
}

#[test]
fn a_flaw_names_its_line() {
    let cases = [
        ("v 0 0\n", 1, "three coordinates"),
        ("v 0 0 x\n", 1, "`x` is not a number"),
        ("\nv 0 0 nan\n", 2, "not finite"),
        ("v 0 0 0\nf 1 1 2\n", 2, "vertex 2, but they are numbered 1 to 1"),
        ("v 0 0 0\nf 1 1 0\n", 2, "count from 1"),
        ("v 0 0 0\nf 1 1 -2\n", 2, "only 1 stand above"),
        ("v 0 0 0\nf 1 1 \\\n2\n", 2, "vertex 2, but they are numbered 1 to 1"),
        ("f 1 2 3\n", 1, "vertex 1, but there is none"),
        ("v 0 0 0\nf 1 1 a\n", 2, "`a` is not the number"),
    ];
    for (text, line, words) in cases {
        let flaw = read(text.as_bytes()).unwrap_err();
        assert_eq!(flaw.line, Some(line), "{text}");
        assert!(flaw.message.contains(words), "{} lacks {words}", flaw.message);
    }
    assert_eq!(read(b"v 0 0 0\n").unwrap_err(), Flaw::new("there is no face in it"));
    assert_eq!(read(b"v 0 0 0\nl 1 1\n").unwrap_err(), Flaw::new("there is no face in it, only 1 line"));
    let short = "none of its faces has three different corners";
    assert_eq!(read(b"v 0 0 0\nf 1 1 1 # once\n").unwrap_err(), Flaw::new(short));
}
/// A square and what is used of it, whatever stands around.
fn is_square(text: &[u8]) {
    let Soup { vertices, faces, tally } = read(text).unwrap_or_else(|flaw| panic!("{flaw:?}: {text:?}"));
    assert_eq!((vertices.len(), &faces[..]), (4, &[[0, 1, 2], [0, 2, 3]][..]), "{text:?}");
    assert_eq!(vertices.iter().sum::<DVec3>(), DVec3::new(2.0, 2.0, 0.0), "{text:?}");
    assert_eq!(tally.short, 0);
}

#[test]
fn marks_line_ends_and_continued_lines_change_nothing() {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1/1/1 2/2/1 3/3/1 4/4/1\n";
    is_square(square.as_bytes());
    is_square(format!("\u{feff}{square}").as_bytes());
    for end in ["\r\n", "\r", "\n\n", " \t\n", " # \u{e9}\n"] {
        is_square(square.replace('\n', end).as_bytes());
    }
    for end in ["\n", "\r\n", "\r", " \t\n"] {
        is_square(square.replace(" 3/3", &format!(" \\{end}3/3")).as_bytes());
    }
    is_square(square.replace(' ', " \\\n").as_bytes());
    is_square(square.replace("f 1", "fo 1").as_bytes());
    is_square(square.replace("1/1/1 2/2/1 3/3/1 4/4/1", "-4 -3/-3 -2//-2 -1 \\").as_bytes());
}

#[test]
fn names_and_comments_may_be_of_any_bytes() {
    let square = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    for line in [&b"o caf\xe9\n"[..], b"usemtl \xff\xfe\n", b"mtllib \xa9.mtl\n", b"g \x80\n", b"# v 9 9 9 \xe9\n"] {
        is_square(&[line, square].concat());
    }
    // What ends in a backslash is a folder there.
    is_square(&[b"# C:\\models\\\n", &square[..]].concat());
}

#[test]
fn what_is_not_used_is_counted() {
    let text = "mtllib a.mtl\no a\ng b\nusemtl red\nv 0 0 0 1 0 0\nv 1 0 0 1\nv 0 1 0\nvn 0 0 nan\nvt 0 0\nvt 1 1\n\
                f 1 2 3\nf 1 2\nl 1 2\np 1\nusemtl blue\nusemtl red\ncstype bezier\ns off\nf 1 2 2\n";
    let tally = read(text.as_bytes()).unwrap().tally;
    let unused = "1 normal, 2 texture coordinates, 1 colour, 2 materials, 2 groups, 1 line, 1 point, \
                  1 free-form statement and 2 other statements";
    assert_eq!((tally.unused().as_str(), tally.short), (unused, 2));
}
