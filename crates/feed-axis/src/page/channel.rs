//! Names of channels and logs as a page shows them.

use axis_log::{unit_of, unit_suffixes};

/// A channel in words, without its unit: `iq_ref_a` is a q current reference.
pub fn words(channel: &str) -> String {
    let suffix = unit_suffixes()
        .filter(|suffix| channel.ends_with(&format!("_{suffix}")))
        .max_by_key(|suffix| suffix.len());
    let stem = suffix.map_or(channel, |s| &channel[..channel.len() - s.len() - 1]);
    let (first, further) = stem.split_once('_').unwrap_or((stem, ""));
    let first = match (first, unit_of(channel)) {
        ("iq", _) => "q current",
        ("id", _) => "d current",
        ("uq", _) => "q voltage",
        ("ud", _) => "d voltage",
        (first, _) => first,
    };
    let further = further.split('_').filter(|word| !word.is_empty());
    let further = further.map(|word| match word {
        "ref" => "reference",
        "feedforward" => "feed-forward",
        word => word,
    });
    let all: Vec<&str> = std::iter::once(first).chain(further).collect();
    all.join(" ")
}

/// The files of a log without their folders.
pub fn files(log: &str) -> String {
    let name = |path: &str| path.rsplit(['/', '\\']).next().unwrap_or(path).to_owned();
    let names: Vec<String> = log.split('+').map(name).collect();
    names.join("+")
}

#[cfg(test)]
mod tests {
    use super::{files, words};

    #[test]
    fn a_channel_is_words_without_its_unit() {
        for (channel, shown) in [
            ("position_m", "position"),
            ("position_ref_m", "position reference"),
            ("motor_angle_rad", "motor angle"),
            ("motor_speed_rad_s", "motor speed"),
            ("iq_a", "q current"),
            ("iq_ref_a", "q current reference"),
            ("iq_feedforward_a", "q current feed-forward"),
            ("ud_v", "d voltage"),
            ("torque_n_m", "torque"),
            ("state", "state"),
        ] {
            assert_eq!(words(channel), shown, "{channel}");
        }
    }

    #[test]
    fn files_stand_without_folders() {
        assert_eq!(files("fit.csv"), "fit.csv");
        assert_eq!(files("logs/monday/fit.csv"), "fit.csv");
        assert_eq!(files(r"C:\logs\fit.csv"), "fit.csv");
        assert_eq!(
            files("logs/drive.csv+logs/scale.csv"),
            "drive.csv+scale.csv"
        );
    }
}
