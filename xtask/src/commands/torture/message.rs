//! Whether a refusal says what, where and what would be valid, as far as a program
//! can tell.

use miette::Report;

/// Longest message that anyone reads.
const LONGEST: usize = 4000;
/// What only a debugger should show.
const DEBUG: [&str; 12] = [
    "Err(", "Ok(", "Some(", "None)", "unwrap", "panicked", "Os {", "Custom {", "kind:", "::new",
    "core::", "std::",
];
/// One of these leads to what would be valid.
const ADVICE: [&str; 32] = [
    "valid",
    "must",
    "need",
    "give",
    "at least",
    "at most",
    "expected",
    "should",
    "run `cargo",
    "make it",
    "save",
    "one of",
    "other than",
    "choose",
    "record",
    "belongs to",
    "above",
    "below",
    "between",
    "is not",
    "not a",
    "leave",
    "map",
    "end ",
    "there is no",
    "has ",
    "header",
    "missing",
    "are not of",
    "duplicate",
    "unclosed",
    "only",
];

/// Everything that a report says, from the outermost on, as the program prints it.
pub fn words(report: &Report) -> String {
    let all: Vec<String> = report.chain().map(ToString::to_string).collect();
    let help = report.help().map(|help| help.to_string());
    all.into_iter().chain(help).collect::<Vec<_>>().join(": ")
}

/// What is wrong with a refusal that should name `file`, and a place in it where
/// `place` says so.
pub fn judge(report: &Report, file: &str, place: bool) -> Result<(), String> {
    // As the program would show it: this must not fail either.
    let shown = format!("{report:?}");
    let words = words(report);
    let wrong = |what: &str| Err(format!("the refusal {what}: {}", clip(&words)));
    if shown.trim().is_empty() || words.trim().is_empty() {
        return wrong("is empty");
    }
    if words.len() > LONGEST {
        return wrong("is too long to read");
    }
    if !words.contains(file) {
        return wrong("does not name the file");
    }
    if let Some(found) = DEBUG.iter().find(|d| words.contains(**d)) {
        return wrong(&format!("shows the program's inside ({found})"));
    }
    if place && !says_where(&words) {
        return wrong("does not say where");
    }
    if !ADVICE.iter().any(|advice| words.contains(advice)) {
        return wrong("does not say what would be valid");
    }
    Ok(())
}

/// A line, row, byte or column, or something named in quotes.
fn says_where(words: &str) -> bool {
    let numbered = |sign: &str| {
        words.match_indices(sign).any(|(at, _)| {
            let rest = &words.as_bytes()[at + sign.len()..];
            rest.first().is_some_and(u8::is_ascii_digit)
        })
    };
    [
        "line ", "row ", "byte ", "column ", "line: ", "step ", ".toml:",
    ]
    .into_iter()
    .any(numbered)
        || words.matches(['"', '`']).count() >= 2
        || [
            "is empty",
            "no samples",
            "no rows",
            "header",
            "samples:",
            "starts in motion",
            "sample rate",
            "t = ",
            "t_s = ",
            "too poor",
            "start is ",
            "no column ",
            "it is ",
        ]
        .iter()
        .any(|whole| words.contains(whole))
}

/// The beginning of a text, for a table.
pub fn clip(text: &str) -> String {
    text.chars()
        .take(300)
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use miette::miette;

    #[test]
    fn good_refusals_pass_and_bad_ones_do_not() {
        let good = miette!("a.toml:12: `mechanism.lead` is -1; valid: a number above zero");
        assert_eq!(judge(&good, "a.toml", true), Ok(()));
        for (bad, what) in [
            (miette!(""), "is empty"),
            (miette!("b.toml:1: is not a number"), "name the file"),
            (miette!("a.toml:1: is not Some(3)"), "inside"),
            (miette!("a.toml is not right"), "where"),
            (miette!("a.toml:12: no"), "valid"),
            (miette!("a.toml:12: {}", "must ".repeat(2000)), "too long"),
        ] {
            let found = judge(&bad, "a.toml", true).unwrap_err();
            assert!(found.contains(what), "{found}");
        }
    }
}
