//! The page and the figures as files.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use console::Term;
use smalti_report::Study;

use super::pictures;
use crate::exit::Failure;

/// The folder of figures, beside the page.
const FIGURES: &str = "figures";

/// What was written.
#[derive(Debug)]
pub struct Written {
    /// The page.
    pub page: PathBuf,
    /// The figures.
    pub figures: Vec<PathBuf>,
    /// What the page goes without, in words.
    pub missing: Vec<String>,
}

/// Columns of the short version where no terminal says otherwise, and at most.
const WIDTH: usize = 100;

impl Written {
    /// The short version for the terminal, and where the long one is.
    pub fn describe(&self, study: &Study) -> String {
        let columns = Term::stdout().size_checked().map_or(WIDTH, |(_, columns)| usize::from(columns));
        let words = smalti_report::words(study, columns.min(WIDTH));
        let figures = self.page.with_file_name(FIGURES);
        format!("{words}\n{}, figures in {}\n", self.page.display(), figures.display())
    }
}

/// Writes the page of the study in `folder` to `page` and its figures beside it.
///
/// # Errors
/// A place that cannot be written, found before anything is; or what the system answers later.
pub fn write(study: &Study, folder: &Path, page: &Path) -> Result<Written, Failure> {
    check(page)?;
    let (pictures, missing) = pictures::gather(study, folder);
    let beside = page.with_file_name(FIGURES);
    let drawn = figures(study);
    fs::create_dir_all(&beside).map_err(|error| Failure::output(format!("{}: {error}", beside.display())))?;
    let mut written = Vec::new();
    for (name, figure) in drawn {
        let path = beside.join(name);
        replace(&path, &figure)?;
        written.push(path);
    }
    replace(page, &smalti_report::page(study, &pictures))?;
    Ok(Written { page: page.into(), figures: written, missing })
}

/// The page must be able to lie there, and a folder beside it.
fn check(page: &Path) -> Result<(), Failure> {
    let extension = page.extension().map(|extension| extension.to_ascii_lowercase());
    if !extension.is_some_and(|extension| extension == "html" || extension == "htm") {
        return Err(Failure::user(format!("{}: the report is a page; let its name end in .html", page.display())));
    }
    smalti_image::check_place(page).map_err(Failure::user)?;
    let beside = page.with_file_name(FIGURES);
    match beside.exists() && !beside.is_dir() {
        true => Err(Failure::user(format!("{}: is there already and is not a folder", beside.display()))),
        false => Ok(()),
    }
}

/// Figures, and the report's Table 1 as Markdown, by the names of their files.
fn figures(study: &Study) -> Vec<(String, String)> {
    let mut figures = vec![
        ("error-time.svg".to_owned(), smalti_report::figure_error_time(study)),
        ("relmse-time.svg".into(), smalti_report::figure_relmse_time(study)),
    ];
    figures.extend(smalti_report::figure_knobs(study).map(|figure| ("knobs.svg".into(), figure)));
    figures.extend(smalti_report::table_one_markdown(study).map(|table| ("table-1.md".into(), table)));
    let tiles = (0..study.arms.len())
        .filter_map(|arm| Some((tiles_name(&study.arms[arm].name, arm), smalti_report::figure_tiles(study, arm)?)));
    figures.extend(tiles);
    figures
}

/// A name from a file may hold anything: only what is harmless of it goes into a path, and a number makes it unique.
fn tiles_name(arm: &str, number: usize) -> String {
    let harmless: String = arm.chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect();
    format!("tiles-{number}-{harmless}.svg")
}

fn replace(path: &Path, text: &str) -> Result<(), Failure> {
    smalti_image::replace(path, |file| file.write_all(text.as_bytes()))
        .map_err(|error| Failure::output(format!("{}: cannot be written: {error}", path.display())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_in_their_folder() {
        assert_eq!(tiles_name("../../etc/a b", 3), "tiles-3-------etc-a-b.svg");
    }

    #[test]
    fn only_pages_are_written() {
        let message = |page: &str| check(Path::new(page)).map_err(|failure| failure.message);
        assert_eq!(message("report.HTML"), Ok(()));
        assert!(message("report").unwrap_err().contains(".html") && message("a.svg").is_err());
    }
}
