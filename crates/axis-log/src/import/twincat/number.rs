//! Numbers with a point or a comma.

/// A value of a channel: a number, or a truth value.
pub(super) fn value(text: &str) -> Option<f64> {
    let truth = [("false", 0.0), ("true", 1.0)];
    let is_it = |(name, _): &&(&str, f64)| text.eq_ignore_ascii_case(name);
    let truth = truth.iter().find(is_it).map(|(_, value)| *value);
    truth.or_else(|| decimal(text))
}

/// A number with either decimal mark. With both marks, or one twice, it is none: exports do not
/// group digits.
pub(super) fn decimal(text: &str) -> Option<f64> {
    text.parse()
        .or_else(|_| text.replace(',', ".").parse())
        .ok()
}

#[cfg(test)]
mod tests {
    use super::value;

    #[test]
    fn either_mark_is_read_and_both_are_not() {
        for (text, expected) in [
            ("1.25", Some(1.25)),
            ("-1,25", Some(-1.25)),
            ("1,5E-03", Some(1.5e-3)),
            ("7", Some(7.0)),
            ("True", Some(1.0)),
            ("FALSE", Some(0.0)),
            ("1.234,5", None),
            ("1,234,5", None),
            ("1,2.3", None),
            ("", None),
            (",", None),
            ("yes", None),
        ] {
            assert_eq!(value(text), expected, "{text:?}");
        }
    }
}
