//! What samples are transformed with.

use std::fmt;
use std::sync::Arc;

use axis_fourier::RealToComplex;

/// Longest ramp at either end of a log, s.
pub(super) const RAMP: f64 = 0.15;

/// What the averages of a log are transformed with: a search does so thousands of times.
#[derive(Clone)]
pub(super) struct Transform {
    pub(super) fft: Arc<dyn RealToComplex<f64>>,
    pub(super) taper: Arc<[f64]>,
}

impl fmt::Debug for Transform {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Transform")
            .field("length", &self.taper.len())
            .finish_non_exhaustive()
    }
}

impl Transform {
    /// Of `n` averages, `period` seconds apart, that count from `begin` on, s.
    pub(super) fn new(n: usize, period: f64, begin: f64) -> Self {
        Self {
            fft: axis_fourier::forward(n),
            taper: taper(n, period, begin),
        }
    }
}

/// Cosine ramps at both ends of a log. Noise that has gone round the loop
/// wanders, and ends elsewhere than it began; a transform takes that for a
/// step, which something that happens at the start would explain. Nothing
/// counts before the log's beginning.
fn taper(n: usize, period: f64, begin: f64) -> Arc<[f64]> {
    let ramp = (RAMP / period).min(0.05 * n as f64).max(1.0);
    let first = ((begin / period) as usize).min(n.saturating_sub(1));
    let at = |k: usize| {
        let Some(after) = k.checked_sub(first) else {
            return 0.0;
        };
        let edge = (after.min(n - 1 - k) as f64 + 0.5) / ramp;
        0.5 - 0.5 * (std::f64::consts::PI * edge.min(1.0)).cos()
    };
    (0..n).map(at).collect()
}
