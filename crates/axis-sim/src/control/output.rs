//! The way out of every control: filters of the command, then its limit, of which the
//! integral is told.

use super::filter::Filter;

/// Filters of a command, and its limit behind them.
///
/// The limit comes last, so that no filter's overshoot passes it: a notch answers to a step
/// with more than the step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Output {
    pub filters: [Option<Filter>; 2],
}

/// A command within its limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limited {
    /// What goes to the actuator.
    pub effort: f64,
    /// Whether that is less than was asked for.
    pub saturated: bool,
    asked: f64,
}

impl Limited {
    /// What was asked for, within ±`most`; a limit that is negative or not a number leaves
    /// nothing.
    fn of(asked: f64, most: f64) -> Self {
        let most = most.max(0.0);
        Self {
            effort: asked.clamp(-most, most),
            saturated: asked.abs() > most,
            asked,
        }
    }

    /// Whether an integral that follows `error` would press on against the limit: it keeps
    /// its value then (conditional integration).
    pub fn presses(&self, error: f64) -> bool {
        self.saturated && error * self.asked > 0.0
    }
}

impl Output {
    /// One cycle: from what the control asks for, everything that is added to it included, to
    /// what goes to an actuator that takes ±`most` now.
    pub fn pass(&mut self, asked: f64, most: f64) -> Limited {
        let mut made = [asked; 2];
        let mut value = asked;
        for (filter, made) in self.filters.iter_mut().zip(&mut made) {
            if let Some(filter) = filter {
                value = filter.pass(value);
            }
            *made = value;
        }
        let limited = Limited::of(value, most);
        if limited.saturated {
            // Or the filters would remember a command that never was.
            for (filter, made) in self.filters.iter_mut().flatten().zip(made) {
                filter.made(made, Limited::of(made, most).effort);
            }
        }
        limited
    }

    /// As if `effort` had been asked for, and given, for ever.
    pub fn settle(&mut self, effort: f64) {
        let filters = self.filters.iter_mut().flatten();
        filters.for_each(|filter| filter.settle(effort));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD: f64 = 1.0 / 8000.0;

    fn notch() -> Option<Filter> {
        Some(Filter::notch(320.0, 0.3, 0.1, PERIOD).unwrap())
    }

    fn low_pass() -> Option<Filter> {
        Some(Filter::low_pass(200.0, PERIOD).unwrap())
    }

    /// The unlimited notch answers to ±1 at its own frequency, and to steps, with more than 1.
    #[test]
    fn no_filter_passes_the_limit() {
        for filters in [[None, notch()], [low_pass(), notch()], [low_pass(), None]] {
            let mut free = filters;
            let mut output = Output { filters };
            let (mut most, mut most_free) = (0.0_f64, 0.0_f64);
            for k in 0..2000 {
                // A step, then bang-bang with a period of its own, each three times the limit.
                let half = if k < 500 { 500 } else { 9 };
                let asked = if (k / half) % 2 == 0 { 3.0 } else { -3.0 };
                most = most.max(output.pass(asked, 1.0).effort.abs());
                let mut value = asked / 3.0;
                for filter in free.iter_mut().flatten() {
                    value = filter.pass(value);
                }
                most_free = most_free.max(value.abs());
            }
            assert!(most == 1.0, "{most}");
            // But for the low passes, which take that from it.
            assert!(filters[0].is_some() || most_free > 1.1, "{most_free}");
        }
    }

    /// What was asked for beyond the limit is forgotten: after ten seconds at a thousand times
    /// it, a command of 0 is 0 as soon as after ten seconds just at the limit.
    #[test]
    fn filters_do_not_wind_up() {
        let after = |asked: f64| {
            let mut output = Output {
                filters: [low_pass(), None],
            };
            for _ in 0..80_000 {
                output.pass(asked, 1.0);
            }
            [0; 20].map(|_| output.pass(0.0, 1.0).effort)
        };
        for (wound, plain) in after(1000.0).into_iter().zip(after(1.0)) {
            assert!((wound - plain).abs() < 1e-12, "{wound} {plain}");
        }
    }

    #[test]
    fn an_integral_waits_only_while_it_would_press_on() {
        let at = |asked| Output::default().pass(asked, 2.0);
        assert!(at(3.0).presses(0.1) && at(-3.0).presses(-0.1));
        assert!(!at(3.0).presses(-0.1) && !at(2.0).presses(0.1) && !at(3.0).presses(0.0));
        // An actuator that takes nothing.
        let none = Output::default().pass(1.0, f64::NAN);
        assert!(none.effort == 0.0 && none.presses(1.0) && !none.presses(-1.0));
    }
}
