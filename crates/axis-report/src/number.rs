//! Numbers as text.

/// A number of so many decimals with a typographic minus, and without one on a rounded zero.
///
/// ```
/// assert_eq!(axis_report::fixed(-12.34, 1), "\u{2212}12.3");
/// assert_eq!(axis_report::fixed(-0.0004, 3), "0.000");
/// ```
pub fn fixed(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().any(|b| (b'1'..=b'9').contains(&b)) => format!("\u{2212}{rest}"),
        Some(zero) => zero.to_owned(),
        None => text,
    }
}

/// A number as mantissa and power of ten.
pub(crate) fn scientific(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$e}");
    // Rust always writes the exponent; were it absent, the text stands as it is.
    match text.split_once('e').map(|(m, e)| (m, e.parse::<i32>())) {
        Some((mantissa, Ok(0))) => mantissa.replace('-', "\u{2212}"),
        Some((mantissa, Ok(e))) => {
            format!("{}·10{}", mantissa.replace('-', "\u{2212}"), superscript(e))
        }
        _ => text,
    }
}

/// An integer in Unicode superscripts.
pub(crate) fn superscript(value: i32) -> String {
    value
        .to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '0' | '4'..='9' => char::from_u32(0x2070 + c as u32 - '0' as u32).unwrap_or(c),
            other => other,
        })
        .collect()
}
