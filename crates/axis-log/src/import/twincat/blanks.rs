//! The line of names where blanks stand between fields, which names may have too.
//!
//! How many fields there are the rows tell, and how they belong together a line of the header of
//! which no field has a blank, as that of the symbols.

use super::keys::KEYS;
use super::line::NAME;
use super::number::value;

/// The names, as many as the rows have fields; `None` if a name cannot be told from the next.
/// `below` are the lines below that of the names.
pub(super) fn names<'a>(line: &'a str, below: &[&'a str]) -> Option<Vec<&'a str>> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let width = below.iter().find_map(|line| row(line))?;
    if words.len() == width {
        return Some(words);
    }
    let groups = words.iter().filter(|word| **word == NAME).count();
    let alone = (width == 2 * groups).then(|| vec![1; groups]);
    let sizes = alone.or_else(|| below.iter().find_map(|line| sizes(line, width)))?;
    let symbols = below.iter().find(|line| line.starts_with("SymbolName "));
    let mut symbols = symbols.map_or("", |line| line).split_whitespace();
    let mut names = Vec::with_capacity(width);
    let mut rest = line;
    for size in sizes {
        let inside = rest.trim_start().strip_prefix(NAME)?;
        let end = next_group(inside);
        let (own, after) = inside.split_at(end);
        let own = own.trim();
        let words: Vec<&str> = own.split_whitespace().collect();
        names.push(NAME);
        symbols.next();
        let symbols: Vec<&str> = symbols.by_ref().take(size).collect();
        match size {
            1 => names.push(own),
            _ if words.len() == size => names.extend(words),
            // Their names cannot be told apart, what the program calls them can.
            _ if symbols.len() == size => names.extend(symbols),
            _ => return None,
        }
        rest = after;
    }
    (names.len() == width).then_some(names)
}

/// Where the next key of a group stands, or the end.
fn next_group(inside: &str) -> usize {
    let key = format!(" {NAME} ");
    inside.find(&key).map_or(inside.len(), |at| at + 1)
}

/// How many fields a row of values has.
fn row(line: &str) -> Option<usize> {
    let fields: Vec<&str> = line.trim().split(' ').collect();
    let is_row = fields.len() > 1 && fields.iter().all(|field| value(field).is_some());
    is_row.then_some(fields.len())
}

/// Channels of each group, by a line of the header that has a field for each.
fn sizes(line: &str, width: usize) -> Option<Vec<usize>> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let key = *words.first()?;
    if words.len() != width || !KEYS.contains(&key) {
        return None;
    }
    let groups = words.split(|word| *word == key).skip(1);
    Some(groups.map(<[&str]>::len).collect())
}
