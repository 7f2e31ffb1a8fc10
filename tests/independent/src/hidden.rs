//! What may be hidden in the machine: each a plain term, all nothing by default.

use serde::Serialize;

/// Speed of the onset of hidden dry friction, m/s.
const ONSET: f64 = 80e-6;
/// Time over which a load comes up that is not there before the log, s.
const RISE: f64 = 0.02;

/// Hidden effects. All are added to the machine; the default is none.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Hidden {
    /// Friction and loads on the table.
    pub friction: Friction,
    /// Free travel between nut and screw, m.
    pub backlash: f64,
    /// Travel error that repeats with the screw's turn.
    pub lead: Option<Periodic>,
    /// Torque that repeats with the motor's turn.
    pub cogging: Option<Cogging>,
    /// Growth of the screw.
    pub thermal: Option<Thermal>,
    /// Control periods by which the q current's reference comes late.
    pub delay_cycles: usize,
    /// Share by which the drive reads too much current.
    pub current_gain: f64,
}

/// Forces on the table against its motion.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Friction {
    /// Viscous, N·s/m.
    pub viscous: f64,
    /// Dry, in forward motion, N; begins as tanh(v / 80 µm/s), as all dry friction here.
    pub forward: f64,
    /// Dry, in backward motion, N.
    pub backward: f64,
    /// Dry friction over a stretch of the travel.
    pub bump: Option<Bump>,
    /// Slope c of a friction c (x − zero) v, N·s/m².
    pub slope: f64,
    /// Its zero, m.
    pub zero: f64,
    /// Constant load against positive motion, N.
    pub load: f64,
    /// Whether it acts long before the log begins; otherwise it comes up over the first
    /// 20 ms of the log.
    pub load_held: bool,
}

/// Dry friction peak · exp(−((x − centre)/width)²/2).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bump {
    /// N.
    pub peak: f64,
    /// m.
    pub centre: f64,
    /// m.
    pub width: f64,
}

/// amplitude · sin(φ + phase), φ the screw's absolute angle at the nut.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Periodic {
    /// m.
    pub amplitude: f64,
    /// rad.
    pub phase: f64,
}

/// amplitude · sin(order · θ + phase), θ the motor's absolute angle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cogging {
    /// N·m.
    pub amplitude: f64,
    /// Periods a turn.
    pub order: f64,
    /// rad.
    pub phase: f64,
}

/// strain · (1 − exp(−t/time)) of the table's place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Thermal {
    /// Strain in the end.
    pub strain: f64,
    /// Time constant, s.
    pub time: f64,
}

impl Friction {
    /// Force against positive motion at time `t`, place `x` and speed `v`, N.
    pub fn force(&self, t: f64, x: f64, v: f64) -> f64 {
        let onset = (v / ONSET).tanh();
        let level = if v > 0.0 { self.forward } else { self.backward };
        let bump = self.bump.map_or(0.0, |b| {
            let ratio = (x - b.centre) / b.width;
            b.peak * (-0.5 * ratio * ratio).exp()
        });
        let risen = match self.load_held {
            true => 1.0,
            false => (t / RISE).clamp(0.0, 1.0),
        };
        self.viscous * v
            + (level + bump) * onset
            + self.slope * (x - self.zero) * v
            + self.load * risen
    }
}

impl Hidden {
    /// Torque at the motor, N·m, at its absolute angle.
    pub fn torque(&self, angle: f64) -> f64 {
        let one = |c: Cogging| c.amplitude * (c.order * angle + c.phase).sin();
        self.cogging.map_or(0.0, one)
    }

    /// By how much more than `travel` (m/rad) the table moves per radian at time `t` and screw angle `angle`: so
    /// much more of a lever the nut's force has on the screw, as no power is lost between them.
    pub fn growth(&self, t: f64, angle: f64, travel: f64) -> f64 {
        let of_lead = |lead: Periodic| lead.amplitude * (angle + lead.phase).cos();
        let grown = self.thermal.map_or(0.0, |thermal| {
            thermal.strain * (1.0 - (-t.max(0.0) / thermal.time).exp())
        });
        self.lead.map_or(0.0, of_lead) + travel * grown / (1.0 - grown)
    }

    /// By how much the table is ahead of the screw at time `t`, m, and the rate of that,
    /// m/s; `screw` is the angle at the nut and its rate, `table` place and speed.
    pub fn ahead(&self, t: f64, screw: [f64; 2], table: [f64; 2]) -> [f64; 2] {
        let mut ahead = [0.0; 2];
        if let Some(lead) = self.lead {
            let (sin, cos) = (screw[0] + lead.phase).sin_cos();
            ahead[0] += lead.amplitude * sin;
            ahead[1] += lead.amplitude * cos * screw[1];
        }
        if let Some(thermal) = self.thermal {
            let left = (-t.max(0.0) / thermal.time).exp();
            let strain = thermal.strain * (1.0 - left);
            ahead[0] += strain * table[0];
            ahead[1] += strain * table[1] + thermal.strain * left / thermal.time * table[0];
        }
        ahead
    }
}
