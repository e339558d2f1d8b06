//! Commands to copy.

use maud::{Markup, html};

/// A command that breaks between its words only, for a line may otherwise end within `--spp`.
pub(super) fn command(text: &str) -> Markup {
    html! {
        code.command {
            @for (index, word) in text.split(' ').enumerate() {
                @if index > 0 { " " }
                span { (word) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_kept_as_they_are() {
        let drawn = command("smalti render 'a  b'").into_string();
        let text = drawn.replace("<span>", "").replace("</span>", "");
        assert_eq!(text, "<code class=\"command\">smalti render 'a  b'</code>");
    }
}
