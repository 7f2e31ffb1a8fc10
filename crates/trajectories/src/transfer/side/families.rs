//! The families of motions that go as far as possible, each by one variable.

use super::{Shape, Side};
use crate::Real;

/// Which limits of acceleration the motion reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Family {
    /// None; the variable is u = a − b, with a + b = k/u.
    Free,
    /// The first; the variable is −b.
    First,
    /// The second; the variable is a.
    Second,
    /// Both; the variable is the time at the first.
    Both,
}

pub(super) const FAMILIES: [Family; 4] =
    [Family::Free, Family::First, Family::Second, Family::Both];

/// Two ranges of a variable, each with the lesser end first.
pub(super) type Stretches<T> = [(T, T); 2];

impl<T: Real> Side<T> {
    /// The motion of a family for its variable.
    pub(super) fn shape(&self, family: Family, x: T) -> Shape<T> {
        let zero = T::ZERO;
        let (most, brake) = (self.most, self.brake);
        let (a, b, at_a, at_b) = match family {
            Family::Free => {
                let sum = if self.k == zero { zero } else { self.k / x };
                (T::HALF * (sum + x), T::HALF * (sum - x), zero, zero)
            }
            Family::First => {
                let at_a = (self.k - (most - x) * (most + x)) / most;
                (most, -x, at_a.max(zero), zero)
            }
            Family::Second => {
                let at_b = ((x - brake) * (x + brake) - self.k) / brake;
                (x, -brake, zero, at_b.max(zero))
            }
            Family::Both => {
                let at_b = ((most - brake) * (most + brake) + most * x - self.k) / brake;
                (most, -brake, x, at_b.max(zero))
            }
        };
        let (from, to) = (self.from, self.to);
        Shape {
            a: a.max(from).min(most.max(from)),
            b: b.min(to).max((-brake).min(to)),
            at_a,
            at_b,
            cruise: zero,
        }
    }

    /// Slope of the displacement over the variable of a family: H times that of the duration.
    pub(super) fn slope(&self, family: Family, x: T) -> T {
        let (most, brake) = (self.most, self.brake);
        match family {
            Family::Free => {
                let sum = if self.k == T::ZERO {
                    T::ZERO
                } else {
                    self.k / x
                };
                self.c + self.e + T::of(0.25) * (T::of(3.0) * x * x + sum * sum)
            }
            Family::First => {
                let h = self.e + x * (x + T::HALF * most);
                T::TWO * (T::ONE + x / most) * h
            }
            Family::Second => {
                let h = self.c + x * (x + T::HALF * brake);
                T::TWO * (T::ONE + x / brake) * h
            }
            Family::Both => {
                let h = self.c + most * (most + x + T::HALF * brake);
                (T::ONE + most / brake) * h
            }
        }
    }

    /// Where that slope may be zero; NaN where it is not.
    pub(super) fn stationary(&self, family: Family) -> [T; 2] {
        // x² + p x + q = 0, the root of greater magnitude first.
        let quadratic = |p: T, q: T| {
            let half = T::HALF * p;
            let far = -(half + (half * half - q).sqrt().copysign(half));
            [far, if far == T::ZERO { far } else { q / far }]
        };
        match family {
            Family::Free => {
                let third = T::of(1.0 / 3.0);
                let p = T::of(4.0) * third * (self.c + self.e);
                quadratic(p, third * self.k * self.k).map(T::sqrt)
            }
            Family::First => quadratic(T::HALF * self.most, self.e),
            Family::Second => quadratic(T::HALF * self.brake, self.c),
            Family::Both => {
                let x = -(self.c / self.most + self.most + T::HALF * self.brake);
                [x, x]
            }
        }
    }

    /// Deceleration, and acceleration, whose peak of velocity is the greatest allowed.
    pub(super) fn peak_of(&self, crossing: T) -> T {
        let square = self.fast - crossing;
        if square > self.k_noise {
            square.sqrt()
        } else {
            T::ZERO
        }
    }

    /// Stretches of the variable, each with the lesser end first, in which a family obeys all limits; an empty one
    /// has its ends the other way round.
    pub(super) fn stretches(&self, family: Family) -> Stretches<T> {
        let (none, zero) = ((T::ONE, T::ZERO), T::ZERO);
        let (most, brake, k) = (self.most, self.brake, self.k);
        let about = |low: T, high: T, square: T| {
            if square > self.k_noise {
                let s = square.sqrt();
                [(low, high.min(-s)), (low.max(s), high)]
            } else {
                [(low, high), none]
            }
        };
        match family {
            Family::Free => self.free(),
            Family::First | Family::Both if self.one_way => [none; 2],
            Family::First => {
                let high = brake.min(self.peak_of(self.e));
                about(-self.to.min(most), high, most * most - k)
            }
            Family::Second => {
                let high = self.highest().min(self.peak_of(self.c));
                about(self.from.max(-brake), high, brake * brake + k)
            }
            Family::Both => {
                let low = (k - (most - brake) * (most + brake)) / most;
                let high = (self.fast - self.c) / most - most;
                [(low.max(zero), high), none]
            }
        }
    }

    /// Greatest acceleration at which the first segment may end.
    fn highest(&self) -> T {
        if self.one_way { T::ZERO } else { self.most }
    }

    /// As [`stretches`](Self::stretches), of u = a − b: each limit is a quadratic inequality in u.
    fn free(&self) -> Stretches<T> {
        let (zero, none) = (T::ZERO, (T::ONE, T::ZERO));
        let (k, from, to) = (self.k, self.from, self.to);
        let upward = k >= zero;
        // A velocity has a peak where a > 0 > b; with k ≥ 0, a cannot be below zero, nor else b above.
        let (most, brake) = if upward {
            (self.highest(), self.brake.min(self.peak_of(self.e)))
        } else {
            (self.highest().min(self.peak_of(self.c)), self.brake)
        };
        // a ≤ most: u² − 2 most u + k ≤ 0; b ≥ −brake: u² − 2 brake u − k ≤ 0.
        let (rise, fall) = (most * most - k, brake * brake + k);
        if rise < -self.k_noise || fall < -self.k_noise {
            return [none; 2];
        }
        let high_a = most + rise.max(zero).sqrt();
        let high_b = brake + fall.max(zero).sqrt();
        let high = high_a.min(high_b);
        let mut low = if upward {
            k / high_a.max(T::MIN_POSITIVE)
        } else {
            -k / high_b.max(T::MIN_POSITIVE)
        };
        // a ≥ from: u² − 2 from u + k ≥ 0; b ≤ to: u² + 2 to u − k ≥ 0. Each forbids what lies between its roots.
        let roots = |half: T, k: T| {
            let square = half * half - k;
            if square <= self.k_noise && k > zero {
                return (half, half);
            }
            let s = square.max(zero).sqrt();
            if half > zero {
                (k / (half + s), half + s)
            } else {
                let far = s - half;
                (half - s, if far > zero { -k / far } else { zero })
            }
        };
        let (first, last) = (roots(from, k), roots(-to, -k));
        let (edge, gap) = if upward { (last, first) } else { (first, last) };
        low = low.max(edge.1).max(zero);
        if k == zero {
            // a = −b = u/2: what lies below the upper roots has none, but for u = 0, the single segment.
            return [(low.max(gap.1), high), none];
        }
        if gap.1 > low && gap.1 > gap.0 {
            [(low, high.min(gap.0)), (low.max(gap.1), high)]
        } else {
            [(low, high), none]
        }
    }
}
