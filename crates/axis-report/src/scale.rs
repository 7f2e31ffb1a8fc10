//! Range, ticks and tick labels of an axis.

use crate::figure::Scale;
use crate::number::superscript;
use crate::unit::{Unit, scaled};

/// An axis fitted to its data. What is drawn is `value · 10^-exponent`: drawing
/// then works on numbers near one, whatever the unit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fitted {
    pub scale: Scale,
    /// Unit of the values.
    pub unit: Unit,
    /// Power of ten taken out of the values.
    pub exponent: i32,
    /// Ends of the axis, drawn values.
    pub range: (f64, f64),
    /// Distance of the ticks, drawn values; unused on a logarithmic axis.
    pub step: f64,
    /// Decades between labelled ticks of a logarithmic axis.
    pub stride: i32,
    /// Names of rows from the top down, where it is an axis of these.
    pub names: Vec<String>,
}

impl Fitted {
    /// Fits an axis with about `ticks` ticks to values that are finite (and
    /// positive where `scale` is logarithmic). `tight` ends it at the data,
    /// otherwise it ends at ticks.
    pub fn new(
        scale: Scale,
        unit: Unit,
        values: impl Iterator<Item = f64>,
        ticks: f64,
        tight: bool,
    ) -> Self {
        let (min, max) = values.fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)));
        match scale {
            Scale::Linear => Self::linear(unit, min, max, ticks, tight),
            Scale::Log => Self::log(unit, min, max, ticks, tight),
        }
    }

    /// An axis of named rows: row 0 is drawn on top.
    pub fn rows(names: Vec<String>) -> Self {
        Self {
            scale: Scale::Linear,
            unit: Unit::parse(""),
            exponent: 0,
            range: (-0.6, names.len() as f64 - 0.4),
            step: 1.0,
            stride: 1,
            names,
        }
    }

    fn linear(unit: Unit, min: f64, max: f64, ticks: f64, tight: bool) -> Self {
        let greatest = min.abs().max(max.abs());
        let exponent = if unit.is_prefixed() {
            unit.reading(greatest)
        } else if greatest == 0.0 || (1e-2..1e5).contains(&greatest) {
            0
        } else {
            (greatest.log10() / 3.0).floor() as i32 * 3
        };
        let (mut lo, mut hi) = (scaled(min, exponent), scaled(max, exponent));
        // A flat series, or one flat to rounding, gets room around it.
        let flat = hi - lo <= 1e-12 * lo.abs().max(hi.abs());
        if flat {
            let room = if hi == 0.0 { 1.0 } else { 0.1 * hi.abs() };
            (lo, hi) = (lo - room, hi + room);
        }
        let step = nice_step((hi - lo) / ticks);
        if flat || !tight {
            // Data on the frame would be hard to see, except where it starts
            // from zero.
            let room = 0.03 * (hi - lo);
            lo -= if lo == 0.0 { 0.0 } else { room };
            hi += if hi == 0.0 { 0.0 } else { room };
            lo = (lo / step + 1e-9).floor() * step;
            hi = (hi / step - 1e-9).ceil() * step;
        }
        Self {
            scale: Scale::Linear,
            unit,
            exponent,
            range: (lo, hi),
            step,
            stride: 1,
            names: Vec::new(),
        }
    }

    fn log(unit: Unit, min: f64, max: f64, ticks: f64, tight: bool) -> Self {
        let exponent = min.log10().floor() as i32;
        let (mut lo, mut hi) = (scaled(min, exponent), scaled(max, exponent));
        if hi / lo < 1.0 + 1e-9 {
            (lo, hi) = (lo / 2.0, hi * 2.0);
        }
        if !tight {
            let wide = hi / lo > 1e3;
            lo = snap_down(lo, wide);
            hi = snap_up(hi, wide);
        }
        let decades = (hi / lo).log10();
        Self {
            scale: Scale::Log,
            unit,
            exponent,
            range: (lo, hi),
            step: 1.0,
            stride: (decades / ticks).ceil().max(1.0) as i32,
            names: Vec::new(),
        }
    }

    /// The drawn value of a value.
    pub fn drawn(&self, value: f64) -> f64 {
        if !self.names.is_empty() {
            return (self.names.len() - 1) as f64 - value;
        }
        scaled(value, self.exponent)
    }

    /// The value of a drawn value.
    pub fn undrawn(&self, drawn: f64) -> f64 {
        if !self.names.is_empty() {
            return (self.names.len() - 1) as f64 - drawn;
        }
        scaled(drawn, -self.exponent)
    }

    /// Place of a value between the ends of the axis, 0 to 1.
    pub fn fraction(&self, value: f64) -> f64 {
        let f = |v: f64| match self.scale {
            Scale::Linear => v,
            Scale::Log => v.log10(),
        };
        let (lo, hi) = (f(self.range.0), f(self.range.1));
        (f(self.drawn(value)) - lo) / (hi - lo)
    }

    /// What the axis label must add: the unit with its prefix, or the power of ten where one
    /// is taken out of the tick labels.
    pub fn label_suffix(&self) -> String {
        let named = |unit: String| match unit.as_str() {
            "" => unit,
            _ => format!(", {unit}"),
        };
        match self.scale {
            Scale::Linear if self.unit.is_prefixed() => named(self.unit.with(self.exponent)),
            Scale::Linear if self.exponent != 0 => {
                let unit = named(self.unit.with(0));
                format!("{unit} (×10{})", superscript(self.exponent))
            }
            _ => named(self.unit.with(0)),
        }
    }

    /// Label of the tick at a drawn value.
    pub fn tick_label(&self, drawn: f64) -> String {
        if !self.names.is_empty() {
            let row = (self.names.len() - 1) as f64 - drawn.round();
            // Ticks lie on rows; one beyond them has no name.
            let name = (row >= 0.0).then(|| self.names.get(row as usize)).flatten();
            return name.cloned().unwrap_or_default();
        }
        match self.scale {
            Scale::Linear => {
                let digits = (-(self.step.log10() + 1e-9).floor()).max(0.0) as usize;
                let text = format!("{:.*}", digits, drawn);
                match text.strip_prefix('-') {
                    Some(rest) if rest.bytes().any(|b| (b'1'..=b'9').contains(&b)) => {
                        format!("\u{2212}{rest}")
                    }
                    Some(zero) => zero.to_owned(),
                    None => text,
                }
            }
            Scale::Log => self.log_label(drawn),
        }
    }

    fn log_label(&self, drawn: f64) -> String {
        let decade = (drawn.log10() + 1e-9).floor() as i32;
        let mantissa = (drawn / 10f64.powi(decade)).round() as i32;
        let decade = decade + self.exponent;
        if decade.rem_euclid(self.stride) != 0 {
            return String::new();
        }
        let plain = self.range.1 / self.range.0 <= 1.001e3 && (-2..=4).contains(&decade);
        match mantissa {
            m if plain => {
                let digits = (-decade).max(0) as usize;
                format!("{:.*}", digits, f64::from(m) * 10f64.powi(decade))
            }
            1 => format!("10{}", superscript(decade)),
            m => format!("{m}·10{}", superscript(decade)),
        }
    }

    /// Number of characters of the longest tick label.
    pub fn widest_label(&self) -> usize {
        let length = |v: f64| self.tick_label(v).chars().count();
        if let Some(widest) = self.names.iter().map(|name| name.chars().count()).max() {
            return widest;
        }
        match self.scale {
            Scale::Linear => length(self.range.0).max(length(self.range.1)),
            Scale::Log => {
                let decades = (self.range.1 / self.range.0).log10().ceil() as i32;
                (0..=decades)
                    .flat_map(|d| [1.0, 2.0, 5.0].map(|m| m * 10f64.powi(d)))
                    .map(length)
                    .max()
                    .unwrap_or(1)
            }
        }
    }
}

/// The least of 1, 2, 5 times a power of ten that is not below `rough`.
fn nice_step(rough: f64) -> f64 {
    let base = 10f64.powf(rough.log10().floor());
    [1.0, 2.0, 5.0]
        .into_iter()
        .map(|m| m * base)
        .find(|step| *step >= rough * (1.0 - 1e-9))
        .unwrap_or(10.0 * base)
}

fn snap_down(value: f64, whole_decades: bool) -> f64 {
    let base = 10f64.powf((value.log10() + 1e-9).floor());
    let choices: &[f64] = if whole_decades {
        &[1.0]
    } else {
        &[5.0, 2.0, 1.0]
    };
    choices
        .iter()
        .map(|m| m * base)
        .find(|v| *v <= value * (1.0 + 1e-9))
        .unwrap_or(base)
}

fn snap_up(value: f64, whole_decades: bool) -> f64 {
    let base = 10f64.powf((value.log10() - 1e-9).floor());
    let choices: &[f64] = if whole_decades {
        &[10.0]
    } else {
        &[1.0, 2.0, 5.0]
    };
    choices
        .iter()
        .map(|m| m * base)
        .find(|v| *v >= value * (1.0 - 1e-9))
        .unwrap_or(10.0 * base)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn fit(scale: Scale, values: &[f64]) -> Fitted {
        Fitted::new(scale, Unit::parse(""), values.iter().copied(), 6.0, false)
    }

    #[test]
    fn steps_are_one_two_or_five() {
        for (rough, nice) in [
            (0.9, 1.0),
            (1.1, 2.0),
            (2.0, 2.0),
            (21.0, 50.0),
            (0.06, 0.1),
        ] {
            assert!((nice_step(rough) - nice).abs() < 1e-12 * nice, "{rough}");
        }
    }

    #[test]
    fn labels_are_short_whatever_the_unit() {
        let axis = fit(Scale::Linear, &[-5.4e-5, 5.4e-5]);
        assert_eq!(axis.exponent, -6);
        assert_eq!(axis.label_suffix(), " (×10⁻⁶)");
        assert_eq!(axis.tick_label(-40.0), "\u{2212}40");
        assert_eq!(axis.tick_label(-1e-9), "0");
        let axis = fit(Scale::Linear, &[0.0, 0.7]);
        assert_eq!((axis.range.0, axis.label_suffix().as_str()), (0.0, ""));
        assert_eq!(axis.tick_label(0.2), "0.2");
    }

    #[test]
    fn a_prefix_takes_the_place_of_the_power_of_ten() {
        let axis = |unit, values: &[f64]| {
            let values = values.iter().copied();
            Fitted::new(Scale::Linear, Unit::parse(unit), values, 6.0, false)
        };
        let error = axis("m", &[-5.4e-5, 5.4e-5]);
        assert_eq!(error.label_suffix(), ", µm");
        assert_eq!(error.tick_label(error.drawn(4e-5)), "40");
        assert_eq!(axis("m/s", &[0.0, 0.25]).label_suffix(), ", mm/s");
        let viscous = axis("N·s/m", &[0.0, 2e6]);
        assert_eq!(viscous.label_suffix(), ", N·s/m (×10⁶)");
    }

    #[test]
    fn decades_are_labelled_as_powers_where_there_are_many() {
        let wide = fit(Scale::Log, &[3e-9, 0.5]);
        assert_eq!((wide.exponent, wide.range), (-9, (1.0, 1e9)));
        assert_eq!(wide.stride, 2);
        assert_eq!(wide.tick_label(10.0), "10⁻⁸");
        assert_eq!(wide.tick_label(1.0), "");
        let few = fit(Scale::Log, &[0.3, 40.0]);
        // Drawn values carry the factor 10.
        assert_eq!(few.tick_label(2.0), "0.2");
        assert_eq!(few.tick_label(500.0), "50");
    }

    proptest! {
        #[test]
        fn every_value_lies_on_the_axis(
            values in prop::collection::vec(prop::num::f64::NORMAL | prop::num::f64::ZERO, 1..20),
            tight in any::<bool>(),
        ) {
            let axis = Fitted::new(Scale::Linear, Unit::parse(""), values.iter().copied(), 6.0, tight);
            for v in &values {
                let f = axis.fraction(*v);
                prop_assert!((-1e-9..=1.0 + 1e-9).contains(&f), "{v} at {f} of {axis:?}");
            }
        }

        #[test]
        fn every_positive_value_lies_on_a_logarithmic_axis(
            exponents in prop::collection::vec(-149.0..149.0f64, 1..20), tight in any::<bool>(),
        ) {
            let values: Vec<f64> = exponents.iter().map(|e| 10f64.powf(*e)).collect();
            let axis = Fitted::new(Scale::Log, Unit::parse(""), values.iter().copied(), 6.0, tight);
            for v in &values {
                let f = axis.fraction(*v);
                prop_assert!((-1e-9..=1.0 + 1e-9).contains(&f), "{v} at {f} of {axis:?}");
            }
        }
    }
}
