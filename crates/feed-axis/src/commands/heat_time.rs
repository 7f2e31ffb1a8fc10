//! Durations with their units, as `heat` takes them.

/// Longest duration, s: four months.
pub const LONGEST: f64 = 1e7;

/// Reads a duration: a number and its unit.
pub(super) fn time(text: &str) -> std::result::Result<f64, String> {
    let units = [("min", 60.0), ("h", 3600.0), ("d", 86_400.0), ("s", 1.0)];
    let read = |(unit, factor): &(&str, f64)| {
        let number = text.trim().strip_suffix(unit)?.trim().parse::<f64>().ok()?;
        Some(number * factor)
    };
    let seconds = units.iter().find_map(read);
    let seconds = seconds.filter(|s| *s > 0.0 && *s <= LONGEST);
    seconds.ok_or_else(|| {
        "give a number above 0 and its unit, such as 600s, 90min, 1h or 1d; at most 115 days"
            .to_owned()
    })
}

#[cfg(test)]
mod tests {
    use super::time;

    #[test]
    fn durations_have_units() {
        assert_eq!(time("1h"), Ok(3600.0));
        assert_eq!(time(" 90 min"), Ok(5400.0));
        assert_eq!(time("2.5s"), Ok(2.5));
        assert_eq!(time("1d"), Ok(86_400.0));
        for bad in [
            "", "1", "h", "-1h", "0s", "nan h", "inf s", "1000d", "1 week",
        ] {
            assert!(time(bad).is_err(), "{bad}");
        }
    }
}
