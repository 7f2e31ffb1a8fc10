//! Results as a notebook shows them.

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
