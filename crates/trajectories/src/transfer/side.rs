//! The motions that go as far as possible in their time: what a time-optimal transfer is chosen from.
//!
//! For a given duration T the velocities that lead from one state to another form a convex set, so the
//! displacements that can be had are an interval, and a least duration lies on one of its two ends. The greatest
//! displacement belongs to a jerk whose switching function is a parabola open to the top (Pontryagin's principle; the
//! adjoint of the position is 1): +J, −J, +J, with stretches at the limits of acceleration and velocity between. The
//! least displacement is the mirror image. Each such motion is given by the acceleration `a` at which its first
//! segment ends and the acceleration `b` at which its last one begins:
//!
//! ```text
//! jerk          +J      0      −J     (0)    −J      0      +J
//! acceleration  a₀ → a  a      a → 0   0      0 → b   b      b → a₁
//! ```
//!
//! All values here are divided by J, so that J = 1 and the only unit is the second: acceleration s, velocity s²,
//! distance s³.
//!
//! With c = v₀ − a₀²/2 and e = v₁ − a₁²/2, the velocities at which the first and the last segment cross a = 0, the
//! change of velocity asks for a² − b² + a h₁ + b h₂ = e − c = k, h₁ and h₂ being the times at `a` and `b`. Along
//! each family the slope of the displacement over the duration is the Hamiltonian of the problem,
//! H = v(A) + a (a − b)/2 with v(A) the velocity as `a` is left; its zeros are those of a quadratic polynomial,
//! so that the displacement is split into monotone stretches in closed form, and each root is bracketed.

mod families;

use crate::Real;
use families::{FAMILIES, Family};

/// One direction of a transfer: its greatest displacement.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side<T> {
    /// Acceleration at the start and at the end, s.
    pub from: T,
    pub to: T,
    /// Velocities at which first and last segment cross zero acceleration, s².
    c: T,
    e: T,
    /// e − c, s²; zero if it is one of rounding.
    k: T,
    /// Rounding of k, s².
    k_noise: T,
    /// Displacement of the first segment up to, and of the last from, zero acceleration, s³.
    base: T,
    /// Limits: greatest acceleration, greatest deceleration (s), greatest velocity (s²).
    most: T,
    brake: T,
    fast: T,
    /// Wanted displacement, and how far it is known, s³.
    distance: T,
    distance_noise: T,
    /// Whether the first segment must not cross zero acceleration: the velocity would be below its limit there.
    one_way: bool,
}

/// What a transfer is made for, divided by J.
#[derive(Clone, Copy, Debug)]
pub(super) struct Task<T> {
    /// Velocity and acceleration at the start and at the end.
    pub start: [T; 2],
    pub end: [T; 2],
    pub distance: T,
    /// Differences of velocity and of distance that count as rounding: see `with_noise`.
    pub velocity_noise: T,
    pub distance_noise: T,
    /// Greatest acceleration, deceleration, velocity, and greatest velocity backwards; all above zero.
    pub most: T,
    pub brake: T,
    pub fast: T,
    pub back: T,
}

impl<T: Real> Task<T> {
    /// The same task seen from the other side.
    pub fn mirror(&self) -> Self {
        let turn = |x: [T; 2]| [-x[0], -x[1]];
        Self {
            start: turn(self.start),
            end: turn(self.end),
            distance: -self.distance,
            most: self.brake,
            brake: self.most,
            fast: self.back,
            back: self.fast,
            ..*self
        }
    }

    /// Sets what counts as rounding, with the positions (s³) between which the task is.
    ///
    /// Where one duration alone leads from a state to another, as on the last segments of every motion, the displacement
    /// must fit to the last place, and a state that a plan has led to does so to rounding only. That rounding is of
    /// the size of what went before: of a motion that reaches an acceleration p as the limits allow, a velocity w,
    /// and w²/p of distance. A velocity limit that is none, far above p², does not count in full.
    pub fn with_noise(mut self, positions: T) -> Self {
        let p = self
            .most
            .max(self.brake)
            .min(self.fast.max(self.back).sqrt());
        let w = self.fast.max(self.back).min(T::of(32.0) * p * p);
        let [v0, a0] = self.start;
        let [v1, a1] = self.end;
        self.velocity_noise = T::END_MARGIN * (v0.abs() + v1.abs() + a0 * a0 + a1 * a1 + w);
        self.distance_noise = T::END_MARGIN * (w * (w / p) + positions);
        self
    }
}

/// A motion of a family: peaks (s), times at them (s), time at the greatest velocity (s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shape<T> {
    pub a: T,
    pub b: T,
    pub at_a: T,
    pub at_b: T,
    pub cruise: T,
}

/// The motion found so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Best<T> {
    /// Least duration asked for, s.
    pub at_least: T,
    pub total: T,
    pub shape: Option<Shape<T>>,
    /// Whether it is the mirror image that was found.
    pub mirrored: bool,
}

impl<T: Real> Best<T> {
    pub fn none(at_least: T) -> Self {
        Self {
            at_least,
            total: T::INFINITY,
            shape: None,
            mirrored: false,
        }
    }
}

impl<T: Real> Side<T> {
    pub fn new(task: &Task<T>) -> Self {
        let ([v0, a0], [v1, a1]) = (task.start, task.end);
        let (c, e) = (v0 - T::HALF * a0 * a0, v1 - T::HALF * a1 * a1);
        let sixth = T::of(1.0 / 6.0);
        let k_noise = task.velocity_noise;
        let k = (v1 - v0) + T::HALF * (a0 - a1) * (a0 + a1);
        Self {
            from: a0,
            to: a1,
            c,
            e,
            k: if k.abs() <= k_noise { T::ZERO } else { k },
            k_noise,
            base: a1 * (e + sixth * a1 * a1) - a0 * (c + sixth * a0 * a0),
            most: task.most,
            brake: task.brake,
            fast: task.fast,
            distance: task.distance,
            distance_noise: task.distance_noise,
            one_way: a0 < T::ZERO && c < -task.back - k_noise,
        }
    }

    /// Duration of a motion, s.
    pub fn total(&self, shape: &Shape<T>) -> T {
        T::TWO * (shape.a - shape.b)
            + (self.to - self.from)
            + (shape.at_a + shape.at_b + shape.cruise)
    }

    /// Durations of the seven segments, s.
    pub fn times(&self, shape: &Shape<T>) -> [T; 7] {
        let Shape { a, b, .. } = *shape;
        let (down, down_on) = if shape.cruise > T::ZERO {
            (a, -b)
        } else {
            (a - b, T::ZERO)
        };
        [
            a - self.from,
            shape.at_a,
            down,
            shape.cruise,
            down_on,
            shape.at_b,
            self.to - b,
        ]
    }

    /// By how much a motion goes farther than wanted, and the rounding of that, s³.
    fn miss(&self, shape: &Shape<T>) -> (T, T) {
        let Shape { a, b, .. } = *shape;
        let sixth = T::of(1.0 / 6.0);
        let u = a - b;
        let reached = self.c + T::HALF * a * a;
        let left = reached + a * shape.at_a;
        let last = self.e + T::HALF * b * b;
        let travel = self.base
            + a * (self.c + sixth * a * a)
            + shape.at_a * (reached + T::HALF * a * shape.at_a)
            + u * (left + u * (T::HALF * a - sixth * u))
            + shape.cruise * self.fast
            + shape.at_b * (last - T::HALF * b * shape.at_b)
            - b * (self.e + sixth * b * b);
        let speed = self.c.abs() + self.e.abs() + a * a + b * b + left.abs();
        let length = a.abs()
            + b.abs()
            + self.from.abs()
            + self.to.abs()
            + shape.at_a
            + shape.at_b
            + shape.cruise;
        let rounding = T::of(4.0) * T::EPSILON * speed * length;
        (travel - self.distance, rounding + self.distance_noise)
    }

    /// The fastest motion that takes the least time not below that asked for and ends where wanted.
    pub fn search(&self, mirrored: bool, best: &mut Best<T>) {
        let before = best.total;
        self.straight(best);
        for family in FAMILIES {
            let turns = self.stationary(family);
            for (low, high) in self.stretches(family) {
                self.monotone(family, (low, high), turns, best);
            }
        }
        self.cruising(best);
        if best.total < before {
            best.mirrored = mirrored;
        }
    }

    fn offer(&self, shape: Shape<T>, best: &mut Best<T>) {
        let total = self.total(&shape);
        if total < best.total && total >= best.at_least {
            best.total = total;
            best.shape = Some(shape);
        }
    }

    /// A single segment of full jerk, on which no turn is to be found.
    fn straight(&self, best: &mut Best<T>) {
        let crosses = self.one_way && self.to > T::ZERO;
        if self.k == T::ZERO && self.to >= self.from && !crosses {
            let shape = self.line();
            let (miss, noise) = self.miss(&shape);
            if miss.abs() <= noise {
                self.offer(shape, best);
            }
        }
    }

    fn line(&self) -> Shape<T> {
        Shape {
            a: self.to,
            b: self.to,
            at_a: T::ZERO,
            at_b: T::ZERO,
            cruise: T::ZERO,
        }
    }

    /// Divides a stretch where the displacement turns.
    fn monotone(&self, family: Family, (low, high): (T, T), turns: [T; 2], best: &mut Best<T>) {
        if low > high {
            return;
        }
        let mut at = low;
        let (one, two) = (turns[0].min(turns[1]), turns[0].max(turns[1]));
        for turn in [one, two] {
            if turn > at && turn < high {
                self.root(family, at, turn, best);
                at = turn;
            }
        }
        self.root(family, at, high, best);
    }

    /// Where the displacement is that wanted, between two values of the variable.
    fn root(&self, family: Family, low: T, high: T, best: &mut Best<T>) {
        let first = self.shape(family, low);
        if self.total(&first) >= best.total {
            return;
        }
        let last = self.shape(family, high);
        if self.total(&last) < best.at_least {
            return;
        }
        let (miss, noise) = self.miss(&first);
        let below = miss < T::ZERO;
        if miss.abs() <= noise {
            self.offer(first, best);
        }
        let (miss, noise) = self.miss(&last);
        if (miss < T::ZERO) == below {
            if miss.abs() <= noise {
                self.offer(last, best);
            }
            return;
        }
        let x = self.bracketed(family, (low, high), below);
        self.offer(self.shape(family, x), best);
    }

    /// Newton's method, halving where it would leave the bracket or closes it too slowly.
    fn bracketed(&self, family: Family, (mut low, mut high): (T, T), below: bool) -> T {
        let mut x = T::HALF * (low + high);
        let mut last_step = high - low;
        for _ in 0..200 {
            let (miss, _) = self.miss(&self.shape(family, x));
            if miss == T::ZERO {
                return x;
            }
            if (miss < T::ZERO) == below {
                low = x;
            } else {
                high = x;
            }
            let newton = x - miss / self.slope(family, x);
            let inside = newton > low && newton < high;
            let next = if inside && (newton - x).abs() < T::HALF * last_step {
                newton
            } else {
                T::HALF * (low + high)
            };
            last_step = (next - x).abs();
            let width = T::EPSILON * (low.abs() + high.abs());
            if last_step <= T::HALF * width || next <= low || next >= high {
                return next.max(low).min(high);
            }
            x = next;
        }
        x
    }

    /// To the greatest velocity and from it, with no time at it; none if the start must exceed it.
    fn halves(&self) -> Option<Shape<T>> {
        let exceeds =
            self.from > T::ZERO && self.c + self.from * self.from > self.fast + self.k_noise;
        if exceeds || self.one_way {
            return None;
        }
        let half = |limit: T, crossing: T| {
            let peak = self.peak_of(crossing);
            if peak > limit {
                (limit, (self.fast - crossing) / limit - limit)
            } else {
                (peak, T::ZERO)
            }
        };
        let (a, at_a) = half(self.most, self.c);
        let (b, at_b) = half(self.brake, self.e);
        Some(Shape {
            a: a.max(self.from),
            b: (-b).min(self.to),
            at_a,
            at_b,
            cruise: T::ZERO,
        })
    }

    fn cruising(&self, best: &mut Best<T>) {
        let Some(mut shape) = self.halves() else {
            return;
        };
        let (miss, noise) = self.miss(&shape);
        if miss <= noise {
            shape.cruise = (-miss).max(T::ZERO) / self.fast;
            self.offer(shape, best);
        }
    }

    /// The motion that goes as far as possible in `total` s, and by how much farther than wanted (s³); none if that
    /// duration admits no motion between the two states.
    pub fn farthest(&self, total: T) -> Option<(Shape<T>, T, T)> {
        let rounding = T::of(16.0) * T::EPSILON;
        if let Some(halves) = self.halves() {
            let cruise = total - self.total(&halves);
            if cruise >= T::ZERO {
                return Some(self.with_miss(Shape { cruise, ..halves }));
            }
        }
        let swing = total - (self.to - self.from);
        let (most, brake, k) = (self.most, self.brake, self.k);
        if k == T::ZERO && swing.abs() <= rounding * total && self.to >= self.from {
            return Some(self.with_miss(self.line()));
        }
        for family in FAMILIES {
            let x = match family {
                Family::Free => T::HALF * swing,
                Family::First => (most * swing - k).sqrt() - most,
                Family::Second => (brake * swing + k).sqrt() - brake,
                Family::Both => {
                    let least = T::TWO * (most + brake);
                    let over = ((most - brake) * (most + brake) - k) / brake;
                    (swing - least - over) / (T::ONE + most / brake)
                }
            };
            let slack = rounding * (total + most + brake);
            for (low, high) in self.stretches(family) {
                if low <= high && x >= low - slack && x <= high + slack {
                    let shape = self.shape(family, x.max(low).min(high));
                    return Some(self.with_miss(shape));
                }
            }
        }
        None
    }

    fn with_miss(&self, shape: Shape<T>) -> (Shape<T>, T, T) {
        let (miss, noise) = self.miss(&shape);
        (shape, miss, noise)
    }
}
