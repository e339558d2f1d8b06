//! OBJ: the lines `v` and `f`; all others (normals, texture coordinates, groups, materials) are counted and not used.
//!
//! Our own reader, because the crate `tobj` cannot say which line is wrong and refuses files for the normals that
//! are not used here. The tests hold it against `tobj`.

use std::borrow::Cow;
use std::collections::BTreeSet;

use glam::DVec3;

use super::soup::{Flaw, MOST, Soup};
use super::tally::{Content, Tally};
use super::text::{Lines, parse, shown, without_mark, words};

/// Reads an OBJ file; a face may refer to vertices further down.
pub fn read(bytes: &[u8]) -> Result<Soup, Flaw> {
    let bytes = without_mark(bytes);
    let mut soup = Soup::default();
    let mut names = BTreeSet::new();
    for Statement { line, keyword, rest } in statements(bytes) {
        match keyword {
            b"v" => add_vertex(&mut soup, &rest).map_err(|wrong| Flaw::at(line, wrong))?,
            b"f" | b"fo" => {}
            b"usemtl" => drop(names.insert(rest.trim_ascii().to_vec())),
            _ => soup.tally.add(content(keyword), 1),
        }
    }
    soup.tally.add(Content::Materials, names.len());
    faces(bytes, &mut soup)?;
    if soup.faces.is_empty() {
        return Err(Flaw::new(without_faces(&soup.tally)));
    }
    Ok(soup)
}

/// A statement: its first line, its first word, and everything behind that.
struct Statement<'t> {
    line: usize,
    keyword: &'t [u8],
    rest: Cow<'t, [u8]>,
}

/// The statements that are no comments. A line that ends in `\` goes on in the next.
fn statements(bytes: &[u8]) -> impl Iterator<Item = Statement<'_>> {
    let mut lines = Lines::new(bytes, 1);
    std::iter::from_fn(move || {
        loop {
            let (line, text) = lines.next()?;
            let text = text.trim_ascii_start();
            let length = text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len());
            let (keyword, rest) = text.split_at(length);
            if !keyword.is_empty() && !keyword.starts_with(b"#") {
                return Some(Statement { line, keyword, rest: joined(rest, &mut lines) });
            }
        }
    })
}

/// A line with those that it goes on in. A backslash in a comment is part of the comment.
fn joined<'t>(rest: &'t [u8], lines: &mut Lines<'t>) -> Cow<'t, [u8]> {
    let goes_on = |line: &'t [u8]| line.trim_ascii_end().strip_suffix(b"\\").filter(|line| !line.contains(&b'#'));
    let Some(start) = goes_on(rest) else { return Cow::Borrowed(rest) };
    let mut whole = start.to_vec();
    for (_, line) in lines {
        whole.push(b' ');
        let start = goes_on(line);
        whole.extend(start.unwrap_or(line));
        if start.is_none() {
            break;
        }
    }
    Cow::Owned(whole)
}

/// The words behind a keyword, up to a comment.
fn arguments(rest: &[u8]) -> impl Iterator<Item = &[u8]> {
    words(rest).take_while(|word| !word.starts_with(b"#"))
}

fn add_vertex(soup: &mut Soup, rest: &[u8]) -> Result<(), String> {
    if soup.vertices.len() == MOST {
        return Err(format!("more than {MOST} vertices"));
    }
    let mut words = arguments(rest);
    let mut coordinate = || coordinate(words.next().ok_or("a vertex needs three coordinates")?);
    soup.vertices.push(DVec3::new(coordinate()?, coordinate()?, coordinate()?));
    // Behind the coordinates stands a weight, or red, green and blue.
    if words.nth(2).is_some() {
        soup.tally.add(Content::Colours, 1);
    }
    Ok(())
}

fn coordinate(word: &[u8]) -> Result<f64, String> {
    let number: f64 = parse(word).ok_or_else(|| format!("`{}` is not a number", shown(word)))?;
    if number.is_finite() { Ok(number) } else { Err(format!("the coordinate `{}` is not finite", shown(word))) }
}

fn faces(bytes: &[u8], soup: &mut Soup) -> Result<(), Flaw> {
    let (mut before, mut corners) = (0, Vec::new());
    for Statement { line, keyword, rest } in statements(bytes) {
        match keyword {
            b"v" => before += 1,
            b"f" | b"fo" => {
                corners.clear();
                for word in arguments(&rest) {
                    corners.push(corner(word, before).map_err(|wrong| Flaw::at(line, wrong))?);
                }
                soup.add_face(&corners, 1).map_err(|wrong| Flaw::at(line, wrong))?;
            }
            _ => {}
        }
        if soup.faces.len() > MOST {
            return Err(Flaw::at(line, format!("more than {MOST} triangles")));
        }
    }
    Ok(())
}

/// The vertex of `7`, `7/1`, `7//2` or `-1`, from 0; a negative one counts back from the `before` vertices above it.
fn corner(word: &[u8], before: i64) -> Result<i64, String> {
    let index = word.split(|byte| *byte == b'/').next().unwrap_or_default();
    match parse::<i64>(index) {
        Some(0) => Err("vertices count from 1: there is no vertex 0".to_owned()),
        Some(index) if index > 0 => Ok(index - 1),
        Some(index) if index >= -before => Ok(before + index),
        Some(index) => Err(format!("vertex {index} is asked for, but only {before} stand above this line")),
        None => Err(format!("`{}` is not the number of a vertex", shown(word))),
    }
}

/// What a statement other than `v`, `f` and `usemtl` holds.
fn content(keyword: &[u8]) -> Content {
    match keyword {
        b"vn" => Content::Normals,
        b"vt" => Content::TextureCoordinates,
        b"g" | b"o" => Content::Groups,
        b"l" => Content::Lines,
        b"p" => Content::Points,
        b"vp" | b"cstype" | b"deg" | b"bmat" | b"step" | b"curv" | b"curv2" | b"surf" | b"parm" | b"trim" | b"hole"
        | b"scrv" | b"sp" | b"end" | b"con" => Content::Curves,
        _ => Content::Statements,
    }
}

fn without_faces(tally: &Tally) -> String {
    match (tally.short, tally.unused()) {
        (0, unused) if unused.is_empty() => "there is no face in it".to_owned(),
        (0, unused) => format!("there is no face in it, only {unused}"),
        _ => "none of its faces has three different corners".to_owned(),
    }
}

#[cfg(test)]
mod tests;
