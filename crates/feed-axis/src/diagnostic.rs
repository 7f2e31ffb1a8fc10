//! How errors look in the terminal: what is wrong, the line of the file where there is one, why, and what helps.

use std::fmt;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use miette::{Diagnostic, ReportHandler, SpanContents};

/// Draws errors with the compiler's own renderer.
pub struct Compiler {
    /// Whether in colour.
    pub colour: bool,
}

/// Lines shown before and after the marked one.
const CONTEXT: usize = 1;

impl ReportHandler for Compiler {
    fn debug(&self, error: &dyn Diagnostic, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let label = error.labels().and_then(|mut labels| labels.next());
        let place = label.as_ref().and_then(|label| {
            let code = error.source_code()?;
            code.read_span(label.inner(), CONTEXT, CONTEXT).ok()
        });
        let mut group = Level::ERROR.primary_title(error.to_string()).elements(
            causes(error)
                .into_iter()
                .map(|cause| Level::NOTE.message(cause)),
        );
        if let (Some(place), Some(label)) = (&place, &label) {
            group = group.element(snippet(&**place, label));
        }
        if let Some(help) = error.help() {
            group = group.element(Level::HELP.message(help.to_string()));
        }
        let renderer = if self.colour {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        f.write_str(&renderer.render(&[group]))
    }
}

fn snippet<'a, 'text: 'a>(
    place: &'a (dyn SpanContents<'text> + 'a),
    label: &'a miette::LabeledSpan,
) -> Snippet<'a, annotate_snippets::Annotation<'a>> {
    let text = std::str::from_utf8(place.data()).unwrap_or_default();
    let start = label.offset().saturating_sub(place.span().offset());
    let (start, end) = (start.min(text.len()), (start + label.len()).min(text.len()));
    let mark = AnnotationKind::Primary
        .span(start..end)
        .label(label.label());
    let snippet = Snippet::source(text)
        .line_start(place.line() + 1)
        .annotation(mark);
    match place.name() {
        Some(name) => snippet.path(name),
        None => snippet,
    }
}

/// What each error says of the one before it.
fn causes(error: &dyn Diagnostic) -> Vec<String> {
    let mut causes = Vec::new();
    let mut cause = error.source();
    while let Some(error) = cause {
        causes.push(error.to_string());
        cause = error.source();
    }
    causes
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Shown<'a>(&'a miette::Report);

    impl fmt::Display for Shown<'_> {
        fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            Compiler { colour: false }.debug(self.0.as_ref(), f)
        }
    }

    #[test]
    fn file_line_mark_and_cause_are_shown() {
        let file = include_str!("../../../data/axes/liu2025.toml");
        let bad = file.replace("table_mass_kg = 515", "table_mass_kg = -515");
        let line = 1 + bad.lines().position(|l| l.contains("-515")).unwrap();
        let refused = axis_sim::Axis::parse("axis.toml", &bad).unwrap_err();
        let report = miette::Report::new(refused).wrap_err("this is no axis");
        let shown = Shown(&report).to_string();
        let expected = [
            "error: this is no axis",
            &format!("axis.toml:{line}:"),
            &format!("{line} | table_mass_kg = -515"),
            "^^^^ here",
            "valid: a number from 0.001 to 1000000, in kg",
        ];
        for part in expected {
            assert!(shown.contains(part), "no \"{part}\" in:\n{shown}");
        }
        assert!(!shown.contains("[friction]"), "{shown}");
    }

    #[test]
    fn help_is_shown() {
        let refused = axis_sim::Axis::read("no such file".as_ref()).unwrap_err();
        let shown = Shown(&miette::Report::new(refused)).to_string();
        assert!(shown.contains("help: give a readable TOML file"), "{shown}");
    }
}
