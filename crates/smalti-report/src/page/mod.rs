//! The page: one HTML file with all that it shows, which asks nobody for anything.

mod chart;
mod command;
mod compare;
mod data;
mod head;
mod knobs;
mod pictures;
mod scheme;
mod table;
mod table_one;
mod tiles;

use maud::{DOCTYPE, Markup, PreEscaped, html};

pub use pictures::{ArmPictures, Pictures};

use crate::findings::findings;
use crate::record::Study;
use crate::verdict::comparisons;

const STYLE: &str = include_str!("page.css");

/// Each looks for its part of the page.
const SCRIPTS: [&str; 4] =
    [include_str!("chart.js"), include_str!("sort.js"), include_str!("compare.js"), include_str!("tiles.js")];

/// Nothing may be loaded; what stands in the page may run.
const POLICY: &str = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'; \
                      base-uri 'none'; form-action 'none'";

/// The page of a study.
pub fn page(study: &Study, pictures: &Pictures) -> String {
    let findings = findings(study);
    let comparisons = comparisons(study);
    let title = format!("{}: speed against accuracy", study.scene);
    let content = html! {
        (head::head(study, &findings))
        (chart::section(study, &findings))
        (knobs::section(study, &comparisons))
        (table::section(study, &findings))
        (table_one::section(study, &findings))
        (compare::section(study, &findings, pictures))
        (tiles::section(study))
        (data::section(study))
    };
    document(&title, &content).into_string()
}

fn document(title: &str, content: &Markup) -> Markup {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta name="generator" content={ "smalti " (env!("CARGO_PKG_VERSION")) };
                title { (title) }
                // An icon of no bytes, or the browser would ask for one.
                link rel="icon" href="data:,";
                style { (PreEscaped(scheme::colours())) (PreEscaped(STYLE)) }
            }
            body {
                main { (content) }
                @for script in SCRIPTS { script { (PreEscaped(script)) } }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn the_page_asks_nobody() {
        let text = page(&fixture::sweep(), &Pictures::default());
        let named = text.matches("http").count();
        let known = text.matches("http-equiv").count() + text.matches("http://www.w3.org/2000/svg").count();
        assert_eq!(named, known);
        for reach in ["@import", "url(", " src=\"/", "<iframe", "<object"] {
            assert!(!text.contains(reach), "{reach}");
        }
    }

    #[test]
    fn what_a_study_says_cannot_become_markup() {
        let mut study = fixture::sweep();
        let evil = "</script><script>alert('1')</script>\"'&";
        for text in [&mut study.scene, &mut study.command, &mut study.preset, &mut study.machine.system] {
            *text = evil.into();
        }
        let arm = &mut study.arms[1];
        (arm.label, arm.group, arm.command) = (evil.into(), evil.into(), evil.into());
        arm.biases = vec![evil.into()];
        arm.knobs.insert(evil.into(), evil.into());
        study.references[0].file = evil.into();
        let text = page(&study, &Pictures::default());
        assert!(text.contains("&lt;/script&gt;") && !text.contains("<script>alert"));
        assert_eq!(text.matches("</script>").count(), SCRIPTS.len());
    }

    #[test]
    fn a_study_that_has_just_begun_has_a_page() {
        let mut study = fixture::sweep();
        study.runs.clear();
        assert!(page(&study, &Pictures::default()).contains("No run is finished yet"));
        assert!(page(&fixture::study(), &Pictures::default()).contains("No run is finished yet"));
    }
}
