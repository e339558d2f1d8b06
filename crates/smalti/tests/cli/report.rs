//! `report`: a study's page, figures and short version.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use crate::room::{json, run, stderr, stdout};

/// A folder with a study of nine arms in it as `study`.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    copy(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/study"), &folder.path().join("study"));
    folder
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        let target = to.join(entry.file_name());
        match entry.file_type().unwrap().is_dir() {
            true => copy(&entry.path(), &target),
            false => drop(fs::copy(entry.path(), target).unwrap()),
        }
    }
}

/// Runs what is a mistake; the message must have every one of `parts`, and nothing is written.
fn refuses(folder: &TempDir, line: &str, parts: &[&str]) {
    let names = |path: &Path| fs::read_dir(path).map_or(0, Iterator::count);
    let before = [folder.path().to_owned(), folder.path().join("study")].map(|path| (names(&path), path));
    let output = run(folder, line);
    assert_eq!(output.status.code(), Some(2), "{line}: {}", stderr(&output));
    for part in parts {
        assert!(stderr(&output).contains(part), "{line}: '{part}' is not in\n{}", stderr(&output));
    }
    for (count, path) in before {
        assert_eq!(names(&path), count, "{line} left a file");
    }
}

#[test]
fn a_study_becomes_a_page_figures_and_a_table() {
    let folder = folder();
    let output = run(&folder, "report study");
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    let text = stdout(&output);
    for part in ["auto, 32 spp, 1 shadow ray", "1 shadow ray instead of 10", "auto instead of path", "biased"] {
        assert!(text.contains(part), "'{part}' is not in\n{text}");
    }
    let page = fs::read_to_string(folder.path().join("study/report.html")).unwrap();
    // Nine arms and the reference, nine differences.
    assert_eq!(page.matches("src=\"data:image/png").count(), 19);
    assert!(!folder.path().join("study/figures/table-1.md").exists());
    for figure in ["error-time", "relmse-time", "knobs", "tiles-0-path-4spp-1"] {
        let text = fs::read_to_string(folder.path().join(format!("study/figures/{figure}.svg"))).unwrap();
        assert!(text.starts_with("<svg xmlns=") && text.ends_with("</svg>"), "{figure}");
    }
}

#[test]
fn the_reports_table_is_written_beside_ours() {
    let folder = folder();
    let path = folder.path().join("study/study.json");
    // Four samples and one shadow ray become the settings of the report's comparison image.
    let text = fs::read_to_string(&path).unwrap().replacen(
        r#""spp":"4","shadow-rays":"1""#,
        r#""spp":"5","shadow-rays":"10""#,
        1,
    );
    fs::write(&path, text.replacen(r#""preset":"knobs""#, r#""preset":"report""#, 1)).unwrap();
    assert_eq!(run(&folder, "report study -q").status.code(), Some(0));
    let table = fs::read_to_string(folder.path().join("study/figures/table-1.md")).unwrap();
    assert!(table.contains("| Comparison image | 800 × 800 (ours 48 × 36) | 5 | 10 | yes | 115.46 | 0.0"), "{table}");
    assert!(fs::read_to_string(folder.path().join("study/report.html")).unwrap().contains("Table 1, then and now"));
}

#[test]
fn the_same_study_gives_the_same_bytes() {
    let folder = folder();
    run(&folder, "report study -q -o a.html");
    run(&folder, "report study -q -o b.html");
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(read("a.html") == read("b.html"));
    assert!(folder.path().join("figures/knobs.svg").is_file() && !folder.path().join("study/report.html").exists());
}

#[test]
fn scripts_get_findings_and_verdicts() {
    let report = json(&folder(), "report study --json");
    assert_eq!((report["arms"].as_array().unwrap().len(), &report["baseline"]), (9, &"path-32spp-10".into()));
    assert_eq!(report["arms"][0]["seconds"]["count"], 3);
    let verdicts = report["verdicts"].as_array().unwrap();
    let of = |arm: &str| verdicts.iter().find(|verdict| verdict["arm_name"] == arm).unwrap();
    assert_eq!(of("auto-32spp-10")["verdict"], "worth");
    assert_eq!(of("path-32spp-1")["knob"], "shadow-rays");
}

#[test]
fn what_is_missing_is_told_and_left_out() {
    let folder = folder();
    fs::remove_file(folder.path().join("study/images/path-4spp-1.png")).unwrap();
    fs::write(folder.path().join("study/images/path-4spp-10.png"), "no picture").unwrap();
    fs::write(folder.path().join("study/images/path-32spp-1.pfm"), "no image").unwrap();
    let output = run(&folder, "report study -q");
    assert_eq!(output.status.code(), Some(0));
    let told = stderr(&output);
    for part in ["path-4spp-1.png: cannot be read", "path-4spp-10.png: is no PNG file", "path-32spp-1.pfm: is no valid"]
    {
        assert!(told.contains(part), "'{part}' is not in\n{told}");
    }
    let page = fs::read_to_string(folder.path().join("study/report.html")).unwrap();
    // Two pictures less with their differences, one more difference less.
    assert_eq!(page.matches("src=\"data:image/png").count(), 14);
}

#[test]
fn folders_without_a_study() {
    let folder = folder();
    refuses(&folder, "report nowhere", &["nowhere: there is no such folder"]);
    refuses(&folder, "report .", &["there is no study in this folder (study.json is missing)"]);
    refuses(&folder, "report study/study.json", &["is a file", "name the folder"]);
}

#[test]
fn studies_that_are_damaged_or_foreign() {
    let folder = folder();
    let path = folder.path().join("study/study.json");
    let text = fs::read_to_string(&path).unwrap();
    for (content, parts) in [
        (text[..text.len() / 2].to_owned(), ["study.json: is damaged", "EOF"]),
        (text.replacen("\"format\":1", "\"format\":2", 1), ["is of format 2", "reads format 1"]),
        (text.replacen("\"baseline\":3", "\"baseline\":30", 1), ["is damaged", "arm 30 of 9"]),
        ("[1, 2]".into(), ["is no study of smalti", "format"]),
        ("Dear reader".into(), ["is damaged", "line 1"]),
    ] {
        assert_ne!(content, text);
        fs::write(&path, content).unwrap();
        refuses(&folder, "report study", &parts);
    }
}

#[test]
fn places_that_cannot_be_written() {
    let folder = folder();
    refuses(&folder, "report study -o report.pdf", &["report.pdf", ".html"]);
    refuses(&folder, "report study -o no/report.html", &["no/report.html", "there is no folder"]);
    fs::write(folder.path().join("figures"), "").unwrap();
    refuses(&folder, "report study -o report.html", &["figures: is there already and is not a folder"]);
}
