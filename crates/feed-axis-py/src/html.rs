//! Results as a notebook shows them, and as pages.

use std::path::PathBuf;

use pyo3::prelude::*;

use crate::errors::of_file;

/// The text of a page, written to a file too where one is named.
pub(crate) fn page_to(py: Python<'_>, text: String, path: Option<PathBuf>) -> PyResult<String> {
    if let Some(path) = path {
        std::fs::write(&path, &text).map_err(|error| of_file(py, &error, &path))?;
    }
    Ok(text)
}

/// A line of words above a table, as HTML.
pub(crate) fn table(words: &str, heads: &[&str], rows: &[Vec<String>]) -> String {
    let words = format!("<p>{}</p>", escaped(words));
    if rows.is_empty() {
        return words;
    }
    let head = line("th", heads.iter().copied());
    let rows = rows
        .iter()
        .map(|row| line("td", row.iter().map(String::as_str)));
    format!("{words}<table>{head}{}</table>", rows.collect::<String>())
}

fn line<'a>(tag: &str, cells: impl Iterator<Item = &'a str>) -> String {
    let cells = cells.map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell)));
    format!("<tr>{}</tr>", cells.collect::<String>())
}

fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('>', "&gt;")
}
