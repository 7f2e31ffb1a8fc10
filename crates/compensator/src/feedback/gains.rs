//! What a feedback runs on: model and gains at a few shares of sticking bristles.

use axis_scalar::Scalar;

use super::{MOST_MEASURED, MOST_STATES, NODES};
use crate::model::Cascade;

/// A vector of all states there is room for; those beyond the model's are 0.
pub type States<T> = [T; MOST_STATES];

/// Model and gains at one χ. Matrices by columns, so that a product is a sum of columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node<T = f64> {
    /// x(k+1) = A x + b u: A,
    pub a: [States<T>; MOST_STATES],
    /// and b.
    pub b: States<T>,
    /// x̂ = x̄ + L (y − C x̄), one column a measurement.
    pub l: [States<T>; MOST_MEASURED],
    /// u = −K x̂, the disturbance's cancellation among them.
    pub k: States<T>,
    /// Deviation of each measurement from what is expected of it, while the model is right: SI.
    pub expected: [T; MOST_MEASURED],
}

impl<T: Scalar> Node<T> {
    #[cfg(feature = "design")]
    pub(super) const ZERO: Self = Self {
        a: [[T::ZERO; MOST_STATES]; MOST_STATES],
        b: [T::ZERO; MOST_STATES],
        l: [[T::ZERO; MOST_STATES]; MOST_MEASURED],
        k: [T::ZERO; MOST_STATES],
        expected: [T::ZERO; MOST_MEASURED],
    };

    fn cast<U: Scalar>(&self) -> Node<U> {
        Node {
            a: self.a.map(cast_all),
            b: cast_all(self.b),
            l: self.l.map(cast_all),
            k: cast_all(self.k),
            expected: cast_all(self.expected),
        }
    }
}

/// All that a feedback's cycle needs and does not change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains<T = f64> {
    /// States that are in use.
    pub states: usize,
    /// Measurements that are in use.
    pub measured: usize,
    /// χ of the nodes, rising from 0 to 1.
    pub sticking: [T; NODES],
    /// The nodes.
    pub nodes: [Node<T>; NODES],
    /// Rows of y = C x, SI.
    pub c: [States<T>; MOST_MEASURED],
    /// Rows of the load's position and speed, m and m/s.
    pub load: [States<T>; 2],
    /// Force of one unit of the last state, N.
    pub force: T,
    /// Greatest command; u is in units of it.
    pub limit: T,
    /// Travel of the load per radian of the motor, m/rad.
    pub travel: T,
    /// Whether the motor's speed is a difference of angles.
    pub differences: bool,
    /// The drive's loops.
    pub cascade: Cascade<T>,
}

impl<T: Scalar> Gains<T> {
    /// Each number rounded to the nearest of another scalar.
    pub fn cast<U: Scalar>(&self) -> Gains<U> {
        Gains {
            states: self.states,
            measured: self.measured,
            sticking: cast_all(self.sticking),
            nodes: self.nodes.map(|node| node.cast()),
            c: self.c.map(cast_all),
            load: self.load.map(cast_all),
            force: cast(self.force),
            limit: cast(self.limit),
            travel: cast(self.travel),
            differences: self.differences,
            cascade: self.cascade.cast(),
        }
    }

    /// The two nodes around χ and the share of the upper one.
    pub fn around(&self, sticking: T) -> (&Node<T>, &Node<T>, T) {
        let mut i = 0;
        while i + 2 < NODES && sticking > self.sticking[i + 1] {
            i += 1;
        }
        let [low, high] = [self.sticking[i], self.sticking[i + 1]];
        let share = ((sticking - low) / (high - low)).max(T::ZERO).min(T::ONE);
        (&self.nodes[i], &self.nodes[i + 1], share)
    }
}

/// `to += (low + share (high − low)) x`, element by element.
#[inline(always)]
pub(super) fn add<T: Scalar>(
    to: &mut States<T>,
    low: &States<T>,
    high: &States<T>,
    share: T,
    x: T,
) {
    let upper = share * x;
    let lower = x - upper;
    for ((to, &low), &high) in to.iter_mut().zip(low).zip(high) {
        *to += low * lower + high * upper;
    }
}

/// Σ aᵢ bᵢ.
#[inline(always)]
pub(super) fn dot<T: Scalar>(a: &States<T>, b: &States<T>) -> T {
    // Four partial sums, so that the compiler can use vectors.
    let mut sums = [T::ZERO; 4];
    for (a, b) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        for ((sum, &a), &b) in sums.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

fn cast<T: Scalar, U: Scalar>(value: T) -> U {
    U::of(value.to_f64())
}

fn cast_all<T: Scalar, U: Scalar, const N: usize>(values: [T; N]) -> [U; N] {
    values.map(cast)
}
