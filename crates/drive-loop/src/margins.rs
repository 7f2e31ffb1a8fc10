//! Margins of one corner in full.

use std::f64::consts::{PI, TAU};

use schemars::JsonSchema;
use serde::Serialize;

use crate::law::{LoopAt, LoopGains};
use crate::loops::{CornerLoop, hertz};
use crate::plant::{Corner, LoopModel, Number};
use crate::turn::radius;

/// Bisections by which a crossing is found between two frequencies.
const BISECTIONS: u32 = 30;
/// Share of a number that its imaginary part is by rounding alone.
const REAL: f64 = 1e-6;
/// Golden-section steps by which a peak is found between its neighbours.
const SECTIONS: u32 = 40;

/// Margins of a loop that is cut at one place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct CutMargins {
    /// Maximum sensitivity, max 1/|1 + L|; none where the loop is not stable.
    pub sensitivity: Option<f64>,
    /// Frequency of that, Hz.
    pub sensitivity_at_hz: f64,
    /// The same with one more cycle of delay.
    pub sensitivity_late: Option<f64>,
    /// Frequency of that, Hz.
    pub sensitivity_late_at_hz: f64,
    /// Factor by which the gain may rise, above 1; none where there is no end to it.
    pub gain_up: Option<f64>,
    /// Factor by which the gain may fall, below 1; none where it may fall to 0. Loops with two
    /// integrators are conditionally stable: they have both.
    pub gain_down: Option<f64>,
    /// Least phase margin over all crossings of gain 1, degrees; none where there is no crossing.
    pub phase_deg: Option<f64>,
    /// Delay that the loop takes before it is unstable: the least over all crossings, s; none where
    /// there is no crossing.
    pub delay_s: Option<f64>,
    /// Highest frequency at which the gain is 1, Hz.
    pub crossover_hz: Option<f64>,
}

/// Margins, bandwidths and compliance with the load in one place and state.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct CornerMargins {
    /// Where, and what is other than the file says.
    pub at: Corner,
    /// Whether the loop is stable: its greatest eigenvalue is below 1.
    pub stable: bool,
    /// Greatest eigenvalue of the closed loop, per control cycle, its loops at their own rates.
    pub radius: f64,
    /// The whole loop, cut at the command.
    pub command: CutMargins,
    /// The position loop, cut where the position comes in, the speed loop closed; of a PID controller,
    /// which has one loop, the same as `command`.
    pub position: CutMargins,
    /// Frequency from which on the speed follows its set point by less than −3 dB, Hz; none where it
    /// does so up to half the sampling rate, and of a PID controller.
    pub speed_bandwidth_hz: Option<f64>,
    /// The same of the position, without feed-forward.
    pub position_bandwidth_hz: Option<f64>,
    /// Greatest motion of the load per force on it, m/N or rad/(N·m), and its frequency, Hz.
    pub compliance_peak: f64,
    /// Frequency of that, Hz.
    pub compliance_peak_at_hz: f64,
    /// Root mean square of it from 1 to 300 Hz, evenly over the logarithm of the frequency.
    pub compliance_rms: f64,
    /// Ripple of the command by the step of the sensor that the speed is derived from (RMS), as a
    /// share of the greatest command.
    pub ripple: f64,
}

/// Frequencies over which the compliance is meant, Hz.
pub(crate) const COMPLIANCE: [f64; 2] = [1.0, 300.0];

impl CutMargins {
    /// Takes note of a place where the loop meets the negative real axis.
    fn gain(&mut self, at: Number) {
        let factor = 1.0 / at.norm();
        match factor > 1.0 {
            true => least(&mut self.gain_up, factor),
            false => {
                let most = self.gain_down.unwrap_or(0.0);
                self.gain_down = Some(most.max(factor));
            }
        }
    }
}

impl CornerLoop {
    /// All margins of it.
    pub(crate) fn margins(&self, model: &LoopModel, gains: &LoopGains) -> CornerMargins {
        let radius = radius(model, self, gains);
        let stable = radius < 1.0 && self.sensitivities(gains).now[0].is_finite();
        let cut = |place: usize| self.cut_margins(model, gains, place, stable);
        let size = |point: &LoopAt| point.compliance(gains).norm();
        let (at, peak) = self.peak(model, &size);
        CornerMargins {
            at: self.at,
            stable,
            radius,
            command: cut(0),
            position: cut(1),
            speed_bandwidth_hz: match model.is_pid {
                true => None,
                false => self.bandwidth(model, |p| p.speed_followed(gains)),
            },
            position_bandwidth_hz: self.bandwidth(model, |p| {
                let l = p.cut(gains, false)[1];
                l / (l + 1.0)
            }),
            compliance_peak: peak,
            compliance_peak_at_hz: hertz(at),
            compliance_rms: self.compliance_rms(gains),
            ripple: self.ripple(model, gains),
        }
    }

    fn cut_margins(
        &self,
        model: &LoopModel,
        gains: &LoopGains,
        place: usize,
        stable: bool,
    ) -> CutMargins {
        let (at, peak) = self.sensitivity(model, gains, place, false);
        let (late_at, late) = self.sensitivity(model, gains, place, true);
        let l = |p: &LoopAt| p.cut(gains, false)[place];
        let late_stable = stable && self.sensitivities(gains).late[0].is_finite();
        let mut found = CutMargins {
            sensitivity: stable.then_some(peak),
            sensitivity_at_hz: hertz(at),
            sensitivity_late: late_stable.then_some(late),
            sensitivity_late_at_hz: hertz(late_at),
            gain_up: None,
            gain_down: None,
            phase_deg: None,
            delay_s: None,
            crossover_hz: None,
        };
        for pair in self.points.windows(2) {
            let [a, b] = [l(&pair[0]), l(&pair[1])];
            // Through the negative real axis.
            if a.im * b.im <= 0.0 && a.re < 0.0 && b.re < 0.0 {
                let point = self.crossing(model, pair, |p| l(p).im);
                found.gain(l(&point));
            }
            // Through the unit circle.
            if (a.norm() - 1.0) * (b.norm() - 1.0) <= 0.0 {
                let point = self.crossing(model, pair, |p| l(p).norm() - 1.0);
                let above = (-l(&point)).arg();
                let lead = if above < 0.0 { above + TAU } else { above };
                least(&mut found.phase_deg, above.abs() * 180.0 / PI);
                least(&mut found.delay_s, lead / point.frequency);
                found.crossover_hz = Some(hertz(point.frequency));
            }
        }
        // At half the sampling rate it is real, and ends on the axis.
        if let Some(end) = self.points.last().map(l)
            && end.re < 0.0
            && end.im.abs() < REAL * end.re.abs()
        {
            found.gain(end);
        }
        found
    }

    /// Maximum sensitivity at either cut, and with one more cycle of delay; infinite where the loop
    /// is unstable.
    pub(crate) fn peaks(&self, model: &LoopModel, gains: &LoopGains) -> [f64; 2] {
        let on_grid = self.sensitivities(gains);
        [(on_grid.now, false), (on_grid.late, true)].map(|(grid, is_late)| {
            if !grid[0].is_finite() {
                return f64::INFINITY;
            }
            let peak = |place: usize| self.sensitivity(model, gains, place, is_late).1;
            peak(0).max(peak(1))
        })
    }

    /// Frequency (rad/s) and height of the sensitivity's peak at a cut.
    fn sensitivity(
        &self,
        model: &LoopModel,
        gains: &LoopGains,
        place: usize,
        is_late: bool,
    ) -> (f64, f64) {
        let of = |p: &LoopAt| 1.0 / (p.cut(gains, is_late)[place] + 1.0).norm();
        self.peak(model, &of)
    }

    /// Where `of` is 0 between two points of the grid.
    fn crossing(&self, model: &LoopModel, pair: &[LoopAt], of: impl Fn(&LoopAt) -> f64) -> LoopAt {
        let [mut low, mut high] = [pair[0], pair[1]];
        let sign = of(&low).signum();
        for _ in 0..BISECTIONS {
            let Some(middle) = self.at(model, (low.frequency * high.frequency).sqrt()) else {
                break;
            };
            match of(&middle).signum() == sign {
                true => low = middle,
                false => high = middle,
            }
        }
        high
    }

    /// Frequency (rad/s) and height of the greatest value.
    fn peak(&self, model: &LoopModel, of: &dyn Fn(&LoopAt) -> f64) -> (f64, f64) {
        let heights: Vec<f64> = self.points.iter().map(of).collect();
        let mut at = 0;
        for (i, height) in heights.iter().enumerate() {
            if *height > heights[at] {
                at = i;
            }
        }
        let end = |i: usize| self.points[i.min(self.points.len() - 1)].frequency.ln();
        let (mut low, mut high) = (end(at.saturating_sub(1)), end(at + 1));
        let mut best = (self.points[at].frequency, heights[at]);
        let golden = 0.5 * (5f64.sqrt() - 1.0);
        let value = |x: f64| {
            self.at(model, x.exp())
                .map_or(f64::NEG_INFINITY, |p| of(&p))
        };
        for _ in 0..SECTIONS {
            let [a, b] = [high - golden * (high - low), low + golden * (high - low)];
            let [at_a, at_b] = [value(a), value(b)];
            for (x, height) in [(a, at_a), (b, at_b)] {
                if height > best.1 {
                    best = (x.exp(), height);
                }
            }
            match at_a > at_b {
                true => high = b,
                false => low = a,
            }
        }
        best
    }

    /// Frequency from which on a response is below −3 dB, Hz.
    fn bandwidth(&self, model: &LoopModel, of: impl Fn(&LoopAt) -> Number) -> Option<f64> {
        let low = std::f64::consts::FRAC_1_SQRT_2;
        let above = |p: &LoopAt| of(p).norm() - low;
        let pairs = self.points.windows(2).collect::<Vec<_>>();
        let last = pairs.iter().rev().find(|pair| above(&pair[0]) > 0.0)?;
        (above(&last[1]) <= 0.0).then(|| hertz(self.crossing(model, last, above).frequency))
    }

    /// Root mean square of the compliance over [`COMPLIANCE`].
    pub(crate) fn compliance_rms(&self, gains: &LoopGains) -> f64 {
        let [low, high] = COMPLIANCE.map(|hz| TAU * hz);
        let inside = |p: &&LoopAt| (low..=high).contains(&p.frequency);
        let mut before: Option<(f64, f64)> = None;
        let (mut sum, mut length) = (0.0, 0.0);
        for point in self.points.iter().filter(inside) {
            let (x, square) = (point.frequency.ln(), point.compliance(gains).norm_sqr());
            if let Some((x0, square0)) = before {
                sum += 0.5 * (square + square0) * (x - x0);
                length += x - x0;
            }
            before = Some((x, square));
        }
        (sum / length).sqrt()
    }

    /// Ripple of the command, RMS, as a share of the greatest command: the step of the sensor as
    /// white noise of its rounding, q/√12, sampled with the speed controller.
    pub(crate) fn ripple(&self, model: &LoopModel, gains: &LoopGains) -> f64 {
        let step = model.sensing.step;
        if step == 0.0 || !model.sensing.by_differences {
            return 0.0;
        }
        let (mut sum, mut length) = (0.0, 0.0);
        for pair in self.points.windows(2) {
            let [a, b] = [&pair[0], &pair[1]].map(|p| p.ripple(gains).norm_sqr());
            let over = pair[1].frequency - pair[0].frequency;
            sum += 0.5 * (a + b) * over;
            length += over;
        }
        step / 12f64.sqrt() * (sum / length).sqrt() / model.model.effort_limit
    }
}

fn least(of: &mut Option<f64>, value: f64) {
    *of = Some(of.map_or(value, |before| before.min(value)));
}
