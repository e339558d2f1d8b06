//! The report's Table 1 beside ours.

use maud::{Markup, html};

use crate::findings::Finding;
use crate::record::Study;
use crate::table_one::{HEADINGS, beside, cells};

/// Columns from here on are figures.
const FIGURES: usize = 5;

pub(super) fn section(study: &Study, findings: &[Finding]) -> Markup {
    let rows = beside(study, findings);
    if study.preset != "report" || rows.iter().all(|ours| ours.measured.is_none()) {
        return html! {};
    }
    html! {
        section #table-1 {
            h2 { "Table 1, then and now" }
            div.scroll tabindex="0" role="region" aria-label="Table 1" {
                table {
                    thead {
                        tr {
                            @for (index, heading) in HEADINGS.iter().enumerate() {
                                th scope="col" class=[(index >= FIGURES).then_some("figure")] { (heading) }
                            }
                        }
                    }
                    tbody {
                        @for ours in &rows {
                            tr {
                                @for (index, cell) in cells(ours).into_iter().enumerate() {
                                    @if index == 0 { th scope="row" { (cell) } }
                                    @else { td class=[(index >= FIGURES).then_some("figure")] { (cell) } }
                                }
                            }
                        }
                    }
                }
            }
            p.note {
                "The report: Larsson and Voith, Monte Carlo Ray Tracing and Photon Mapping, Linköping University 2023; one thread of an "
                "AMD Ryzen 7 6800H. smalti: this machine, all of its threads; medians, and the 95 % interval of the geometric "
                "mean (of two repetitions the two). The report states no error."
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::findings;
    use crate::fixture;

    #[test]
    fn the_table_belongs_to_the_preset_report() {
        let mut study = fixture::sweep();
        study.arms[0] = fixture::arm("path", &[("integrator", "path"), ("spp", "5"), ("shadow-rays", "10")]);
        assert_eq!(section(&study, &findings(&study)).into_string(), "");
        study.preset = "report".into();
        let text = section(&study, &findings(&study)).into_string();
        assert!(text.contains("1601.34") && text.matches("<tr>").count() == 7, "{text}");
    }
}
