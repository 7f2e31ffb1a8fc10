//! The load at the end of a step, where it depends on the motion it leads to.

use super::TableMotion;

/// How the search for a load ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadSearch {
    /// Loads that were tried; the law was called as often.
    pub rounds: u32,
    /// What the law gave at the last motion tried at which it was finite, less the
    /// load that led to that motion, N; no number where it never was.
    pub residual: f64,
    /// Whether the end speed is known to 1e-11 m/s. Where not, what follows from
    /// the load means nothing.
    pub converged: bool,
}

/// Most loads that are tried. Halving alone, the slowest course, takes four
/// rounds for a factor of two: 60 factors are 10⁻¹⁸ of where it started.
const MOST_ROUNDS: u32 = 250;

/// How far off the end speed may be, m/s.
const SPEED_TOLERANCE: f64 = 1e-11;

/// Solves `load = law(motion(load))` (N) where a newton more lowers the end speed
/// by at most `compliance`, (m/s)/N. Gives the load and how the search ended.
///
/// The first load tried is `guess`, the second what the law gives there: for a
/// heavy table that is nearly all. From then on it is the secant's between a load
/// that the law surpasses and one that it stays below, or the middle of the two
/// where the secant does not close in on the solution.
/// It ends when law and load differ by as little as moves the speed by
/// 1e-11 m/s, or when those two loads do.
///
/// That end is reached for every continuous law whose load is bounded or grows
/// with the speed, and where the load grows with the speed the solution is the
/// only one. A law that jumps up at some speed (Coulomb's, at rest) is taken as
/// filled in there: the load then lies within the jump and holds that speed. A
/// law that is not finite, or falls for ever with the speed and by more than a
/// newton for each `compliance`, ends without having converged.
///
/// The law is called last at a motion within 1e-11 m/s of that of the load, so a
/// state which it leaves behind in that call is that of the solution.
pub fn find_load(
    guess: f64,
    compliance: f64,
    motion: impl Fn(f64) -> TableMotion,
    law: impl FnMut(TableMotion) -> f64,
) -> (f64, LoadSearch) {
    find_load_within(f64::INFINITY, guess, compliance, motion, law)
}

/// As [`find_load`], of a law whose load changes by at most `steepness` newtons for
/// each metre a second of the end speed, rising or falling; infinite if nobody
/// knows.
///
/// With L = `steepness` · `compliance` what the law gives is then within
/// L/(1 − L) of its residual, and where that moves the speed by less than 1e-11 m/s
/// the search ends: for a heavy table after the first load tried. The last motion that
/// the law was called at is that of a load as far from the solution as the residual.
#[inline]
pub(crate) fn find_load_within(
    steepness: f64,
    guess: f64,
    compliance: f64,
    motion: impl Fn(f64) -> TableMotion,
    mut law: impl FnMut(TableMotion) -> f64,
) -> (f64, LoadSearch) {
    let contraction = steepness * compliance;
    let left = if contraction < 0.5 {
        contraction / (1.0 - contraction)
    } else {
        1.0
    };
    let mut search = Search::new();
    let mut end = LoadSearch {
        rounds: 0,
        residual: f64::NAN,
        converged: false,
    };
    let mut load = guess;
    while end.rounds < MOST_ROUNDS {
        let given = law(motion(load));
        end.rounds += 1;
        let residual = given - load;
        if !residual.is_finite() {
            break;
        }
        end.residual = residual;
        if left * (residual.abs() * compliance) <= SPEED_TOLERANCE {
            end.converged = true;
            return (search.closest(load, given, left), end);
        }
        load = search.next(load, given);
        if search.width() * compliance <= SPEED_TOLERANCE {
            end.converged = true;
            break;
        }
    }
    (load, end)
}

/// A load and its residual, N.
type Trial = [f64; 2];

/// What the trials so far tell of where the solution is.
struct Search {
    last: Option<Trial>,
    /// The solution is above the load of one, as far as is known, and below that
    /// of the other. The residual of an end that stays is scaled down.
    low: Trial,
    high: Trial,
    /// Distance of the two when it was last halved, and rounds since.
    halved: f64,
    since: u8,
}

impl Search {
    fn new() -> Self {
        Self {
            last: None,
            low: [f64::NEG_INFINITY, f64::NAN],
            high: [f64::INFINITY, f64::NAN],
            halved: f64::INFINITY,
            since: 0,
        }
    }

    fn width(&self) -> f64 {
        self.high[0] - self.low[0]
    }

    /// The best that can be said after the law gave nearly `load` there, the solution
    /// being within `left` residuals of that: the secant's load, where that may be it;
    /// otherwise the law's where it is known to be near, and the one tried where not.
    fn closest(&self, load: f64, given: f64, left: f64) -> f64 {
        let Some(before) = self.last else {
            return given;
        };
        let residual = given - load;
        let secant = secant(before, [load, residual]);
        let middle = if left < 1.0 { given } else { load };
        if (secant - middle).abs() <= left * residual.abs() {
            secant
        } else {
            middle
        }
    }

    /// The load to try after `load`, at which the law gave `given`.
    fn next(&mut self, load: f64, given: f64) -> f64 {
        let trial = [load, given - load];
        let before = self.last.replace(trial);
        let (own, other) = if trial[1] > 0.0 {
            (&mut self.low, &mut self.high)
        } else {
            (&mut self.high, &mut self.low)
        };
        if before.is_some_and(|b| b[1] * trial[1] > 0.0) {
            // Anderson and Björck, BIT 13 (1973) 253-264: an end that stays
            // while the other moves is given less weight.
            let left = 1.0 - trial[1] / own[1];
            other[1] *= if left > 0.0 { left } else { 0.5 };
        }
        *own = trial;
        match before {
            None => given,
            Some(_) if self.width().is_finite() => self.between(),
            Some(before) => ahead(before, trial),
        }
    }

    /// The secant's load between the two known, while they close in on each
    /// other; their middle otherwise.
    fn between(&mut self) -> f64 {
        let width = self.width();
        if width <= 0.5 * self.halved {
            (self.halved, self.since) = (width, 0);
        } else {
            self.since += 1;
        }
        let secant = secant(self.low, self.high);
        if self.low[0] < secant && secant < self.high[0] && self.since < 3 {
            secant
        } else {
            self.low[0] + 0.5 * width
        }
    }
}

/// Where the straight line through two trials has no residual.
fn secant(before: Trial, last: Trial) -> f64 {
    last[0] - last[1] * (last[0] - before[0]) / (last[1] - before[1])
}

/// The load to try where the residuals of all trials point the same way: the
/// secant's, if it is that way and no further than a law needs that takes back
/// 7/8 of a newton for each one; otherwise strides that double reach any load.
fn ahead(before: Trial, last: Trial) -> f64 {
    let [load, residual] = last;
    let step = secant(before, last) - load;
    if step * residual > 0.0 && step.abs() <= 8.0 * residual.abs() {
        return load + step;
    }
    let stride = 2.0 * (load - before[0]).abs().max(residual.abs());
    load + stride.copysign(residual)
}

#[cfg(test)]
mod tests;
