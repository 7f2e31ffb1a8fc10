//! What `heat` found, as text and as JSON.

use std::fmt;
use std::path::PathBuf;

use axis_sim::SixDigits;
use axis_thermal::HeatNode;
use serde::Serialize;

/// Hours of a duty, at even times.
#[derive(Serialize)]
pub struct Heated {
    pub axis: String,
    pub axis_fingerprint: String,
    pub motion: String,
    /// "reference" or "simulation".
    pub losses_from: &'static str,
    /// How long one motion lasts.
    pub duty_s: f64,
    pub duration_s: f64,
    pub air_c: f64,
    /// Numbers that the file states; the others are assumed.
    pub keys_of_the_file: usize,
    /// Mean friction of the duty at the reference temperature.
    pub cold_dry_friction_w: f64,
    pub cold_viscous_friction_w: f64,
    /// By what the controller positions: "motor" or "load".
    pub measures_at: &'static str,
    /// Length of one segment of `screw_at_end_c`; none without a screw.
    pub screw_segment_mm: Option<f64>,
    /// Steps of the solution.
    pub steps: u64,
    pub time_min: Vec<f64>,
    pub nodes: Vec<HeatedNode>,
    /// Empty without a screw.
    pub screw_mean_c: Vec<f64>,
    pub loss_w: Vec<f64>,
    /// Friction against that at the reference temperature.
    pub dry_factor: Vec<f64>,
    pub viscous_factor: Vec<f64>,
    pub places: Vec<HeatedPlace>,
    /// Of a screw that is held at both ends.
    pub force: Option<HeatedForce>,
    /// Temperature of each segment of the screw in the end.
    pub screw_at_end_c: Vec<f64>,
    pub report: Option<PathBuf>,
}

/// A body.
#[derive(Serialize)]
pub struct HeatedNode {
    #[serde(skip)]
    pub node: HeatNode,
    pub name: &'static str,
    pub temperature_c: Vec<f64>,
}

/// Growth at a position since the start.
#[derive(Serialize)]
pub struct HeatedPlace {
    pub position_mm: f64,
    /// Of the screw; none without one.
    pub screw_um: Option<Vec<f64>>,
    pub scale_um: Vec<f64>,
    pub bed_um: Vec<f64>,
}

/// Force of the screw since the start.
#[derive(Default, Serialize)]
pub struct HeatedForce {
    pub compression_n: Vec<f64>,
    pub tension_n: Vec<f64>,
}

impl Heated {
    /// What was run, in one line.
    pub fn title(&self) -> String {
        format!(
            "{}: {}, for {} min in air of {} °C (simulated)",
            self.axis,
            self.motion,
            SixDigits(self.duration_s / 60.0),
            SixDigits(self.air_c)
        )
    }

    /// How much of it is assumed.
    pub fn assumed(&self) -> String {
        match self.keys_of_the_file {
            0 => "All thermal numbers are assumed: the axis file has no [thermal].".to_owned(),
            n => format!(
                "{n} thermal numbers are from the axis file's [thermal]; the others are assumed defaults."
            ),
        }
    }

    /// What growth means for this axis.
    pub fn what_counts(&self) -> &'static str {
        match (self.measures_at, self.screw_at_end_c.is_empty()) {
            ("motor", false) => {
                "This axis measures at the motor: its table is off by the screw's growth."
            }
            ("motor", true) => {
                "This axis measures at the motor; growth of its transmission is not part of the model."
            }
            _ => "This axis measures at the load: its table is off by the scale's growth.",
        }
    }

    /// Rows of tables: a few of the even times.
    pub fn rows(&self) -> Vec<usize> {
        let last = self.time_min.len().saturating_sub(1);
        let at = |twelfth: usize| last * twelfth / 12;
        [1, 2, 4, 6, 8, 10, 12].map(at).to_vec()
    }

    /// The growth that the controller does not see, of each position: its name, and over time.
    pub fn unseen(&self) -> Vec<(f64, &[f64])> {
        let motor = self.measures_at == "motor";
        let all = self.places.iter().filter_map(|place| {
            let growth = match motor {
                true => place.screw_um.as_deref()?,
                false => &place.scale_um,
            };
            Some((place.position_mm, growth))
        });
        all.collect()
    }
}

impl fmt::Display for Heated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.title())?;
        writeln!(f, "{}", self.assumed())?;
        writeln!(
            f,
            "Cold friction {:.1} W dry, {:.1} W viscous on average, from the {}.",
            self.cold_dry_friction_w, self.cold_viscous_friction_w, self.losses_from
        )?;
        write!(f, "{:>7} {:>8}", "min", "loss, W")?;
        for node in &self.nodes {
            write!(f, " {:>w$}", node.name, w = width(node.name))?;
        }
        if !self.screw_mean_c.is_empty() {
            write!(f, " {:>10}", "screw mean")?;
        }
        writeln!(f, " {:>9} {:>9}", "dry ×", "viscous ×")?;
        for i in self.rows() {
            write!(f, "{:>7.1} {:>8.1}", self.time_min[i], self.loss_w[i])?;
            for node in &self.nodes {
                write!(f, " {:>w$.2}", node.temperature_c[i], w = width(node.name))?;
            }
            if let Some(mean) = self.screw_mean_c.get(i) {
                write!(f, " {mean:>10.2}")?;
            }
            writeln!(
                f,
                " {:>9.3} {:>9.3}",
                self.dry_factor[i], self.viscous_factor[i]
            )?;
        }
        self.growth(f)?;
        if let Some(force) = &self.force {
            let last = |all: &[f64]| all.last().copied().unwrap_or(0.0);
            let (heat, left) = (last(&force.compression_n), last(&force.tension_n));
            let state = if left < 0.0 { "compression" } else { "tension" };
            writeln!(
                f,
                "Screw held at both ends: in the end heat takes {heat:.0} N off its pretension, which leaves {:.0} N of {state}",
                left.abs()
            )?;
        }
        match &self.report {
            Some(path) => write!(f, "{}", path.display()),
            None => Ok(()),
        }
    }
}

impl Heated {
    fn growth(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.places.is_empty() {
            return Ok(());
        }
        type Of = fn(&HeatedPlace) -> Option<&[f64]>;
        let lines: [(&str, Of); 3] = [
            ("screw", |place| place.screw_um.as_deref()),
            ("scale", |place| Some(&place.scale_um)),
            ("bed", |place| Some(&place.bed_um)),
        ];
        for (name, of) in lines {
            if self.places.iter().all(|place| of(place).is_none()) {
                continue;
            }
            write!(f, "{:>22}", format!("growth of the {name}, µm"))?;
            for place in &self.places {
                write!(
                    f,
                    " {:>12}",
                    format!("at {} mm", SixDigits(place.position_mm))
                )?;
            }
            writeln!(f)?;
            for i in self.rows() {
                write!(f, "{:>18.1} min", self.time_min[i])?;
                for growth in self.places.iter().filter_map(of) {
                    write!(f, " {:>12.2}", growth[i])?;
                }
                writeln!(f)?;
            }
        }
        writeln!(f, "{}", self.what_counts())
    }
}

/// Of a column of temperatures.
fn width(name: &str) -> usize {
    name.chars().count().max(7)
}
