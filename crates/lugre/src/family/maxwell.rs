//! Generalised Maxwell slip: elements side by side that stick and slip each for itself.

use super::error::FrictionError;
use super::steady::{SteadyState, check};
use super::{FrictionLaw, halves, pressing, sound};
use crate::exponential::Exponential;

/// Parameters of [`MaxwellSlip`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaxwellSlipParameters<T, const N: usize> {
    /// Friction of all elements together at constant speed.
    pub steady: SteadyState<T>,
    /// `α_i`, the share of each element in the level, greater than 0; their sum is 1 to
    /// within 1e-6 (1e-4 in `f32`).
    pub shares: [T; N],
    /// `k_i`, stiffness of each element, N/m or N·m/rad.
    pub stiffness: [T; N],
    /// `C`, with which the force of a slipping element follows the Stribeck curve, N/s or
    /// N·m/s. Without effect where the level is the same at all speeds.
    pub attraction: T,
}

/// What the elements of a [`MaxwellSlip`] remember.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaxwellState<T, const N: usize> {
    /// `F_i`, N or N·m.
    pub force: [T; N],
    /// Whether each slips.
    pub slips: [bool; N],
}

impl<T: Exponential, const N: usize> Default for MaxwellState<T, N> {
    fn default() -> Self {
        Self {
            force: [T::ZERO; N],
            slips: [false; N],
        }
    }
}

/// Generalised Maxwell slip (F. Al-Bender, V. Lampaert, J. Swevers, "The generalized
/// Maxwell-slip model: a novel model for friction simulation and compensation", IEEE Trans.
/// Automatic Control 50(11), 2005, doi 10.1109/TAC.2005.858676): N elements, each with
///
/// ```text
/// dF_i/dt = k_i v                          sticking, until F_i = α_i g(v) sign v
/// dF_i/dt = C (α_i sign v − F_i/g(v))      slipping, until v turns or is 0
/// F       = Σ F_i + v (k₁ + k₂ |v| + k₃ v²)
/// ```
///
/// (`C (…)` is written for `g > 0`). It has the memory of reversals of dry friction: an inner
/// loop closes. With one level at all speeds it is the plain Maxwell-slip model, a function
/// of displacement alone.
///
/// A step is exact at a constant speed, however long: an element that starts to slip is at its
/// steady force. With one level it is exact at any speed that does not turn more than once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaxwellSlip<T, const N: usize> {
    parameters: MaxwellSlipParameters<T, N>,
}

impl<T: Exponential, const N: usize> MaxwellSlip<T, N> {
    /// A law of validated parameters.
    ///
    /// # Errors
    /// [`FrictionError`] names the first parameter that is not acceptable; no element is one
    /// of them.
    pub fn new(parameters: MaxwellSlipParameters<T, N>) -> Result<Self, FrictionError> {
        const POSITIVE: &str = "finite and greater than 0";
        parameters.steady.validate()?;
        for share in parameters.shares {
            check("shares", share, POSITIVE, false)?;
        }
        for stiffness in parameters.stiffness {
            check("stiffness", stiffness, POSITIVE, false)?;
        }
        check("attraction", parameters.attraction, POSITIVE, false)?;
        // Not −0 of no elements.
        let sum = T::ZERO + parameters.shares.into_iter().sum();
        let close = if T::EPSILON > T::of(1e-10) {
            1e-4
        } else {
            1e-6
        };
        if (sum - T::ONE).abs() <= T::of(close) {
            Ok(Self { parameters })
        } else {
            Err(FrictionError::Invalid {
                field: "sum of shares",
                value: sum.to_f64(),
                valid: "1",
            })
        }
    }

    /// The parameters that the law was made from.
    #[must_use]
    pub fn parameters(&self) -> MaxwellSlipParameters<T, N> {
        self.parameters
    }

    /// The solution over `h` at a constant speed.
    fn slide(&self, mut state: MaxwellState<T, N>, speed: T, h: T) -> MaxwellState<T, N> {
        if speed.is_nan() || h.is_nan() {
            state.force = [T::NAN; N];
            return state;
        }
        if speed == T::ZERO {
            state.slips = [false; N];
        }
        if speed == T::ZERO || h <= T::ZERO {
            return state;
        }
        let p = &self.parameters;
        let level = p.steady.level(speed);
        let sign = T::ONE.copysign(speed);
        if level == T::ZERO {
            return MaxwellState::default();
        }
        let followed = (p.attraction / level * h).one_minus_exp();
        for i in 0..N {
            let (steady, along) = (p.shares[i] * level, sign * state.force[i]);
            let mut slips = state.slips[i] && along >= T::ZERO;
            let mut next = along;
            if !slips {
                next = along + p.stiffness[i] * speed.abs() * h;
                slips = next >= steady;
                if slips && along <= steady {
                    // It has slipped from its steady force on, and stays there.
                    next = steady;
                } else if slips {
                    // The level has fallen while it stuck.
                    next = along + (steady - along) * followed;
                }
            } else if along != steady {
                next = along + (steady - along) * followed;
            }
            state.force[i] = sign * next;
            state.slips[i] = slips;
        }
        state
    }

    /// A state to begin a step from.
    fn begin(&self, mut state: MaxwellState<T, N>) -> MaxwellState<T, N> {
        if !state.force.iter().all(|force| force.is_finite()) {
            return MaxwellState::default();
        }
        let [least, greatest] = self.spring_limits();
        for (force, share) in state.force.iter_mut().zip(self.parameters.shares) {
            *force = sound(*force, [share * least, share * greatest]);
        }
        state
    }
}

impl<T: Exponential, const N: usize> FrictionLaw<T> for MaxwellSlip<T, N> {
    type State = MaxwellState<T, N>;

    fn step(&self, state: Self::State, v0: T, v1: T, h: T) -> Self::State {
        halves(self.begin(state), [v0, v1], h, |state, speed, h| {
            self.slide(state, speed, h)
        })
    }

    fn force_at_load(&self, state: &Self::State, speed: T, load: T) -> T {
        pressing(load) * self.spring_force(state) + self.parameters.steady.viscous_force(speed)
    }

    fn steady_state(&self, speed: T) -> T {
        self.parameters.steady.force(speed)
    }

    fn settled(&self, speed: T) -> Self::State {
        if speed == T::ZERO {
            return Self::State::default();
        }
        let level = self.parameters.steady.level(speed).copysign(speed);
        MaxwellState {
            force: self.parameters.shares.map(|share| share * level),
            slips: [true; N],
        }
    }

    fn stiffness(&self) -> T {
        self.parameters.stiffness.into_iter().sum()
    }

    fn spring_limits(&self) -> [T; 2] {
        let steady = &self.parameters.steady;
        [-steady.backward.stiction, steady.forward.stiction]
    }

    fn spring_force(&self, state: &Self::State) -> T {
        state.force.into_iter().sum()
    }

    /// `Σ F_i²/(2 k_i)`, J.
    fn stored_energy(&self, state: &Self::State) -> T {
        let of = |(force, stiffness): (T, T)| T::HALF * force * (force / stiffness);
        let elements = state.force.into_iter().zip(self.parameters.stiffness);
        elements.map(of).sum()
    }

    /// With one level at all speeds: a sticking element stores what it is given, and a slipping
    /// one keeps its force. On a Stribeck curve a slipping element can be drawn up by falling
    /// speed faster than the motion pays for.
    fn is_passive(&self) -> bool {
        self.parameters.steady.is_level()
    }
}
