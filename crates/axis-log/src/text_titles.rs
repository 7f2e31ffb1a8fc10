//! Lines that programs and their users write above the names of a table: a title, the axis, the
//! device.
//!
//! A table is known by its rows. The line above the first of them that holds a name for each of
//! their fields has the names, and lines before that, with less in them, are no part of it.

use std::borrow::Cow;

use crate::text_lines::{SEPARATORS, filled, is_comment, is_number, names_between_blanks};
use crate::unit_table::is_unit;

/// Most lines above the names.
const MOST: usize = 100;
/// Rows that must look alike below the names; of a shorter table, all.
const ROWS: usize = 3;

/// The text with a comment for each line above the names, so that others keep their numbers, and
/// those lines. `said` is the separator, where the text names it.
pub(crate) fn without_titles(text: Cow<'_, str>, said: Option<u8>) -> (Cow<'_, str>, Vec<String>) {
    let lines = filled(&text).filter(|line| !is_comment(line));
    let lines: Vec<&str> = lines.take(MOST + 2 + ROWS).collect();
    let [a, b, c] = SEPARATORS.map(Some);
    let told = [said];
    let separators: &[Option<u8>] = match said {
        Some(_) => &told,
        None => &[a, b, c, None],
    };
    let mut separators = separators.iter();
    let Some(many) = separators.find_map(|separator| titles(&lines, *separator)) else {
        return (text, Vec::new());
    };
    let titles: Vec<String> = lines[..many].iter().map(|l| l.trim().to_owned()).collect();
    let starts = lines[..many].iter();
    let starts = starts.map(|line| line.as_ptr() as usize - text.as_ptr() as usize);
    let starts: Vec<usize> = starts.collect();
    let mut text = text.into_owned();
    // From the end, so that the others stay where they are.
    for start in starts.into_iter().rev() {
        text.insert(start, '#');
    }
    (Cow::Owned(text), titles)
}

/// How many of these lines are above the names; `None` if there are none, or no table is known.
/// A separator of none is any number of blanks.
fn titles(lines: &[&str], separator: Option<u8>) -> Option<usize> {
    let cells = |line: &&str| cells(line, separator);
    let rows: Vec<Vec<String>> = lines.iter().map(cells).collect();
    let are_rows = |k: &usize| rows[*k..].iter().take(ROWS).all(|row| is_row(row));
    let first = (0..rows.len()).find(are_rows)?;
    let (below, above) = (rows[first..].iter().take(ROWS), &rows[..first]);
    let wide = below.map(Vec::len).max()?;
    let is_free = |k: usize| !above[k].iter().any(|cell| is_number(cell));
    let names = |k: usize| match separator {
        Some(_) => above[k].len() == wide && above[k].iter().all(|name| !name.is_empty()),
        None => names_between_blanks(lines[k], wide).is_some(),
    };
    let last = first.checked_sub(1)?;
    let header = match last.checked_sub(1) {
        Some(before) if are_units(&above[last], wide) && names(before) => before,
        _ => last,
    };
    let is_title = |k: usize| match separator {
        Some(_) => above[k].iter().filter(|cell| !cell.is_empty()).count() < wide,
        // Between blanks it has words, not fields.
        None => !names(k),
    };
    let is_it = (1..=MOST).contains(&header) && names(header) && is_free(header);
    (is_it && (0..header).all(is_title)).then_some(header)
}

/// Whether fields are the units of that many names.
fn are_units(cells: &[String], names: usize) -> bool {
    let is_it = |unit: &String| is_unit(unit.trim_matches(['[', ']', '(', ')']));
    cells.len() <= names && cells.iter().any(is_it) && !cells.iter().any(|cell| is_number(cell))
}

/// The fields of a line, without empty ones at its end.
fn cells(line: &str, separator: Option<u8>) -> Vec<String> {
    let Some(separator) = separator else {
        return line.split_whitespace().map(str::to_owned).collect();
    };
    let mut cells = vec![String::new()];
    let mut is_quoted = false;
    for c in line.chars() {
        is_quoted ^= c == '"';
        match c {
            _ if c == char::from(separator) && !is_quoted => cells.push(String::new()),
            '"' => {}
            _ => cells.last_mut().unwrap_or(&mut String::new()).push(c),
        }
    }
    for cell in &mut cells {
        *cell = cell.trim().to_owned();
    }
    while cells.last().is_some_and(String::is_empty) {
        cells.pop();
    }
    cells
}

/// Whether most of several fields are numbers. A comma behind one is between fields.
fn is_row(cells: &[String]) -> bool {
    let is_it = |cell: &&String| is_number(cell) && !cell.ends_with(',');
    let numbers = cells.iter().filter(is_it).count();
    cells.len() > 1 && 2 * numbers > cells.len()
}
