//! One name for each column.

use std::collections::{HashMap, HashSet};

use crate::log::TIME_CHANNEL;

/// A column's name to the user, and what the program calls it otherwise; either may be empty.
pub(super) type TwoNames<'a> = [&'a str; 2];

/// A name for each column that no other has, nor the time: the first of its two where no other
/// column has that too, then the second, then the first with a number behind it.
pub(super) fn distinct(columns: &[TwoNames<'_>]) -> Vec<String> {
    let counts = [0, 1].map(|k| counts(columns.iter().map(|names| names[k])));
    let once = |k: usize, name: &str| {
        !name.is_empty() && name != TIME_CHANNEL && counts[k].get(name) == Some(&1)
    };
    // These go before all others, wherever they stand.
    let first = columns.iter().map(|names| names[0]);
    let taken = first.filter(|name| once(0, name)).chain([TIME_CHANNEL]);
    let mut numbered = Numbered {
        taken: taken.map(str::to_owned).collect(),
        last: HashMap::new(),
    };
    let mut names = Vec::with_capacity(columns.len());
    for &[first, second] in columns {
        names.push(if once(0, first) {
            first.to_owned()
        } else if once(1, second) && numbered.taken.insert(second.to_owned()) {
            second.to_owned()
        } else {
            numbered.next(if first.is_empty() { "column" } else { first })
        });
    }
    names
}

fn counts<'a>(names: impl Iterator<Item = &'a str>) -> HashMap<&'a str, usize> {
    let mut counts = HashMap::new();
    names.for_each(|name| *counts.entry(name).or_default() += 1);
    counts
}

/// Names that are taken, and the last number that each was given.
struct Numbered<'a> {
    taken: HashSet<String>,
    last: HashMap<&'a str, usize>,
}

impl<'a> Numbered<'a> {
    fn next(&mut self, name: &'a str) -> String {
        loop {
            let last = self.last.entry(name).or_default();
            *last += 1;
            let numbered = match *last {
                1 => name.to_owned(),
                n => format!("{name} ({n})"),
            };
            if self.taken.insert(numbered.clone()) {
                return numbered;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::distinct;

    #[test]
    fn no_two_columns_have_one_name() {
        let names = distinct(&[
            ["x", "Axis 1.x"],
            ["y", ""],
            ["x", "Axis 2.x"],
            ["z", "s"],
            ["z", "s"],
            ["z (2)", "s"],
            ["t_s", "MAIN.t_s"],
            ["", ""],
            ["x", "y"],
        ]);
        let expected = [
            "Axis 1.x", "y", "Axis 2.x", "z", "z (3)", "z (2)", "MAIN.t_s", "column", "x",
        ];
        assert_eq!(names, expected);
    }
}
