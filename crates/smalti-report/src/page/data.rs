//! The figures themselves, to take away.

use maud::{Markup, html};

use super::pictures::data;
use crate::record::Study;

pub(super) fn section(study: &Study) -> Markup {
    // A study is made of numbers, strings and lists of them: there is nothing that JSON cannot hold.
    let json = serde_json::to_string_pretty(study).unwrap_or_default();
    html! {
        section #data {
            h2 { "The data" }
            p {
                a.button download="study.json" href=(data("application/json", json.as_bytes())) { "Save study.json" }
                " holds every run with its seed, time, errors and hash; it stands in this page. "
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use base64::Engine;
    use base64::prelude::BASE64_STANDARD;

    use super::*;
    use crate::fixture;

    #[test]
    fn the_page_holds_the_study() {
        let study = fixture::sweep();
        let text = section(&study).into_string();
        let (_, rest) = text.split_once("base64,").unwrap();
        let (encoded, _) = rest.split_once('"').unwrap();
        let json = BASE64_STANDARD.decode(encoded).unwrap();
        assert_eq!(serde_json::from_slice::<Study>(&json).unwrap(), study);
    }
}
