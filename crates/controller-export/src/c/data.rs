//! Numbers as C.

use std::fmt::Write;

use axis_scalar::Scalar;

/// A number as C reads it back to the bit: the shortest decimal that does. An infinite limit
/// becomes the greatest number.
pub(super) fn literal<T: Scalar>(value: T) -> String {
    let bounded = value.min(T::MAX).max(-T::MAX);
    let suffix = if T::EPSILON.to_f64() > 1e-10 { "f" } else { "" };
    format!("{bounded:?}{suffix}")
}

/// `static const real NAME = value; /* meaning */`
pub(super) fn constant<T: Scalar>(name: &str, value: T, meaning: &str) -> String {
    format!(
        "static const real {name} = {}; /* {meaning} */\n",
        literal(value)
    )
}

/// A table of numbers.
pub(super) fn table<T: Scalar>(name: &str, values: &[T], meaning: &str) -> String {
    let items: Vec<String> = values.iter().map(|&value| literal(value)).collect();
    listed("real", name, &items, meaning)
}

/// A table of counts.
pub(super) fn counts(name: &str, values: &[usize], meaning: &str) -> String {
    let items: Vec<String> = values.iter().map(usize::to_string).collect();
    listed("unsigned", name, &items, meaning)
}

fn listed(kind: &str, name: &str, items: &[String], meaning: &str) -> String {
    let mut text = format!(
        "/* {meaning} */\nstatic const {kind} {name}[{}] = {{",
        items.len()
    );
    let mut column = usize::MAX;
    for item in items {
        if column > 92 {
            text.push_str("\n    ");
            column = 4;
        }
        let _ = write!(text, "{item}, ");
        column += item.len() + 2;
    }
    text.push_str("\n};\n");
    text.replace(", \n", ",\n")
}
