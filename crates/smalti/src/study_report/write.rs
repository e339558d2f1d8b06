//! The page and the figures as files.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

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
        let path = beside.join(name).with_extension("svg");
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

/// Figures by the names of their files.
fn figures(study: &Study) -> Vec<(String, String)> {
    let mut figures = vec![
        ("error-time".to_owned(), smalti_report::figure_error_time(study)),
        ("relmse-time".into(), smalti_report::figure_relmse_time(study)),
    ];
    figures.extend(smalti_report::figure_knobs(study).map(|figure| ("knobs".into(), figure)));
    let tiles = study.arms.iter().enumerate().filter_map(|(index, arm)| {
        // A name from a file may hold anything: only its number and what is harmless go into a path.
        let name: String = arm.name.chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect();
        Some((format!("tiles-{index}-{name}"), smalti_report::figure_tiles(study, index)?))
    });
    figures.extend(tiles);
    figures
}

fn replace(path: &Path, text: &str) -> Result<(), Failure> {
    smalti_image::replace(path, |file| file.write_all(text.as_bytes()))
        .map_err(|error| Failure::output(format!("{}: cannot be written: {error}", path.display())))
}
