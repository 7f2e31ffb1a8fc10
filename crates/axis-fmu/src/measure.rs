//! Units of variables: from the axis file's spelling to base units of the SI.

/// A unit as FMI declares it: a factor times powers of base units.
///
/// FMI has the radian among them (FMI 3.0.2, Section 2.4.3; FMI 2.0.5, Section 2.2.2).
#[derive(Clone, Debug, PartialEq)]
pub struct UnitDefinition {
    /// As people write it, `N.m/rad`.
    pub name: String,
    /// SI units in one of it.
    pub factor: f64,
    /// Powers of kg, m, s, A and rad.
    pub powers: [i32; 5],
}

/// Symbols of the base units, in the order of [`UnitDefinition::powers`].
pub(crate) const BASE: [&str; 5] = ["kg", "m", "s", "A", "rad"];

/// Radians in one degree.
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Spelling, symbol, SI units in one, powers of kg, m, s, A, rad.
type Symbol = (&'static str, &'static str, f64, [i32; 5]);

#[rustfmt::skip]
const SYMBOLS: &[Symbol] = &[
    ("m",      "m",      1.0,               [0, 1, 0, 0, 0]),
    ("mm",     "mm",     1e-3,              [0, 1, 0, 0, 0]),
    ("cm",     "cm",     1e-2,              [0, 1, 0, 0, 0]),
    ("um",     "um",     1e-6,              [0, 1, 0, 0, 0]),
    ("s",      "s",      1.0,               [0, 0, 1, 0, 0]),
    ("ms",     "ms",     1e-3,              [0, 0, 1, 0, 0]),
    ("us",     "us",     1e-6,              [0, 0, 1, 0, 0]),
    ("min",    "min",    60.0,              [0, 0, 1, 0, 0]),
    ("hz",     "Hz",     1.0,               [0, 0, -1, 0, 0]),
    ("khz",    "kHz",    1e3,               [0, 0, -1, 0, 0]),
    ("kg",     "kg",     1.0,               [1, 0, 0, 0, 0]),
    ("g",      "g",      1e-3,              [1, 0, 0, 0, 0]),
    ("t",      "t",      1e3,               [1, 0, 0, 0, 0]),
    ("n",      "N",      1.0,               [1, 1, -2, 0, 0]),
    ("kn",     "kN",     1e3,               [1, 1, -2, 0, 0]),
    ("pa",     "Pa",     1.0,               [1, -1, -2, 0, 0]),
    ("mpa",    "MPa",    1e6,               [1, -1, -2, 0, 0]),
    ("gpa",    "GPa",    1e9,               [1, -1, -2, 0, 0]),
    ("rad",    "rad",    1.0,               [0, 0, 0, 0, 1]),
    ("deg",    "deg",    DEGREE,            [0, 0, 0, 0, 1]),
    ("arcmin", "arcmin", DEGREE / 60.0,     [0, 0, 0, 0, 1]),
    ("arcsec", "arcsec", DEGREE / 3600.0,   [0, 0, 0, 0, 1]),
    ("rpm",    "rpm",    6.0 * DEGREE,      [0, 0, -1, 0, 1]),
    ("a",      "A",      1.0,               [0, 0, 0, 1, 0]),
    ("ma",     "mA",     1e-3,              [0, 0, 0, 1, 0]),
    ("v",      "V",      1.0,               [1, 2, -3, -1, 0]),
    ("ohm",    "Ohm",    1.0,               [1, 2, -3, -2, 0]),
    ("mohm",   "mOhm",   1e-3,              [1, 2, -3, -2, 0]),
    ("h",      "H",      1.0,               [1, 2, -2, -2, 0]),
    ("mh",     "mH",     1e-3,              [1, 2, -2, -2, 0]),
    ("uh",     "uH",     1e-6,              [1, 2, -2, -2, 0]),
];

impl UnitDefinition {
    /// The unit that the axis file spells so: units side by side multiply, what follows `per`
    /// divides, a number is a power (`n_m_s_per_rad`, `kg_per_m3`). None for an unknown one.
    pub fn spelled(spelling: &str) -> Option<Self> {
        let mut measure = Self {
            name: String::new(),
            factor: 1.0,
            powers: [0; 5],
        };
        let (mut above, mut below) = (Vec::new(), Vec::new());
        let mut sign = 1;
        for part in spelling.split('_') {
            if part == "per" {
                sign = -1;
                continue;
            }
            let digits = part.trim_start_matches(|c: char| !c.is_ascii_digit());
            let power: i32 = if digits.is_empty() {
                1
            } else {
                digits.parse().ok()?
            };
            let symbol = part.strip_suffix(digits)?;
            let known = SYMBOLS.iter().find(|(spelling, ..)| *spelling == symbol)?;
            measure.factor *= known.2.powi(sign * power);
            for (sum, own) in measure.powers.iter_mut().zip(known.3) {
                *sum += sign * power * own;
            }
            let side = if sign > 0 { &mut above } else { &mut below };
            side.push(format!("{}{digits}", known.1));
        }
        measure.name = name(&above, &below);
        Some(measure)
    }

    /// The unit of a channel of logs (`N·m`, `m/s²`).
    pub fn of_channel(unit: &str) -> Option<Self> {
        let spelling = unit.to_lowercase().replace('/', "_per_");
        Self::spelled(&spelling.replace('·', "_").replace('²', "2"))
    }
}

/// As people write it.
fn name(above: &[String], below: &[String]) -> String {
    let above = if above.is_empty() {
        "1".to_owned()
    } else {
        above.join(".")
    };
    match below {
        [] => above,
        [one] => format!("{above}/{one}"),
        several => format!("{above}/({})", several.join(".")),
    }
}

#[cfg(test)]
mod tests {
    use axis_sim::part::{Key, PartKind};
    use axis_sim::{CHANNELS, Registry};

    use super::*;

    fn keys<P: ?Sized>(kinds: &[&'static PartKind<P>]) -> Vec<Key> {
        kinds
            .iter()
            .flat_map(|kind| kind.keys.iter().cloned())
            .collect()
    }

    /// Both tables must say the same of every unit that an axis file may have.
    #[test]
    fn factors_are_those_of_the_axis_file() {
        let r = Registry::default();
        let all = [
            keys(&r.mechanisms),
            keys(&r.actuators),
            keys(&r.controls),
            keys(&r.frictions),
            keys(&r.loads),
        ];
        let units = all.iter().flatten().flat_map(|key| key.units());
        let mut count = 0;
        for (unit, factor) in units {
            let measure =
                UnitDefinition::spelled(unit).unwrap_or_else(|| panic!("{unit} is unknown"));
            assert!(
                (measure.factor / factor - 1.0).abs() < 1e-12,
                "{unit}: {measure:?}"
            );
            count += 1;
        }
        assert!(count > 100);
    }

    #[test]
    fn every_channel_has_a_unit() {
        for channel in CHANNELS {
            for [_, unit] in [channel.linear, channel.rotary] {
                assert!(UnitDefinition::of_channel(unit).is_some(), "{unit}");
            }
        }
    }

    /// 1 N·m/(rad/s) is 1 kg·m²/(s·rad); Ω·A = V; H·A/s = V.
    #[test]
    fn powers_follow_the_laws_that_join_units() {
        let of = |spelling| UnitDefinition::spelled(spelling).unwrap().powers;
        assert_eq!(of("n_m_s_per_rad"), [1, 2, -1, 0, -1]);
        assert_eq!(of("ohm_a"), of("v"));
        assert_eq!(of("h_a_per_s"), of("v"));
        assert_eq!(of("n_m_per_s"), of("v_a"));
        assert_eq!(of("pa_m2"), of("n"));
        assert_eq!(of("rpm"), of("rad_per_s"));
        assert_eq!(
            UnitDefinition::spelled("a_per_rpm_s").unwrap().name,
            "A/(rpm.s)"
        );
        assert_eq!(UnitDefinition::spelled("per_s").unwrap().name, "1/s");
        assert_eq!(UnitDefinition::spelled("furlong"), None);
    }
}
