//! Motor, screw, nut and table in time.

use nalgebra::DVector;

use crate::chain::{Chain, Nut};
use crate::drive::Reading;
use crate::error::IndependentError;
use crate::friction::LuGre;
use crate::hidden::Hidden;
use crate::motor::Motor;
use crate::parameters::Parameters;

/// Penetration over which a contact's damping comes up where there is backlash, m.
const ENTRY: f64 = 50e-9;
/// Speed by which the slope of the forces is taken, m/s.
const SLOPE_STEP: f64 = 1e-8;
/// Most rounds of Newton's method.
const ROUNDS: usize = 40;

/// The machine with its state. It starts at rest and relaxed, in the middle of any gap.
#[derive(Clone, Debug)]
pub struct Machine {
    step: f64,
    travel: f64,
    mass: f64,
    nut_stiffness: f64,
    nut_damping: f64,
    length: f64,
    chain: Chain,
    motor: Motor,
    friction: LuGre,
    hidden: Hidden,
    /// Where the table began, m.
    origin: f64,
    /// How far it was ahead of the screw there, m.
    ahead_at_start: f64,
    /// s; before 0 if the log begins later.
    time: f64,
    /// Angles since the start, rad, and their rates.
    angles: DVector<f64>,
    rates: DVector<f64>,
    /// The table since the start: m, m/s.
    table: [f64; 2],
    bristle: f64,
    /// d, q, A.
    currents: [f64; 2],
    /// From outside on the table, N.
    pushed: f64,
}

/// The nut in the middle of a step, as far as it is known without its force.
struct Contact {
    nut: Nut,
    /// Compression without force of nut and at the table's old place, m, and its rate
    /// with a table at rest.
    open: [f64; 2],
    /// Travel of the table per radian there, m/rad.
    lever: f64,
    /// Rate at the nut per torque.
    mobility: f64,
    /// Share of the damping that acts.
    damped: f64,
}

impl Machine {
    /// The machine at place `start` (m) at time `time` (s), in steps of `step` seconds.
    pub fn new(p: &Parameters, hidden: Hidden, start: f64, time: f64, step: f64) -> Self {
        let chain = Chain::new(p, step);
        let zero = DVector::zeros(chain.len());
        let travel = p.travel();
        let ahead = hidden.ahead(time, [start / travel, 0.0], [start, 0.0]);
        Self {
            step,
            travel,
            mass: p.table_mass,
            nut_stiffness: p.nut_stiffness,
            nut_damping: p.stiffness_damping * p.nut_stiffness,
            length: p.screw_length,
            motor: Motor::new(p),
            friction: LuGre::new(p),
            hidden,
            origin: start,
            ahead_at_start: ahead[0],
            time,
            angles: zero.clone(),
            rates: zero,
            chain,
            table: [0.0; 2],
            bristle: 0.0,
            currents: [0.0; 2],
            pushed: 0.0,
        }
    }

    /// What perfect sensors show.
    pub fn seen(&self) -> Reading {
        let gain = 1.0 + self.hidden.current_gain;
        Reading {
            position: self.origin + self.table[0],
            angle: self.origin / self.travel + self.angles[0],
            speed: self.rates[0],
            current: self.currents.map(|i| gain * i),
        }
    }

    /// A force on the table in positive direction (N), from now on.
    pub fn push(&mut self, force: f64) {
        self.pushed = force;
    }

    /// One step under held voltages d, q.
    ///
    /// # Errors
    /// [`IndependentError::NotConverged`], [`IndependentError::OffScrew`].
    pub fn step(&mut self, voltage: [f64; 2]) -> Result<(), IndependentError> {
        let half = 0.5 * self.step;
        let after = |m: &Self| m.motor.after(m.currents, voltage, m.rates[0], half);
        self.currents = after(self);
        let angle = self.seen().angle + half * self.rates[0];
        let torque = self.motor.torque(self.currents) + self.hidden.torque(angle);
        self.move_on(torque)?;
        self.currents = after(self);
        self.time += self.step;
        let position = self.origin + self.table[0];
        if (0.0..=self.length).contains(&position) {
            return Ok(());
        }
        Err(IndependentError::OffScrew {
            time: self.time,
            position,
            length: self.length,
        })
    }

    /// Mechanics by the implicit midpoint rule: one equation for the table's speed in the
    /// middle of the step, by Newton's method.
    fn move_on(&mut self, torque: f64) -> Result<(), IndependentError> {
        let half = 0.5 * self.step;
        let mut middle = self.chain.free(&self.angles, &self.rates, torque);
        let contact = self.contact(&middle);
        let missing = |w: f64| {
            let [_, against] = self.against(w);
            self.mass * (w - self.table[1]) / half - self.nut_force(&contact, w) + against
        };
        let mut w = self.table[1];
        let mut rounds = 0;
        loop {
            let here = missing(w);
            let slope = (missing(w + SLOPE_STEP) - here) / SLOPE_STEP;
            let by = here / slope;
            w -= by;
            if by.abs() <= 1e-14 + 1e-12 * w.abs() {
                break;
            }
            rounds += 1;
            if rounds == ROUNDS || !w.is_finite() {
                return Err(IndependentError::NotConverged { time: self.time });
            }
        }
        let force = self.nut_force(&contact, w);
        self.chain
            .load(&mut middle, &contact.nut, -contact.lever * force);
        // From the middle to the end: as far again.
        let [bristle, _] = self.against(w);
        self.bristle += 2.0 * (bristle - self.bristle);
        self.angles.axpy(self.step, &middle, 1.0);
        self.rates = &middle * 2.0 - &self.rates;
        self.table = [self.table[0] + self.step * w, 2.0 * w - self.table[1]];
        Ok(())
    }

    /// Bristle in the middle of the step, and force on the table against positive motion.
    fn against(&self, w: f64) -> [f64; 2] {
        let half = 0.5 * self.step;
        let (bristle, own) = self.friction.middle(self.bristle, w, half);
        let place = self.origin + self.table[0] + half * w;
        let hidden = &self.hidden.friction;
        let by_hidden = hidden.force(self.time + half, place, w);
        [bristle, own + by_hidden - self.pushed]
    }

    fn contact(&self, middle: &DVector<f64>) -> Contact {
        let half = 0.5 * self.step;
        let place = self.origin + self.table[0] + half * self.table[1];
        let nut = self.chain.nut(place);
        let (turned, rate) = (nut.of(&self.angles), nut.of(middle));
        let angle = turned + half * rate;
        let screw = [self.origin / self.travel + angle, rate];
        let table = [place, self.table[1]];
        let [ahead, ahead_rate] = self.hidden.ahead(self.time + half, screw, table);
        let ahead = ahead - self.ahead_at_start;
        let growth = (self.hidden).growth(self.time + half, screw[0], self.travel);
        let gap = 0.5 * self.hidden.backlash;
        let pressed = (self.travel * turned + ahead - self.table[0]).abs() - gap;
        let damped = match gap > 0.0 {
            true => (pressed / ENTRY).clamp(0.0, 1.0),
            false => 1.0,
        };
        Contact {
            open: [
                self.travel * angle + ahead - self.table[0],
                self.travel * rate + ahead_rate,
            ],
            lever: self.travel + growth,
            mobility: self.chain.mobility(&nut),
            nut,
            damped,
        }
    }

    /// Force of the nut on the table, N, where the table moves with `w` in the middle.
    fn nut_force(&self, contact: &Contact, w: f64) -> f64 {
        let half = 0.5 * self.step;
        let (k, c) = (self.nut_stiffness, contact.damped * self.nut_damping);
        // Per newton the nut gives way by this rate, and half a step of it.
        let yields = contact.lever * contact.lever * contact.mobility;
        let whole = 1.0 + yields * (k * half + c);
        let flank = |gap: f64| {
            let pressed = contact.open[0] - half * w - gap;
            (k * pressed + c * (contact.open[1] - w)) / whole
        };
        let gap = 0.5 * self.hidden.backlash;
        match (flank(gap), flank(-gap)) {
            (force, _) if force > 0.0 => force,
            (_, force) if force < 0.0 => force,
            _ => 0.0,
        }
    }
}
