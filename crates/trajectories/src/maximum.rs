//! The largest values that a motion may have.
//!
//! They lie far beyond any machine, so that no true motion is refused, and are there so that
//! whoever steps through a motion, or counts its cycles, comes to an end: a frequency mistaken by
//! its unit is noticed at once. Positions may also be counts of an encoder. The fastest linear-motor axes reach about 10 m/s, 10³ m/s² and
//! 10⁶ m/s³, over tens of metres; tests of their dynamics end at some kHz.

/// Greatest distance of a position from zero, and greatest amplitude, m, or counts of an encoder: 60
/// turns of one of 24 bits. What bounds the work of whoever steps through a motion is its
/// [`DURATION`], whatever the unit.
pub const POSITION: f64 = 1e9;
/// Greatest velocity limit, m/s, or counts/s: 60 turns/s at 24 bits.
pub const VELOCITY: f64 = 1e9;
/// Greatest acceleration limit, m/s², or counts/s²: 60 turns/s² at 24 bits, 950 at 20.
pub const ACCELERATION: f64 = 1e9;
/// Greatest jerk limit, m/s³; as good as none.
pub const JERK: f64 = 1e15;
/// Greatest frequency, Hz: a hundred times a usual control rate. The least is 1e-9 Hz, one cycle
/// in thirty years.
pub const FREQUENCY: f64 = 1e6;
/// Greatest duration of a step and of a whole program, s: 116 days.
pub const DURATION: f64 = 1e7;
/// Most cycles of one sine or chirp in `f64`: above, the phase has lost a millionth of a cycle to
/// rounding. For `f32` see [`Real::MAX_CYCLES`](crate::Real::MAX_CYCLES).
pub const CYCLES: f64 = 1e9;
/// Most steps of a program: some 60 MB of planned moves.
pub const STEPS: usize = 100_000;
