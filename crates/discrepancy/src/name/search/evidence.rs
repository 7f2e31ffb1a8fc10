//! How much evidence an effect needs.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::spectrum::Layout;

/// Evidence, a fall of D, from which on one explanation is preferred to another: odds of e^12.5.
pub const DECISIVE_EVIDENCE: f64 = 25.0;

/// Least evidence of a further effect, as a share of the largest so far.
pub const LEAST_EVIDENCE_SHARE: f64 = 0.01;

/// Most by which the power of a channel's rest on the check logs may rise when an effect
/// is added: what is not named yet may have made up for some of it there. What is fitted
/// to one channel at the cost of another raises it more: a controller's gain, on the real
/// stage's logs, 139-fold. In the end nothing may have risen ([`crate::name::gap::worsened`]).
pub(super) const WORSE: f64 = 2.0;

/// Least fall of D on logs that were not fitted.
pub(super) const LEAST_HELD_OUT: f64 = 10.0;

/// Share of the fall of D on the fitted logs, log for log of the same length, that there must
/// be on those that were not: other motion may ask less of an effect, but what does next to
/// nothing there was fitted to one log.
pub(super) const HELD_OUT: f64 = 0.1;

/// Share of the rest's whitened power, that is of noise, that something must
/// have to be material: a fourteenth of the noise in amplitude. Sensor noise in
/// the loop shakes dry friction and backlash a little loose, which a replay
/// without noise knows nothing of, and simulations differ by their mesh.
const OF_NOISE: f64 = 0.005;

/// Fall of D that an effect must bring on a set of logs with this layout.
pub fn needed(layout: &Layout, parameters: usize, tried: usize, false_alarm: f64) -> f64 {
    threshold(parameters, tried, false_alarm).max(OF_NOISE * layout.size() as f64)
}

/// Fall of D that chance alone passes with probability `false_alarm` in any of
/// `tried` candidates with `parameters` each (Bonferroni's bound), and twice
/// that, as S is estimated from the same data.
fn threshold(parameters: usize, tried: usize, false_alarm: f64) -> f64 {
    let each = false_alarm / tried.max(1) as f64;
    // Any whole number above 0 makes a distribution.
    let quantile = ChiSquared::new(parameters.max(1) as f64).map(|d| d.inverse_cdf(1.0 - each));
    2.0 * quantile.unwrap_or(40.0)
}

/// Difference of D below which two effects explain as much.
pub(super) const EQUAL: f64 = 15.0;

/// Fall of D that further parameters may bring by chance.
pub(super) const BY_CHANCE: f64 = 25.0;

/// Fall of D that one further number brings by chance in one of a hundred cases, as χ² with
/// one degree of freedom.
pub(super) const BY_ONE_NUMBER: f64 = 6.6;

/// Fall of D of something simpler from which on it is taken instead of what brings
/// `best`: further parameters must bring a hundredth of the whole, and no less than
/// chance could.
pub(super) fn enough(best: f64) -> f64 {
    best - (0.01 * best).max(BY_CHANCE)
}
