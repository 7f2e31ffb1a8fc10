//! Growth and friction along a move that is to come.

use axis_sim::Axis;
use axis_sim::mechanism::Freedom;
use axis_sim::thermal::LossModel;
use axis_thermal::{ThermalModel, ThermalState};
use compensator::Target;
use trajectories::Motion;

use super::HeatError;

/// Positions at which growth is held.
const PLACES: usize = 65;

/// Time between two states along a long move, s: in the first minutes of a duty a straight line over it is off by
/// some hundredths of a micrometre.
const STEP: f64 = 10.0;

/// Growth at all positions, and friction, at one time.
#[derive(Clone, Debug, PartialEq)]
struct Instant {
    time: f64,
    /// By how far the table is from where the controller's measuring has it, m.
    growth: Vec<f64>,
    friction: [f64; 2],
}

/// How an axis is predicted to be warm along a move: growth by position and time, and dry and viscous friction as
/// multiples of the cold axis'. Straight lines over time, cubics without a kink over the position.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatAhead {
    least: f64,
    per_length: f64,
    instants: Vec<Instant>,
    friction_counts: bool,
}

impl HeatAhead {
    /// The same all along a move that is short beside the time in which temperatures change. `growth` over the
    /// position is that by which the controller's measuring is off, m.
    pub fn constant(axis: &Axis, growth: impl Fn(f64) -> f64, friction: [f64; 2]) -> Self {
        let mut ahead = Self::empty(axis);
        ahead.push(0.0, growth, friction);
        ahead
    }

    /// Along a motion that begins in the state `begun`, the axis having been homed in `homed`, in air of a
    /// constant temperature, °C.
    pub(super) fn along(
        (axis, losses): (&Axis, &LossModel),
        model: &ThermalModel,
        [homed, begun]: [&ThermalState; 2],
        air: f64,
        motion: &dyn Motion,
    ) -> Result<Self, HeatError> {
        let unseen = Unseen::of(axis)?;
        let mut ahead = Self::empty(axis);
        let mut state = begun.clone();
        let whole = motion.duration();
        let count = (whole / STEP).ceil().max(1.0);
        let step = whole / count;
        for k in 0..count as u32 {
            let from = f64::from(k) * step;
            let mut duty = model.duty();
            losses.add_part(&mut duty, axis, motion, [from, from + step]);
            let at_work = model.under(&duty)?;
            let growth = |state: &ThermalState, x| unseen.read(&model.growth(homed, state, x));
            if k == 0 {
                ahead.push(0.0, |x| growth(&state, x), at_work.friction_factors(&state));
            }
            at_work.run(&mut state, air, step)?;
            let friction = at_work.friction_factors(&state);
            ahead.push(from + step, |x| growth(&state, x), friction);
        }
        Ok(ahead)
    }

    /// The same without the friction.
    #[must_use]
    pub fn growth_alone(&self) -> Self {
        Self {
            friction_counts: false,
            ..self.clone()
        }
    }

    fn empty(axis: &Axis) -> Self {
        let stroke = &axis.stroke;
        Self {
            least: stroke.minimum,
            per_length: (PLACES - 1) as f64 / (stroke.maximum - stroke.minimum),
            instants: Vec::new(),
            friction_counts: true,
        }
    }

    pub(super) fn push(&mut self, time: f64, growth: impl Fn(f64) -> f64, friction: [f64; 2]) {
        let at = |i: usize| growth(self.least + i as f64 / self.per_length);
        let growth = (0..PLACES).map(at).collect();
        self.instants.push(Instant {
            time,
            growth,
            friction,
        });
    }

    /// The instants around a time, and the share of the second.
    fn around(&self, time: f64) -> [(&Instant, f64); 2] {
        let after = self.instants.partition_point(|i| i.time <= time);
        let last = self.instants.len() - 1;
        let (a, b) = (after.saturating_sub(1), after.min(last));
        let (from, to) = (&self.instants[a], &self.instants[b]);
        let share = match to.time > from.time {
            true => ((time - from.time) / (to.time - from.time)).clamp(0.0, 1.0),
            false => 0.0,
        };
        [(from, 1.0 - share), (to, share)]
    }

    /// Growth at a time (s since the move's begin) and a position (m), m; and its slope over the position.
    pub fn growth(&self, time: f64, x: f64) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (instant, share) in self.around(time) {
            if share > 0.0 {
                let at = self.at(instant, x);
                sum = [0, 1].map(|i| sum[i] + share * at[i]);
            }
        }
        sum
    }

    fn at(&self, instant: &Instant, x: f64) -> [f64; 2] {
        let g = &instant.growth;
        let last = (PLACES - 1) as f64;
        let along = ((x - self.least) * self.per_length).clamp(0.0, last);
        let i = (along as usize).min(PLACES - 2);
        let s = along - i as f64;
        let slope = |i: usize| match i {
            0 => g[1] - g[0],
            i if i == PLACES - 1 => g[i] - g[i - 1],
            i => 0.5 * (g[i + 1] - g[i - 1]),
        };
        let [a, b, m, n] = [g[i], g[i + 1], slope(i), slope(i + 1)];
        let (s2, s3) = (s * s, s * s * s);
        // Hermite's cubic and its derivative.
        let value = a * (2.0 * s3 - 3.0 * s2 + 1.0)
            + m * (s3 - 2.0 * s2 + s)
            + b * (3.0 * s2 - 2.0 * s3)
            + n * (s3 - s2);
        let rate =
            (a - b) * 6.0 * (s2 - s) + m * (3.0 * s2 - 4.0 * s + 1.0) + n * (3.0 * s2 - 2.0 * s);
        [value, rate * self.per_length]
    }

    /// Dry and viscous friction at a time, as multiples of the cold axis'.
    pub fn friction(&self, time: f64) -> [f64; 2] {
        let [(from, a), (to, b)] = self.around(time);
        [0, 1].map(|i| a * from.friction[i] + b * to.friction[i])
    }

    /// A target with the growth taken from where the load is to be led, and the friction of then.
    pub(crate) fn on(&self, time: f64, mut target: Target) -> Target {
        let reference = target.reference;
        let [growth, slope] = self.growth(time, reference.position);
        target.shift.position -= growth;
        target.shift.velocity -= slope * reference.velocity;
        target.shift.acceleration -= slope * reference.acceleration;
        if self.friction_counts {
            target.friction = Some(self.friction(time));
        }
        target
    }
}

/// What of growth a controller does not see.
#[derive(Clone, Copy)]
pub(super) enum Unseen {
    /// That of the screw: it measures at the motor.
    Screw,
    /// That of the scale, which it measures by.
    Scale,
    /// The load turns, and growth is along lines alone.
    Nothing,
}

impl Unseen {
    /// Of an axis that measures at the motor or by a scale.
    pub fn of(axis: &Axis) -> Result<Self, HeatError> {
        if axis.freedom() == Freedom::Rotary {
            return Ok(Self::Nothing);
        }
        Ok(match axis.drive_model()?.cascade.from_motor {
            true => Self::Screw,
            false => Self::Scale,
        })
    }

    /// m.
    pub fn read(self, growth: &axis_thermal::Growth) -> f64 {
        match self {
            Self::Screw => growth.screw,
            Self::Scale => growth.scale,
            Self::Nothing => 0.0,
        }
    }
}
