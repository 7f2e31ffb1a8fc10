//! Filters of a control: low-pass and notch.

use std::f64::consts::TAU;

use compensator::DriveFilter;

use crate::part::PartError;

/// A filter of second order in discrete time, its direct form II transposed:
/// `y = b₀ u + …`, with gain 1 at frequency 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Filter {
    b: [f64; 3],
    a: [f64; 2],
    state: [f64; 2],
}

/// Highest share of the sampling rate that a filter can be tuned to.
const HIGHEST: f64 = 0.45;

impl Filter {
    /// Low pass of first order at `frequency` (Hz), exact where samples are held.
    pub fn low_pass(frequency: f64, period: f64) -> Result<Self, PartError> {
        check("lowpass", frequency, period)?;
        let pole = (-TAU * frequency * period).exp();
        Ok(Self {
            b: [1.0 - pole, 0.0, 0.0],
            a: [-pole, 0.0],
            state: [0.0; 2],
        })
    }

    /// Notch at `frequency` (Hz): (s² + 2 d ζ ω s + ω²)/(s² + 2 ζ ω s + ω²) with the
    /// depth d (gain at the middle, 0 for none left) and the damping ζ, by the bilinear
    /// transformation that keeps the middle where it is.
    pub fn notch(frequency: f64, damping: f64, depth: f64, period: f64) -> Result<Self, PartError> {
        check("notch", frequency, period)?;
        let half = 0.5 * TAU * frequency * period;
        let (sin, cos) = (2.0 * half).sin_cos();
        let width = damping * sin;
        let norm = 1.0 / (1.0 + width);
        Ok(Self {
            b: [
                norm * (1.0 + depth * width),
                norm * -2.0 * cos,
                norm * (1.0 - depth * width),
            ],
            a: [norm * -2.0 * cos, norm * (1.0 - width)],
            state: [0.0; 2],
        })
    }

    /// One sample through the filter.
    pub fn pass(&mut self, u: f64) -> f64 {
        let y = self.b[0] * u + self.state[0];
        self.state = [
            self.b[1] * u - self.a[0] * y + self.state[1],
            self.b[2] * u - self.a[1] * y,
        ];
        y
    }

    /// Tells it that the last of what it made was not `asked` but `given`, which the next
    /// ones follow from.
    pub fn made(&mut self, asked: f64, given: f64) {
        let by = given - asked;
        for (state, a) in self.state.iter_mut().zip(self.a) {
            *state -= a * by;
        }
    }

    /// As if `u` had come in for ever.
    pub fn settle(&mut self, u: f64) {
        let last = (self.b[2] - self.a[1]) * u;
        self.state = [(self.b[1] - self.a[0]) * u + last, last];
    }
}

impl Filter {
    /// It as corrections pass through it.
    pub fn law(&self) -> DriveFilter {
        DriveFilter {
            b: self.b,
            a: self.a,
        }
    }
}

fn check(what: &'static str, frequency: f64, period: f64) -> Result<(), PartError> {
    let most = HIGHEST / period;
    if frequency > 0.0 && frequency <= most {
        return Ok(());
    }
    let six = crate::SixDigits;
    Err(PartError::together(
        format!(
            "a {what} at {} Hz is above what a loop sampled at {} Hz can hold",
            six(frequency),
            six(1.0 / period)
        ),
        format!("above 0 and at most {} Hz", six(most)),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Amplitude of what is left of a sine after a second, least squares on its
    /// last half.
    fn gain(mut filter: Filter, frequency: f64, period: f64) -> f64 {
        let n = (1.0 / period) as usize;
        let mut sums = [0.0; 2];
        for k in 0..n {
            let phase = TAU * frequency * k as f64 * period;
            let y = filter.pass(phase.sin());
            if k >= n / 2 {
                sums[0] += y * phase.sin();
                sums[1] += y * phase.cos();
            }
        }
        sums[0].hypot(sums[1]) * 4.0 / n as f64
    }

    #[test]
    fn a_notch_takes_its_frequency_and_leaves_the_others() {
        let notch = || Filter::notch(320.0, 0.3, 0.1, 1e-4).unwrap();
        assert!((gain(notch(), 320.0, 1e-4) - 0.1).abs() < 1e-3);
        assert!((gain(notch(), 20.0, 1e-4) - 1.0).abs() < 5e-3);
        assert!((gain(notch(), 4000.0, 1e-4) - 1.0).abs() < 5e-3);
        let low = Filter::low_pass(100.0, 1e-4).unwrap();
        assert!((gain(low, 100.0, 1e-4) - 0.5f64.sqrt()).abs() < 0.02);
        assert!(Filter::notch(4800.0, 0.3, 0.1, 1e-4).is_err());
    }

    #[test]
    fn a_settled_filter_shows_what_came_in() {
        let mut notch = Filter::notch(320.0, 0.3, 0.1, 1e-4).unwrap();
        notch.settle(2.5);
        assert!((notch.pass(2.5) - 2.5).abs() < 1e-12);
        let mut low = Filter::low_pass(50.0, 1e-4).unwrap();
        low.settle(-3.0);
        assert!((low.pass(-3.0) + 3.0).abs() < 1e-12);
    }
}
