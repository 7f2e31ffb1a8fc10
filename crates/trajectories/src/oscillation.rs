//! Sines and chirps about a position, from rest to rest.

use crate::envelope::{Envelope, RISE_DERIVATIVE_BOUNDS, rise};
use crate::error::{check, duration, frequency, position, unrepresentable};
use crate::sweep::Phase;
use crate::{Extremes, Motion, Real, Setpoint, Sweep, TrajectoryError};

/// A sine of constant frequency.
///
/// The amplitude rises over one cycle before the `cycles` at full amplitude and falls over one
/// cycle after them: the whole lasts `(cycles + 2) / frequency`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sine<T = f64> {
    /// Amplitude, m; negative to set out in the negative direction.
    pub amplitude: T,
    /// Frequency, Hz, from 1e-9 to [`maximum::FREQUENCY`](crate::maximum::FREQUENCY).
    pub frequency: T,
    /// Cycles at full amplitude, at least one.
    pub cycles: u32,
}

/// A sine whose frequency runs from one value to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chirp<T = f64> {
    /// Amplitude, m; negative to set out in the negative direction.
    pub amplitude: T,
    /// Frequency at the start, Hz, from 1e-9 to [`maximum::FREQUENCY`](crate::maximum::FREQUENCY).
    pub from_frequency: T,
    /// Frequency at the end, Hz, within the same; may be the lower one.
    pub to_frequency: T,
    /// Whole length, both ramps included, s; at most [`maximum::DURATION`](crate::maximum::DURATION).
    pub duration: T,
    /// Length of the rise of the amplitude at the start and of its fall at the end, s: greater
    /// than zero, at most half the duration. The frequency runs during the ramps too.
    pub ramp: T,
    /// Course of the frequency.
    pub sweep: Sweep,
}

/// A sine or chirp `s(t) = s₀ + A w(t) sin φ(t)`, with φ(0) = 0 and w the amplitude factor.
///
/// The factor rises and falls by the polynomial x³(10 − 15x + 6x²), so position, velocity and
/// acceleration are continuous everywhere, also with the rests before and after; the jerk is
/// bounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillation<T = f64> {
    about: T,
    amplitude: T,
    phase: Phase<T>,
    envelope: Envelope<T>,
    extremes: Extremes<T>,
}

/// Pieces into which a ramp is cut to bound its derivatives: more would narrow the bounds little.
/// Costs some microseconds, once.
const RAMP_PIECES: u32 = 128;

impl<T: Real> Oscillation<T> {
    /// A sine about the position `about` (m).
    ///
    /// # Errors
    /// [`TrajectoryError::Invalid`] naming the field that is out of its range.
    pub fn sine(about: T, sine: &Sine<T>) -> Result<Self, TrajectoryError> {
        let frequency = frequency("frequency", sine.frequency)?;
        let cycles = T::count(sine.cycles);
        check(sine.cycles > 0, "cycles", cycles, "", "1 or more")?;
        let phase = Phase::Linear {
            frequency,
            slope: T::ZERO,
        };
        let envelope = Envelope {
            duration: duration((cycles + T::TWO) / frequency)?,
            ramp: T::ONE / frequency,
        };
        Self::new(about, sine.amplitude, phase, envelope)
    }

    /// A chirp about the position `about` (m).
    ///
    /// # Errors
    /// [`TrajectoryError::Invalid`] naming the field that is out of its range.
    pub fn chirp(about: T, chirp: &Chirp<T>) -> Result<Self, TrajectoryError> {
        let f0 = frequency("from_frequency", chirp.from_frequency)?;
        let f1 = frequency("to_frequency", chirp.to_frequency)?;
        let duration = duration(chirp.duration)?;
        check(
            chirp.ramp > T::ZERO && chirp.ramp <= T::HALF * duration,
            "ramp",
            chirp.ramp,
            "s",
            "greater than zero and at most half the duration",
        )?;
        let phase = Phase::new(f0, f1, duration, chirp.sweep);
        let envelope = Envelope {
            duration,
            ramp: chirp.ramp,
        };
        Self::new(about, chirp.amplitude, phase, envelope)
    }

    fn new(
        about: T,
        amplitude: T,
        phase: Phase<T>,
        envelope: Envelope<T>,
    ) -> Result<Self, TrajectoryError> {
        position("about", about)?;
        position("amplitude", amplitude)?;
        check(
            phase.cycles(envelope.duration) <= T::MAX_CYCLES,
            "total cycles",
            phase.cycles(envelope.duration),
            "",
            T::VALID_CYCLES,
        )?;
        let extremes = bounds(about, amplitude.abs(), &phase, &envelope);
        let ends = [extremes.position_min, extremes.position_max];
        let rates = [extremes.velocity, extremes.acceleration, extremes.jerk];
        if !ends.iter().chain(&rates).all(|x| x.is_finite()) {
            let what = "the oscillation's velocity, acceleration or jerk";
            return Err(unrepresentable::<T>(what));
        }
        Ok(Self {
            about,
            amplitude,
            phase,
            envelope,
            extremes,
        })
    }

    /// Position it starts from, swings about and ends at, m.
    pub const fn about(&self) -> T {
        self.about
    }

    /// Time during which the amplitude is full: begin and end, s after the start.
    pub fn full_amplitude(&self) -> (T, T) {
        let Envelope { duration, ramp } = self.envelope;
        (ramp, duration - ramp)
    }

    /// Safe bounds on position, velocity, acceleration and jerk.
    pub const fn extremes(&self) -> Extremes<T> {
        self.extremes
    }
}

impl<T: Real> Motion<T> for Oscillation<T> {
    #[inline]
    fn duration(&self) -> T {
        self.envelope.duration
    }

    fn at(&self, t: T) -> Setpoint<T> {
        // Written so that NaN is caught too.
        if !(t >= T::ZERO && t < self.envelope.duration) {
            return Setpoint::at_rest(self.about);
        }
        let [w, w1, w2, w3] = self.envelope.at(t);
        let [p1, p2, p3] = self.phase.derivatives(t);
        let (sin, cos) = self.phase.sin_cos(t);
        let amplitude = self.amplitude;
        // d/dt, d²/dt² and d³/dt³ of w sin φ.
        let velocity = w1 * sin + w * p1 * cos;
        let acceleration = (w2 - w * p1 * p1) * sin + (T::TWO * w1 * p1 + w * p2) * cos;
        let three = T::of(3.0);
        let jerk_sin = w3 - three * p1 * (w1 * p1 + w * p2);
        let jerk_cos = three * (w2 * p1 + w1 * p2) + w * (p3 - p1 * p1 * p1);
        Setpoint {
            position: self.about + amplitude * (w * sin),
            velocity: amplitude * velocity,
            acceleration: amplitude * acceleration,
            jerk: amplitude * (jerk_sin * sin + jerk_cos * cos),
        }
    }
}

/// Safe bounds on `about + amplitude · w sin φ` and its derivatives.
fn bounds<T: Real>(
    about: T,
    amplitude: T,
    phase: &Phase<T>,
    envelope: &Envelope<T>,
) -> Extremes<T> {
    let (ramp, duration) = (envelope.ramp, envelope.duration);
    // At full amplitude, where each derivative of the phase is greatest at one of the two ends.
    let steady = greatest(phase, ramp, duration - ramp);
    let mut worst = rate_bounds([T::ONE, T::ZERO, T::ZERO, T::ZERO], steady);
    let step = T::ONE / T::count(RAMP_PIECES);
    for i in 0..RAMP_PIECES {
        let (begin, end) = (T::count(i) * step, T::count(i + 1) * step);
        let w = envelope.in_time(rise_bounds(begin, end));
        let rising = greatest(phase, begin * ramp, end * ramp);
        let falling = greatest(phase, duration - end * ramp, duration - begin * ramp);
        for p in [rising, falling] {
            let here = rate_bounds(w, p);
            worst = core::array::from_fn(|k| worst[k].max(here[k]));
        }
    }
    // The bounds are exact mathematics; evaluation rounds a few times.
    let [velocity, acceleration, jerk] = worst.map(|x| amplitude * x * (T::ONE + T::BOUND_MARGIN));
    Extremes {
        position_min: about - amplitude,
        position_max: about + amplitude,
        velocity,
        acceleration,
        jerk,
    }
}

/// Bounds on |w|, |w'|, |w''|, |w'''| of the rise between `begin` and `end`: w grows, and each
/// derivative differs from its value in the middle by at most its own slope times half the width.
fn rise_bounds<T: Real>(begin: T, end: T) -> [T; 4] {
    let middle = rise(T::HALF * (begin + end));
    let half = T::HALF * (end - begin);
    let [_, s2, s3, s4] = RISE_DERIVATIVE_BOUNDS.map(T::of);
    [
        rise(end)[0],
        middle[1].abs() + s2 * half,
        middle[2].abs() + s3 * half,
        middle[3].abs() + s4 * half,
    ]
}

/// Greatest absolute phase derivatives between two instants.
fn greatest<T: Real>(phase: &Phase<T>, begin: T, end: T) -> [T; 3] {
    let (first, last) = (phase.derivatives(begin), phase.derivatives(end));
    core::array::from_fn(|k| first[k].abs().max(last[k].abs()))
}

/// Bounds on the first three derivatives of w sin φ from bounds on those of w and φ.
fn rate_bounds<T: Real>([w, w1, w2, w3]: [T; 4], [p1, p2, p3]: [T; 3]) -> [T; 3] {
    let three = T::of(3.0);
    [
        w1.hypot(w * p1),
        (w2 + w * p1 * p1).hypot(T::TWO * w1 * p1 + w * p2),
        (w3 + three * p1 * (w1 * p1 + w * p2))
            .hypot(three * (w2 * p1 + w1 * p2) + w * (p3 + p1 * p1 * p1)),
    ]
}
