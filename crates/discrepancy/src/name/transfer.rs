//! Whether an effect has on other motion the size that it has where it was fitted.

use crate::answers::{LogSet, Rest};

/// Share by which the size on other motion may differ: laws of the library stand for those of a machine. Right names of
/// seeds 10 and 12 of `docs/laws/run` that the check logs determine differ by at most 0.18, those of the measured
/// positioning stage (EMPS) by 0.15.
pub(crate) const TRANSFERS: f64 = 0.2;

/// An effect's size, fitted to logs that were not used in its fit, over the size that it has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Transfer {
    /// The ratio, 1 if the logs agree.
    pub(crate) ratio: f64,
    /// Half width of its 95 % interval.
    pub(crate) half_width: f64,
}

impl Transfer {
    /// From the residuals without the effect and with it: the regression of the first on their difference, weighed by the
    /// spectrum of the second. What else is missing there widens the interval.
    pub(crate) fn new(set: &LogSet, without: &Rest, with: &Rest) -> Self {
        let layout = &set.layout;
        let [without, with] = [without, with].map(|rest| set.amplitudes(rest));
        let whitener = layout.whitener(&layout.spectral_matrices(&with));
        let [without, with] = [without, with].map(|rest| layout.whiten(&whitener, &rest));
        let effect = &without - with;
        let energy = effect.norm_squared();
        Self {
            ratio: effect.dot(&without) / energy,
            half_width: 1.96 / energy.sqrt(),
        }
    }

    /// Lower end, ratio, upper end; `None` if the effect does nothing there.
    pub(crate) fn interval(&self) -> Option<[f64; 3]> {
        let ends = || [-1.0, 0.0, 1.0].map(|side| self.ratio + side * self.half_width);
        self.half_width.is_finite().then(ends)
    }

    /// By how much the interval of the ratio stays away from what it may be; positive if the size is another. Logs that do not
    /// tell the size from none say nothing of it.
    pub(crate) fn excess(&self) -> f64 {
        match self.half_width <= self.ratio.abs().max(1.0) {
            true => (self.ratio - 1.0).abs() - self.half_width - TRANSFERS,
            false => f64::NEG_INFINITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Transfer;

    #[test]
    fn a_size_that_differs_by_a_fifth_or_by_what_chance_explains_is_the_same() {
        let of = |ratio: f64, half_width: f64| Transfer { ratio, half_width }.excess();
        assert!(of(0.85, 0.03) < 0.0 && of(1.19, 0.0) < 0.0);
        assert!(of(0.5, 0.4) < 0.0 && of(-1.7, 3.6) < 0.0 && of(-1.25, 2.05) < 0.0);
        assert!(of(0.42, 0.31) > 0.0 && of(0.65, 0.1) > 0.0 && of(1.5, 0.2) > 0.0);
        assert!(of(17.0, 6.0) > 0.0);
        assert!(
            Transfer {
                ratio: f64::NAN,
                half_width: f64::INFINITY
            }
            .interval()
            .is_none()
        );
    }
}
