//! What to write instead, where a text is not TOML.

/// What the reader of TOML says of a text that is none, and what to write instead where that is plain: of a
/// number with a decimal comma or with separators of thousands, of a text without quotes, and of a path with backslashes.
///
/// ```
/// let text = "mass_kg = 12,5\n";
/// let error = toml::from_str::<toml::Table>(text).unwrap_err();
/// let message = axis_sim::toml_message(text, &error);
/// assert!(message.ends_with("numbers are written with a decimal point: mass_kg = 12.5"));
/// ```
#[must_use]
pub fn toml_message(text: &str, error: &toml::de::Error) -> String {
    let at = error.span().map_or(0, |span| span.start);
    let said = error.to_string();
    match toml_hint(text, at) {
        Some(hint) => format!("{}\n{hint}", said.trim_end()),
        None => said.trim_end().to_owned(),
    }
}

/// What is meant by the line at `offset` of a text that is no TOML; `None` where that is not plain.
pub(super) fn toml_hint(text: &str, offset: usize) -> Option<String> {
    let before = text.get(..offset.min(text.len()))?;
    let line = text.lines().nth(before.matches('\n').count())?;
    let (key, value) = line.split_once('=')?;
    if let Some(path) = path_in(value) {
        return Some(format!(
            "in double quotes a backslash begins an escape; a path stands in single quotes, or has slashes: {} = '{path}'",
            key.trim()
        ));
    }
    let (key, value) = (key.trim(), value.split('#').next()?.trim());
    if let Some(number) = with_point(value) {
        return Some(format!(
            "numbers are written with a decimal point: {key} = {number}"
        ));
    }
    let is_word = |c: char| c.is_alphanumeric() || "-_. /\\".contains(c);
    let is_text = value.starts_with(char::is_alphabetic) && value.chars().all(is_word);
    is_text.then(|| format!("a text stands in quotes: {key} = \"{value}\""))
}

/// What stands in double quotes with a backslash in it, from the first of them to the next.
fn path_in(value: &str) -> Option<&str> {
    let (_, from) = value.split_once('"')?;
    let text = from.split('"').next()?;
    (text.contains('\\') && !text.contains('\'')).then_some(text)
}

/// A number that was written with a decimal comma, or with points or commas between thousands, as TOML
/// has it; `None` for what is none.
fn with_point(value: &str) -> Option<String> {
    let (sign, digits) = match value.strip_prefix('-') {
        Some(digits) => ("-", digits),
        None => ("", value),
    };
    let is_number = digits.starts_with(|c: char| c.is_ascii_digit())
        && digits.ends_with(|c: char| c.is_ascii_digit())
        && digits
            .chars()
            .all(|c| c.is_ascii_digit() || ".,".contains(c));
    let last = digits.rfind(['.', ','])?;
    if !is_number || !digits.contains(',') && digits.matches('.').count() < 2 {
        return None;
    }
    let separator = digits[last..].chars().next()?;
    let is_repeated = digits.matches(separator).count() > 1;
    let (whole, fraction) = match is_repeated {
        true => (digits, ""),
        false => (&digits[..last], &digits[last + 1..]),
    };
    let whole: String = whole.chars().filter(char::is_ascii_digit).collect();
    Some(match fraction {
        "" => format!("{sign}{whole}"),
        fraction => format!("{sign}{whole}.{fraction}"),
    })
}

#[cfg(test)]
mod tests {
    use super::toml_hint;

    #[test]
    fn numbers_of_other_countries_and_texts_without_quotes_are_shown_as_they_should_be() {
        let hint = |line: &str| toml_hint(&format!("a = 1\n{line}\n"), 6 + line.len());
        let number = "numbers are written with a decimal point: ";
        for (line, meant) in [
            ("mass_kg = 20,5 # of the table", "mass_kg = 20.5"),
            ("x = -0,25", "x = -0.25"),
            ("x = 1.000,5", "x = 1000.5"),
            ("x = 1,000.5", "x = 1000.5"),
            ("x = 1.000.000", "x = 1000000"),
        ] {
            assert_eq!(hint(line), Some(format!("{number}{meant}")), "{line}");
        }
        assert_eq!(
            hint("kind = ball-screw"),
            Some("a text stands in quotes: kind = \"ball-screw\"".to_owned())
        );
        let path = hint(r#"machine = "C:\users\a.toml" # theirs"#).unwrap();
        assert!(path.ends_with(r"machine = 'C:\users\a.toml'"), "{path}");
        for line in ["x = [1, 2", "x = \"a", "x == 3", "[control", "x = 1.5"] {
            assert_eq!(hint(line), None, "{line}");
        }
    }
}
