//! What `check` found, as text and as JSON.

use std::fmt;
use std::path::PathBuf;

use axis_sim::SixDigits;
use axis_sim::rating::{CheckedItem, ItemState};
use serde::Serialize;

/// All items of an axis under a duty.
#[derive(Serialize)]
pub struct Checked {
    /// Name of the axis.
    pub axis: String,
    /// Its fingerprint.
    pub axis_fingerprint: String,
    /// What the duty is made of.
    pub duty: String,
    /// Whether it is from logs, not simulated.
    pub is_measured: bool,
    /// How long the duty lasts; it is taken as repeated without end.
    pub duty_s: f64,
    /// Keys that the file's `[rating]` states.
    pub keys_of_the_file: usize,
    /// The items, those left out that the axis cannot have.
    pub items: Vec<CheckedRow>,
    /// Where this was written as JSON.
    pub json: Option<PathBuf>,
    /// Where its page was written.
    pub report: Option<PathBuf>,
}

/// What has no bound, for people.
const UNLIMITED: &str = "unlimited";

/// One item.
#[derive(Serialize)]
pub struct CheckedRow {
    /// Its name, such as `motor_rms_torque`.
    pub name: &'static str,
    /// The same in words.
    pub title: &'static str,
    /// Unit of value and limit; empty of a plain number.
    pub unit: &'static str,
    /// None if it is not known; infinite of a life without load, of a winding that no heat leaves.
    pub value: Option<f64>,
    /// None if it is not known.
    pub limit: Option<f64>,
    /// "at most" or "at least"; none without a limit.
    pub bound: Option<&'static str>,
    /// limit/value, or value/limit of what must be at least the limit: 1 just reaches it; infinite if nothing is asked. None without
    /// a limit.
    pub margin: Option<f64>,
    /// "ok", "over" or "not known".
    pub verdict: &'static str,
    /// Keys that would make it known, of `[rating]` if no table is named.
    pub give: Vec<String>,
}

impl CheckedRow {
    /// Of an item.
    pub fn of(item: &CheckedItem) -> Self {
        let (raw, unit, give) = match &item.state {
            ItemState::Rated(rating) => (Some(rating.value), rating.unit, Vec::new()),
            ItemState::NotKnown { value, unit, keys } => (*value, *unit, keys.clone()),
        };
        let rating = item.rating();
        Self {
            name: item.name,
            title: item.title,
            unit,
            value: raw,
            limit: rating.map(|rating| rating.limit),
            bound: rating.map(|_| match item.is_at_least() {
                true => "at least",
                false => "at most",
            }),
            margin: rating.map(|rating| rating.margin()),
            verdict: item.verdict().name(),
            give,
        }
    }

    /// The value for people.
    pub fn shown_value(&self) -> String {
        match self.value {
            Some(value) => self.with_unit(value),
            None => "–".to_owned(),
        }
    }

    /// The limit for people.
    pub fn shown_limit(&self) -> String {
        match (self.limit, self.bound) {
            (Some(limit), Some(bound)) => format!("{bound} {}", self.with_unit(limit)),
            _ => "–".to_owned(),
        }
    }

    /// The margin for people.
    pub fn shown_margin(&self) -> String {
        match self.margin {
            Some(margin) if margin.is_infinite() => UNLIMITED.to_owned(),
            Some(margin) => rounded(margin),
            None => "–".to_owned(),
        }
    }

    /// The verdict, with what would be needed.
    pub fn shown_verdict(&self) -> String {
        let lists = |name: &&String| name.contains('.');
        let (others, own): (Vec<&String>, Vec<&String>) = self.give.iter().partition(lists);
        let names = |all: &[&String]| -> Vec<String> { all.iter().map(|s| (*s).clone()).collect() };
        let mut asked = Vec::new();
        if !own.is_empty() {
            asked.push(format!("{} in [rating]", names(&own).join(", ")));
        }
        asked.extend(names(&others));
        match asked.is_empty() {
            true => self.verdict.to_owned(),
            false => format!("{}: give {}", self.verdict, asked.join(" and ")),
        }
    }

    fn with_unit(&self, value: f64) -> String {
        if value.is_infinite() {
            return UNLIMITED.to_owned();
        }
        format!("{} {}", rounded(value), self.unit)
            .trim_end()
            .to_owned()
    }
}

/// Four significant digits, thousands whole.
fn rounded(value: f64) -> String {
    let size = value.abs();
    let digits = match size {
        _ if size >= 1000.0 || size == 0.0 => 0,
        _ if size >= 100.0 => 1,
        _ if size >= 10.0 => 2,
        _ if size >= 1.0 => 3,
        _ => {
            return format!("{value:.3e}")
                .parse()
                .map_or_else(|_| String::new(), |v: f64| v.to_string());
        }
    };
    match size < 1e7 {
        true => format!("{value:.digits$}"),
        false => format!("{value:.3e}"),
    }
}

impl Checked {
    /// What was checked, in one line.
    pub fn title(&self) -> String {
        let how = if self.is_measured {
            "measured"
        } else {
            "simulated"
        };
        format!(
            "{}: {}, {} s, repeated without end ({how})",
            self.axis,
            self.duty,
            SixDigits(self.duty_s)
        )
    }

    /// How many items have a verdict.
    pub fn count(&self, verdict: &str) -> usize {
        self.items
            .iter()
            .filter(|item| item.verdict == verdict)
            .count()
    }

    /// The result, in one line.
    pub fn result(&self) -> String {
        let over: Vec<&str> = (self.items.iter())
            .filter(|item| item.verdict == "over")
            .map(|item| item.name)
            .collect();
        let (ok, unknown) = (self.count("ok"), self.count("not known"));
        let over = match over.len() {
            0 => "none over".to_owned(),
            n => format!("{n} over ({})", over.join(", ")),
        };
        format!(
            "{} items: {ok} ok, {over}, {unknown} not known",
            self.items.len()
        )
    }
}

impl fmt::Display for Checked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.title())?;
        let rows = self.items.iter().map(|item| {
            [
                item.name.to_owned(),
                item.shown_value(),
                item.shown_limit(),
                item.shown_margin(),
                item.shown_verdict(),
            ]
        });
        let head = ["item", "value", "limit", "margin", "verdict"].map(str::to_owned);
        let all: Vec<[String; 5]> = std::iter::once(head).chain(rows).collect();
        let width = |i: usize| {
            all.iter()
                .map(|row| row[i].chars().count())
                .max()
                .unwrap_or(0)
        };
        let [a, b, c, d] = [0, 1, 2, 3].map(width);
        for [name, value, limit, margin, verdict] in &all {
            writeln!(
                f,
                "{name:<a$}  {value:>b$}  {limit:>c$}  {margin:>d$}  {verdict}"
            )?;
        }
        write!(f, "{}", self.result())?;
        for path in self.json.iter().chain(&self.report) {
            write!(f, "\n{}", path.display())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::rounded;

    #[test]
    fn numbers_have_four_digits() {
        for (value, shown) in [
            (0.0, "0"),
            (0.012_341, "0.01234"),
            (1.0, "1.000"),
            (12.3456, "12.35"),
            (123.456, "123.5"),
            (98_765.4, "98765"),
            (1.234_56e9, "1.235e9"),
            (-4.321_9, "-4.322"),
        ] {
            assert_eq!(rounded(value), shown);
        }
    }
}
