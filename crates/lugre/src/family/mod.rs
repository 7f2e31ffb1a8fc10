//! A family of friction laws behind one trait.

mod bristle;
mod classic_bouc_wen;
mod error;
mod lugre;
mod maxwell;
mod onset;
mod static_stribeck;
mod steady;

use core::fmt::Debug;

use axis_scalar::Scalar;

pub use bristle::{BoucWen, Bristle, BristleParameters, Dahl, ElastoPlastic, GeneralLuGre};
pub use classic_bouc_wen::ClassicBoucWen;
pub use error::FrictionError;
pub use maxwell::{MaxwellSlip, MaxwellSlipParameters, MaxwellState};
pub use onset::{BoucWenOnset, DahlOnset, ElastoPlasticOnset, LinearOnset, Onset};
pub use static_stribeck::{Regularisation, StaticFriction, StaticFrictionParameters};
pub use steady::{FrictionLevel, SteadyState};

/// A friction law: a force or torque that depends on the sliding speed and on a state.
///
/// A law is immutable; the state is the caller's and begins as `State::default()`, the
/// contact unloaded at rest. No method allocates or panics, whatever the numbers.
///
/// # Units
/// N, m, m/s and kg of a linear contact, or N·m, rad, rad/s and kg·m² of a rotary one. The
/// force is positive where it opposes positive speed.
///
/// # Load
/// Dry friction is proportional to the normal load, the viscous part is not. `load` is the
/// normal load over the one that the parameters stand for; below 0 the surfaces are apart,
/// which is a load of 0. The states are deflections and forces at the load 1, so that a
/// change of the load alone keeps every bound (the load enters as in C. Canudas de Wit and
/// P. Tsiotras, "Dynamic tire friction models for vehicle traction control", CDC 1999).
///
/// # Numbers that are none
/// A NaN speed or time gives a state and a force of NaN, so that it is noticed. It does not
/// stay: a step from a state that is not finite begins at the unloaded contact again. A state
/// beyond its bounds is taken as at them, and a time below 0 as 0.
///
/// ```
/// use lugre::{BristleParameters, Dahl, DahlOnset, FrictionLaw, SteadyState};
///
/// fn work_of_one_cycle<L: FrictionLaw<f64>>(law: &L) -> f64 {
///     let (h, mut state, mut work) = (1e-4, L::State::default(), 0.0);
///     for k in 0..20_000 {
///         let speed = |k: i32| 0.01 * (f64::from(k) * h * core::f64::consts::TAU).cos();
///         state = law.step(state, speed(k), speed(k + 1), h);
///         if k >= 10_000 {
///             work += law.force(&state, speed(k + 1)) * speed(k + 1) * h;
///         }
///     }
///     work
/// }
///
/// let dahl = Dahl::new(BristleParameters {
///     steady: SteadyState::coulomb(60.0), // N
///     stiffness: 6e6,                     // N/m
///     damping: 0.0,
///     onset: DahlOnset { exponent: 1.0 },
/// })?;
/// let work = work_of_one_cycle(&dahl); // J, over 4 · 1.59 mm
/// assert!((work - 0.380).abs() < 0.001);
/// # Ok::<(), lugre::FrictionError>(())
/// ```
pub trait FrictionLaw<T: Scalar> {
    /// What the contact remembers.
    type State: Copy + Default + PartialEq + Debug;

    /// The state after a step of `h` seconds in which the speed goes linearly from `v0` to
    /// `v1` (m/s or rad/s). The speed is held at its mean, and the step split where it changes
    /// sign: second order in `h`, and at a constant speed as exact as the law's page says.
    #[must_use]
    fn step(&self, state: Self::State, v0: T, v1: T, h: T) -> Self::State;

    /// The force or torque, N or N·m, at a speed and at a normal load (see above).
    #[must_use]
    fn force_at_load(&self, state: &Self::State, speed: T, load: T) -> T;

    /// [`force_at_load`](Self::force_at_load) of the load 1, N or N·m.
    #[must_use]
    fn force(&self, state: &Self::State, speed: T) -> T {
        self.force_at_load(state, speed, T::ONE)
    }

    /// The force or torque at a constant speed, N or N·m; 0 at rest.
    #[must_use]
    fn steady_state(&self, speed: T) -> T;

    /// The state at a constant speed; unloaded at rest, where it is one of many.
    #[must_use]
    fn settled(&self, speed: T) -> Self::State;

    /// Force over displacement of the unloaded contact, N/m or N·m/rad; 0 of a law without
    /// deflection.
    #[must_use]
    fn stiffness(&self) -> T;

    /// Least and greatest force of the springs, N or N·m: no motion drives them beyond.
    #[must_use]
    fn spring_limits(&self) -> [T; 2];

    /// The force of the springs in a state, N or N·m; 0 of a law without.
    #[must_use]
    fn spring_force(&self, state: &Self::State) -> T;

    /// Energy stored in a state, J.
    #[must_use]
    fn stored_energy(&self, state: &Self::State) -> T;

    /// Whether it is proven that no motion whatever draws more energy from the law than is
    /// [stored](Self::stored_energy) in it. `false` does not mean that a motion does.
    #[must_use]
    fn is_passive(&self) -> bool;
}

/// The load that counts; NaN stays.
#[inline]
fn pressing<T: Scalar>(load: T) -> T {
    if load < T::ZERO { T::ZERO } else { load }
}

/// A deflection or a force to begin a step from.
#[inline]
fn sound<T: Scalar>(value: T, [least, greatest]: [T; 2]) -> T {
    if !value.is_finite() {
        T::ZERO
    } else if value > greatest {
        greatest
    } else if value < least {
        least
    } else {
        value
    }
}

/// Calls `hold(state, mean speed, time)` once, or twice where the linear speed changes sign.
#[inline]
fn halves<T: Scalar, S>(state: S, [v0, v1]: [T; 2], h: T, hold: impl Fn(S, T, T) -> S) -> S {
    let opposite = (v0 < T::ZERO && v1 > T::ZERO) || (v0 > T::ZERO && v1 < T::ZERO);
    if !opposite {
        return hold(state, T::HALF * v0 + T::HALF * v1, h);
    }
    // Halves, whose difference cannot overflow.
    let before = h * (T::HALF * v0 / (T::HALF * v0 - T::HALF * v1));
    let state = hold(state, T::HALF * v0, before);
    hold(state, T::HALF * v1, h - before)
}
