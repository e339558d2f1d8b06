//! OBJ: the lines `v` and `f`; all others (normals, texture coordinates, groups, materials) say nothing that is used.
//!
//! Our own reader, because the crate `tobj` cannot say which line is wrong and refuses files for the normals that
//! are not used here. The tests hold it against `tobj`.

use glam::DVec3;

use super::soup::{Flaw, MOST, Soup};

/// Reads an OBJ file; a face may refer to vertices further down.
pub fn read(bytes: &[u8]) -> Result<Soup, Flaw> {
    let text = String::from_utf8_lossy(bytes);
    let mut soup = Soup::default();
    for (line, words) in statements(&text, "v") {
        soup.vertices.push(vertex(words).map_err(|wrong| Flaw::at(line, wrong))?);
        if soup.vertices.len() > MOST {
            return Err(Flaw::at(line, format!("more than {MOST} vertices")));
        }
    }
    faces(&text, &mut soup)?;
    if soup.faces.is_empty() {
        return Err(Flaw::new("there is no face in it"));
    }
    Ok(soup)
}

/// The lines that start with `keyword`: number and the words behind it.
fn statements<'t>(text: &'t str, keyword: &'t str) -> impl Iterator<Item = (usize, &'t str)> {
    text.lines().enumerate().filter_map(move |(index, line)| {
        let rest = line.trim_start().strip_prefix(keyword)?;
        rest.starts_with([' ', '\t']).then_some((index + 1, rest))
    })
}

fn vertex(words: &str) -> Result<DVec3, String> {
    let mut words = words.split_ascii_whitespace();
    let mut coordinate = || {
        let word = words.next().ok_or("a vertex needs three coordinates")?;
        let number: f64 = word.parse().map_err(|_| format!("`{word}` is not a number"))?;
        if number.is_finite() { Ok(number) } else { Err(format!("the coordinate `{word}` is not finite")) }
    };
    Ok(DVec3::new(coordinate()?, coordinate()?, coordinate()?))
}

fn faces(text: &str, soup: &mut Soup) -> Result<(), Flaw> {
    let mut vertex_lines = statements(text, "v").map(|(line, _)| line).peekable();
    let (mut before, mut corners) = (0, Vec::new());
    for (line, words) in statements(text, "f") {
        while vertex_lines.next_if(|vertex| *vertex < line).is_some() {
            before += 1;
        }
        corners.clear();
        for word in words.split_ascii_whitespace().take_while(|word| !word.starts_with('#')) {
            corners.push(corner(word, before).map_err(|wrong| Flaw::at(line, wrong))?);
        }
        soup.add_face(&corners, 1).map_err(|wrong| Flaw::at(line, wrong))?;
        if soup.faces.len() > MOST {
            return Err(Flaw::at(line, format!("more than {MOST} triangles")));
        }
    }
    Ok(())
}

/// The vertex of `7`, `7/1`, `7//2` or `-1`, from 0; a negative one counts back from the `before` vertices above it.
fn corner(word: &str, before: i64) -> Result<i64, String> {
    let index = word.split('/').next().unwrap_or_default();
    match index.parse::<i64>() {
        Ok(0) => Err("vertices count from 1: there is no vertex 0".to_owned()),
        Ok(index) if index > 0 => Ok(index - 1),
        Ok(index) if index >= -before => Ok(before + index),
        Ok(index) => Err(format!("vertex {index} is asked for, but only {before} stand above this line")),
        Err(_) => Err(format!("`{word}` is not the number of a vertex")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOURCE: &str = "# a comment\no thing\r\nv 0 0 0\nv 1 0.5 0\n  v\t1 1 -1e-3\nvn 0 0 1\nvt 0 0\nv 0 1 0\n\
                          f 1/1/1 2/1 3//1 4\nf -1 -2 -3\nl 1 2\nv 5 5 5\nf 5 1 2\nusemtl \u{fffd}\n";

    #[test]
    fn it_reads_what_tobj_reads() {
        let options = tobj::LoadOptions { triangulate: true, ignore_lines: true, ..Default::default() };
        let (models, _) =
            tobj::load_obj_buf(&mut SOURCE.as_bytes(), &options, |_| Err(tobj::LoadError::ReadError)).unwrap();
        let theirs: Vec<DVec3> = models
            .iter()
            .flat_map(|model| {
                let at = |index: &u32| DVec3::from_slice(&model.mesh.positions[3 * *index as usize..]);
                model.mesh.indices.iter().map(at).collect::<Vec<_>>()
            })
            .collect();
        let ours = read(SOURCE.as_bytes()).unwrap();
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
            ("v 0 0 0\nf 1 1\n", 2, "needs at least 3"),
            ("v 0 0 0\nf 1 1 a\n", 2, "`a` is not the number"),
        ];
        for (text, line, words) in cases {
            let flaw = read(text.as_bytes()).unwrap_err();
            assert_eq!(flaw.line, Some(line), "{text}");
            assert!(flaw.message.contains(words), "{} lacks {words}", flaw.message);
        }
        assert_eq!(read(b"v 0 0 0\n").unwrap_err().line, None);
        assert_eq!(read(b"v 0 0 0\nf 1 1 1 # once\n").unwrap().faces, [[0; 3]]);
    }
}
