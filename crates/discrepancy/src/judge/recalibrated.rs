//! Known parameters that were moved.

use std::f64::consts::PI;

use axis_log::never_zero;
use axis_sim::Axis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::estimate::known::{known_deviations, shown, tolerances};
use crate::name::search::Found;

/// A known parameter that was moved inside its tolerance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Recalibrated {
    /// Name.
    pub name: String,
    /// Share of its value by which it was moved; of an angle that angle, rad.
    pub share: f64,
    /// Tolerance, likewise.
    pub tolerance: f64,
    /// Whether it is an angle.
    #[serde(default)]
    pub is_angle: bool,
    /// What the logs alone say of it, if they say more than its tolerance does: its estimate without the tolerance, and the half
    /// width of the 95 % interval of that, as shares.
    #[serde(skip)]
    pub by_logs: Option<[f64; 2]>,
}

/// Those of a machine as it was found.
pub(super) fn recalibrated(machine: &Axis, found: &Found) -> Vec<Recalibrated> {
    let of_logs = by_logs(machine, found);
    let known = machine.known().into_iter().zip(&found.fit.state.shares);
    let known = known.zip(tolerances(machine));
    let known = known.zip(machine.known_angles()).zip(of_logs);
    let one = |((((name, &share), tolerance), is_angle), by_logs)| Recalibrated {
        by_logs,
        name: shown(name),
        share,
        tolerance,
        is_angle,
    };
    known.map(one).collect()
}

/// What the logs say of each known parameter without its tolerance. The fit holds it to 0 with the deviation d of a
/// uniform distribution over that: with the variance c in the end it gives only 1 − c/d² of the parameter's own estimate.
fn by_logs(machine: &Axis, found: &Found) -> Vec<Option<[f64; 2]>> {
    let deviations = known_deviations(machine).into_iter().enumerate();
    let one = |(i, deviation): (usize, f64)| {
        let variance = *found.covariance.get((i, i))?;
        let noise = found.spreads.get(i)?.of_noise;
        own_estimate(found.fit.state.shares[i], noise, variance, deviation)
    };
    deviations.map(one).collect()
}

/// The estimate without its tolerance, and the half width of its 95 % interval, of a parameter that was fitted at `share`
/// with this standard deviation of noise, and which the fit knows to this variance beside a tolerance of this
/// deviation; `None` if the tolerance says more than the logs.
fn own_estimate(share: f64, noise: f64, variance: f64, deviation: f64) -> Option<[f64; 2]> {
    let own = 1.0 - variance / (deviation * deviation);
    (own > 0.5).then(|| [share / own, DEVIATIONS * noise / own])
}

/// Half width of an interval, as a share of the tolerance, up to which its end counts. Chosen: an honest parameter, anywhere in
/// its tolerance, is then taken for one at its edge in at most a quarter of the cases.
const SURE: f64 = 0.25;

/// Standard deviations of a 95 % interval.
const DEVIATIONS: f64 = 1.96;

/// Share of the tolerance from which a parameter is at its edge: fits end just inside.
const EDGE: f64 = 0.99;

impl Recalibrated {
    /// Whether the fit moved it to the limit of its tolerance, or its own interval, without the tolerance, reaches beyond
    /// that. Of an interval that is wide beside the tolerance the middle counts: wider ones reach beyond it
    /// wherever the parameter is. An angle that may have any value has no limit.
    pub fn is_at_edge(&self) -> bool {
        let is_any = self.is_angle && self.tolerance >= EDGE * PI;
        let reaches = self.by_logs.is_some_and(|[own, half]| {
            let reach = if half <= SURE * self.tolerance {
                half
            } else {
                0.0
            };
            own.abs() + reach >= self.tolerance
        });
        let is_moved = self.share.abs() >= EDGE * self.tolerance;
        self.tolerance > 0.0 && !is_any && (is_moved || reaches)
    }

    /// By how much it was moved, with its unit.
    pub fn moved(&self) -> String {
        match self.is_angle {
            true => format!("{:+.3}°", self.share.to_degrees()),
            false => format!("{:+.2} %", 100.0 * self.share),
        }
    }

    /// Its tolerance, with its unit.
    pub fn within(&self) -> String {
        match self.is_angle {
            true => format!("{}°", never_zero(self.tolerance.to_degrees(), 3)),
            false => format!("{} %", never_zero(100.0 * self.tolerance, 2)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::own_estimate;

    /// One measurement y of deviation s beside a prior of deviation d: mean y d²/(s² + d²), variance s² d²/(s² + d²).
    #[test]
    fn what_the_logs_say_alone_is_the_measurement() {
        for (y, s, d) in [
            (0.13, 0.01, 0.0577),
            (-0.02, 0.003, 0.0577),
            (0.13, 0.05, 0.0577),
        ] {
            let (s2, d2) = (s * s, d * d);
            let kept = d2 / (s2 + d2);
            let [own, half] = own_estimate(y * kept, s * kept, s2 * kept, d).unwrap();
            assert!((own - y).abs() < 1e-12 && (half - 1.96 * s).abs() < 1e-12);
        }
        // Of what the tolerance tells better nothing is said.
        assert_eq!(
            own_estimate(0.05, 0.03, 0.9 * 0.0577 * 0.0577, 0.0577),
            None
        );
        assert_eq!(own_estimate(0.0, 0.0, 0.0, 0.0), None);
    }
}
