//! What is wrong in a scene: a [`Fault`] while the file is read, a [`SceneError`] once file and text are known.

use std::fmt;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};

/// The outcome of reading a part of a scene.
pub(crate) type Result<T> = std::result::Result<T, Box<Fault>>;

/// One mistake and its place in the scene file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fault {
    /// What is wrong, one sentence without a full stop.
    pub title: String,
    /// Bytes of the scene file that are at fault; `None`: the file itself.
    pub span: Option<Range<usize>>,
    /// What stands there.
    pub label: String,
    /// What was perhaps meant, or what to write.
    pub help: Option<String>,
    /// The line of a mesh file that is at fault.
    pub excerpt: Option<Excerpt>,
}

/// One line of another file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Excerpt {
    /// The file, as the user would name it.
    pub path: String,
    /// Line number, from 1.
    pub line: usize,
    /// The line.
    pub text: String,
    /// What is wrong with it.
    pub label: String,
}

impl Fault {
    /// A mistake at `span`: what is wrong, and what stands there.
    pub fn at(span: Range<usize>, title: impl Into<String>, label: impl Into<String>) -> Box<Self> {
        Box::new(Self { span: Some(span), label: label.into(), ..*Self::of_file(title) })
    }

    /// A mistake of the file as a whole.
    pub fn of_file(title: impl Into<String>) -> Box<Self> {
        Box::new(Self { title: title.into(), span: None, label: String::new(), help: None, excerpt: None })
    }

    /// The same with advice.
    pub fn help(mut self: Box<Self>, help: impl Into<String>) -> Box<Self> {
        self.help = Some(help.into());
        self
    }

    /// The same with advice, if there is any.
    pub fn maybe_help(mut self: Box<Self>, help: Option<String>) -> Box<Self> {
        self.help = help;
        self
    }
}

/// A mistake in a scene or mesh file, or a file that cannot be read: it says where, what, and what was perhaps meant.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneError {
    path: String,
    text: String,
    fault: Box<Fault>,
}

impl SceneError {
    pub(crate) fn new(path: &str, text: String, fault: Box<Fault>) -> Self {
        Self { path: path.to_owned(), text, fault }
    }

    /// The message with the lines that it is about, several lines without a final newline; with terminal colours or
    /// without.
    pub fn render(&self, color: bool) -> String {
        let renderer = if color { Renderer::styled() } else { Renderer::plain() };
        renderer.render(&[self.report()])
    }

    fn report(&self) -> Group<'_> {
        let fault = &self.fault;
        let mut report = Group::with_title(Level::ERROR.primary_title(&fault.title));
        report = match &fault.span {
            Some(span) => report.element(annotated(&self.path, &self.text, 1, span.clone(), &fault.label)),
            None => report.element(Origin::path(&self.path)),
        };
        if let Some(Excerpt { path, line, text, label }) = &fault.excerpt {
            report = report.element(annotated(path, text, *line, 0..text.len(), label));
        }
        match &fault.help {
            Some(help) => report.element(Level::HELP.message(help)),
            None => report,
        }
    }
}

fn annotated<'a>(
    path: &'a str,
    text: &'a str,
    line: usize,
    span: Range<usize>,
    label: &'a str,
) -> Snippet<'a, annotate_snippets::Annotation<'a>> {
    let mark = AnnotationKind::Primary.span(span);
    let mark = if label.is_empty() { mark } else { mark.label(label) };
    Snippet::source(text).path(path).line_start(line).annotation(mark)
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for SceneError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_names_file_line_label_and_help() {
        let text = "[camera]\nfov = 200\n".to_owned();
        let fault = Fault::at(15..18, "`fov` is too large", "200").help("write less");
        let plain = SceneError::new("a.toml", text, fault).render(false);
        for part in ["error: `fov` is too large", "a.toml:2:7", "2 | fov = 200", "^^^ 200", "help: write less"] {
            assert!(plain.contains(part), "{part} is not in\n{plain}");
        }
        assert!(!plain.contains('\x1b'));
    }

    #[test]
    fn colour_is_the_callers_choice() {
        let error = SceneError::new("a.toml", String::new(), Fault::of_file("no such file"));
        assert!(error.render(true).contains('\x1b'));
        assert_eq!(error.to_string(), error.render(false));
    }

    #[test]
    fn a_line_of_a_mesh_is_shown_with_its_own_number() {
        let excerpt = Excerpt { path: "m.obj".into(), line: 42, text: "v 0 0".into(), label: "two numbers".into() };
        let fault = Box::new(Fault { excerpt: Some(excerpt), ..*Fault::at(0..4, "broken", "") });
        let plain = SceneError::new("a.toml", "file = 'm.obj'".into(), fault).render(false);
        assert!(plain.contains("m.obj:42:1") && plain.contains("42 | v 0 0"), "{plain}");
    }
}
