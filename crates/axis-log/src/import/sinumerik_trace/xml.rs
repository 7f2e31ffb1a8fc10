//! The elements of a trace.

use std::borrow::Cow;

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use super::record::{Attributes, Record};
use crate::error::clip;
use crate::read_error::ReadProblem;

/// Elements of a trace that stand in its root.
const SETUP: &str = "traceCaptureSetup";
const DATA: &str = "traceData";
const FRAME: &str = "dataFrame";

/// How far the first of them may stand from the beginning, bytes.
const HEAD: usize = 64 << 10;
/// Elements within each other; a trace has four.
const MOST_DEEP: usize = 32;

/// A root with one of the elements of a trace in it.
pub(super) fn is_it(bytes: &[u8]) -> bool {
    let bytes = bytes.trim_ascii_start();
    if !bytes.starts_with(b"<") {
        return false;
    }
    let head = text(&bytes[..bytes.len().min(HEAD)]);
    let (mut reader, mut deep) = (Reader::from_str(&head), 0_usize);
    loop {
        match reader.read_event() {
            Ok(Event::Start(tag) | Event::Empty(tag))
                if deep == 1 && [SETUP, DATA].contains(&tag.name().0) =>
            {
                return true;
            }
            Ok(Event::Start(_)) => deep += 1,
            Ok(Event::End(_)) => deep = deep.saturating_sub(1),
            Ok(Event::Eof) | Err(_) => return false,
            Ok(_) => {}
        }
    }
}

/// The text: UTF-8, and ISO-8859-1 where it is not. What is declared does not count, since
/// files are declared as the one and are the other; numbers are the same in both.
pub(super) fn text(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
    }
}

/// The recording.
pub(super) fn read(text: &str) -> Result<Record, ReadProblem> {
    let mut reader = Reader::from_str(text);
    let mut document = Document::default();
    loop {
        let event = match reader.read_event() {
            Ok(Event::Eof) => break,
            Ok(event) => event,
            Err(e) => return Err(refused_at(text, reader.error_position(), &e.to_string())),
        };
        document
            .take(event)
            .map_err(|reason| refused_at(text, reader.buffer_position(), &reason))?;
    }
    document
        .end()
        .map_err(|reason| refused_at(text, text.len() as u64, &reason))
}

fn refused_at(text: &str, at: u64, reason: &str) -> ReadProblem {
    let before = usize::try_from(at).unwrap_or(text.len()).min(text.len());
    let before = &text.as_bytes()[..before];
    let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
    ReadProblem::Import {
        format: "a trace of SINUMERIK",
        reason: format!("line {line}: {reason}"),
    }
}

/// What has been read, and the elements that are open.
#[derive(Default)]
struct Document {
    open: Vec<String>,
    record: Record,
    frames: usize,
}

impl Document {
    fn take(&mut self, event: Event<'_>) -> Result<(), String> {
        match event {
            Event::Start(tag) => {
                self.element(&tag)?;
                self.open.push(tag.name().0.to_owned());
                if self.open.len() > MOST_DEEP {
                    return Err(format!("more than {MOST_DEEP} elements within each other"));
                }
            }
            Event::Empty(tag) => self.element(&tag)?,
            Event::End(_) => drop(self.open.pop()),
            // Nothing is expanded, so nothing may be declared.
            Event::DocType(_) => return Err("a document type: a trace has none".to_owned()),
            _ => {}
        }
        Ok(())
    }

    fn element(&mut self, tag: &BytesStart<'_>) -> Result<(), String> {
        match tag.name().0 {
            FRAME if self.is_in(&[DATA]) => {
                self.frames += 1;
                match self.frames {
                    1 => Ok(()),
                    _ => Err("a second dataFrame: keep one, each is a recording".to_owned()),
                }
            }
            "frameHeader" if self.is_in(&[DATA, FRAME]) => self.record.header(attributes(tag)),
            "dataSignal" if self.is_in(&[DATA, FRAME]) => self.record.signal(attributes(tag)),
            "rec" if self.is_in(&[DATA, FRAME]) => self.record.rec(attributes(tag)),
            _ => Ok(()),
        }
    }

    /// Whether these are open within the root, and no others.
    fn is_in(&self, path: &[&str]) -> bool {
        let inside = self.open.iter().skip(1).map(String::as_str);
        inside.eq(path.iter().copied())
    }

    fn end(self) -> Result<Record, String> {
        if let Some(open) = self.open.last() {
            return Err(format!(
                "it ends inside of <{}>, so it was cut: save it again",
                clip(open)
            ));
        }
        if self.frames == 0 {
            return Err("no dataFrame: save the trace with its data, not its setup".to_owned());
        }
        if self.record.signals.is_empty() {
            return Err("the dataFrame has no dataSignal: at least one is needed".to_owned());
        }
        Ok(self.record)
    }
}

/// Names and values, each name as often as it is there: a `rec` looks for doubles itself, in a
/// time that does not rise with the square of their number.
fn attributes<'a>(tag: &'a BytesStart<'_>) -> impl Attributes<'a> {
    let mut attributes = tag.attributes();
    attributes.with_checks(false);
    attributes.map(|attribute| {
        let attribute = attribute.map_err(|e| e.to_string())?;
        let value = attribute.normalized_value(XmlVersion::Implicit1_0);
        Ok((attribute.key.0, value.map_err(|e| e.to_string())?))
    })
}
