//! What can be wrong with an axis file, said with file, line and field.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use miette::{Diagnostic, NamedSource, SourceSpan};
use thiserror::Error;

use super::slips::files_near;
use super::syntax::toml_hint;

/// The text of an axis file and where it came from.
#[derive(Clone, Debug)]
pub(super) struct Source {
    pub(super) name: String,
    pub(super) content: String,
}

impl Source {
    pub(super) fn of(name: &str, content: &str) -> Self {
        Self {
            name: name.to_owned(),
            content: content.to_owned(),
        }
    }

    pub(super) fn text(&self, span: Range<usize>) -> &str {
        self.content.get(span).unwrap_or_default()
    }

    fn line(&self, offset: usize) -> usize {
        let before = self.content.get(..offset).unwrap_or(&self.content);
        1 + before.matches('\n').count()
    }

    fn named(&self) -> NamedSource<String> {
        NamedSource::new(&self.name, self.content.clone()).with_language("TOML")
    }
}

/// Why an axis file was refused.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum AxisFileError {
    /// The file could not be read.
    #[error("cannot read the axis file {path}: {reason}")]
    #[diagnostic(help("{meant}"))]
    Read {
        /// Path that was tried.
        path: PathBuf,
        /// What to give instead.
        meant: String,
        /// The system's reason.
        reason: std::io::Error,
    },
    /// The text is not TOML.
    #[error("{file}:{line}: not TOML: {what}")]
    Syntax {
        /// Name of the file.
        file: Box<str>,
        /// Line, from 1.
        line: usize,
        /// What the parser says.
        what: String,
        /// The text, for display.
        #[source_code]
        source_code: Arc<NamedSource<String>>,
        /// Where it is.
        #[label("here")]
        span: SourceSpan,
    },
    /// A field is missing, unknown, of the wrong type or out of range.
    #[error("{file}:{line}: `{field}` {what}; valid: {valid}")]
    Field {
        /// Name of the file.
        file: Box<str>,
        /// Line, from 1.
        line: usize,
        /// Path of the field.
        field: String,
        /// What is wrong with it.
        what: String,
        /// What would be valid.
        valid: String,
        /// The text, for display.
        #[source_code]
        source_code: Arc<NamedSource<String>>,
        /// Where it is.
        #[label("here")]
        span: SourceSpan,
    },
}

impl AxisFileError {
    pub(super) fn read(path: &Path, reason: std::io::Error) -> Self {
        let near = match reason.kind() {
            std::io::ErrorKind::NotFound => files_near(path),
            _ => Vec::new(),
        };
        Self::Read {
            path: path.into(),
            meant: match near.is_empty() {
                true => "give a readable TOML file, such as data/axes/liu2025.toml".to_owned(),
                false => format!("did you mean {}?", near.join(" or ")),
            },
            reason,
        }
    }

    pub(super) fn field(
        source: &Source,
        span: Range<usize>,
        field: String,
        what: String,
        valid: String,
    ) -> Self {
        Self::Field {
            file: source.name.as_str().into(),
            line: source.line(span.start),
            field,
            what,
            valid,
            source_code: Arc::new(source.named()),
            span: span.into(),
        }
    }

    pub(super) fn syntax(source: &Source, error: &toml::de::Error) -> Self {
        let span = error.span().unwrap_or(0..0);
        let what = match toml_hint(&source.content, span.start) {
            Some(hint) => format!("{}; {hint}", error.message()),
            None => error.message().to_owned(),
        };
        Self::Syntax {
            file: source.name.as_str().into(),
            line: source.line(span.start),
            what,
            source_code: Arc::new(source.named()),
            span: span.into(),
        }
    }
}
