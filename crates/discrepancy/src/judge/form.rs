//! How the law of a friction differs from the model's, in words and as a curve.

use axis_sim::Axis;
use axis_sim::effects::{ActiveEffect, FrictionForm, Measure};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How a friction comes on and falls with speed, where that is not as in the model: the
/// curve is its steady force over that of sliding.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FormFound {
    /// The friction whose form it is, in words.
    pub of: String,
    /// What of its law differs: the onset, or the fall with speed.
    pub differs_in: String,
    /// Speed below which it differs by more than a tenth of the sliding force.
    pub below: f64,
    /// Unit of the speeds.
    pub unit: String,
    /// Share of the onset that comes with speed, and not with displacement as in the model.
    pub with_speed: f64,
    /// Speeds, rising.
    pub speed: Vec<f64>,
    /// Steady friction there over that of sliding; 1 everywhere in the model.
    pub ratio: Vec<f64>,
    /// Fall of minus twice the log-likelihood: on the fit logs, on the check logs.
    pub evidence: [f64; 2],
}

/// Speeds of the curve.
const SPEEDS: usize = 72;

/// Departure from the model's law beyond which a form is said to differ.
const DIFFERS: f64 = 0.1;

impl FormFound {
    pub(super) fn new(
        machine: &Axis,
        form: &ActiveEffect,
        of: &str,
        evidence: [f64; 2],
    ) -> Option<Self> {
        let form = FrictionForm::of(form)?;
        let [first, last] = form.speeds();
        let at = |k: usize| {
            let share = k as f64 / (SPEEDS - 1) as f64;
            0.1 * first * (last / (0.1 * first)).powf(share)
        };
        let speed: Vec<f64> = (0..SPEEDS).map(at).collect();
        let ratio: Vec<f64> = speed.iter().map(|&v| form.at(v)).collect();
        let differs = ratio.iter().rposition(|r| (r - 1.0).abs() > DIFFERS);
        Some(Self {
            of: of.to_owned(),
            differs_in: form.differs_in().to_owned(),
            below: differs.map_or(0.0, |k| speed[k]),
            unit: Measure::Speed.unit(machine.freedom()).to_owned(),
            with_speed: form.with_speed(),
            speed,
            ratio,
            evidence,
        })
    }

    /// In a sentence that follows another.
    pub(super) fn sentence(&self) -> String {
        let (scale, unit) = match self.unit.as_str() {
            "m/s" => (1e3, "mm/s"),
            _ => (1e3, "mrad/s"),
        };
        let below = match self.below > 0.0 {
            true => format!(" below {:.2} {unit}", scale * self.below),
            false => String::new(),
        };
        format!(
            " The {} of the {}{below} differs from the model\u{2019}s; the report has the curve.",
            self.differs_in, self.of
        )
    }
}
