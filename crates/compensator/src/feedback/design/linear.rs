//! Deviations of an axis from its plan, as a linear model over one control period.
//!
//! ```text
//! η̈ᵢ + 2ζωᵢ η̇ᵢ + ωᵢ² ηᵢ = φ_mᵢ T + φ_lᵢ F        x = Σ φ_lᵢ ηᵢ,  θ = Σ φ_mᵢ ηᵢ
//! F = −(σ0 χ x + (σ2 + σ1 χ + g (1 − χ)) ẋ)/lever² − d       d(k+1) = d(k)
//! T = K_t i,   L_q di/dt = v − R i − ψ ω_e               field-oriented, v held over a cycle
//! w(k) = w(k−1) + k_i T_s e(k),   v(k) = k_p e(k) + w(k),   e(k) = u(k − delay) − i(k)
//! ```
//!
//! v(k) begins to act `late` periods after its sample ([`Drive::FieldOriented`]) and is held for one.
//!
//! g is what a vibration in slow sliding meets: the falling Stribeck curve feeds it (g < 0).
//! The actuator may also be torque behind a first-order lag. The mechanics, the current and the back-EMF are
//! discretised together and exactly (matrix exponential).

use nalgebra::{DMatrix, DVector, RowDVector};

use super::DesignError;
use crate::feedback::MOST_STATES;
use crate::model::{Drive, DriveModel, Mode};

/// Least damping that the Stribeck curve and the bristles give a vibration of a load that
/// slides slowly, beside σ2: N·s/m at the load, negative or 0.
pub(super) fn stribeck_damping(model: &DriveModel, modes: &[Mode]) -> f64 {
    let p = model.friction.parameters();
    // Without a resonance of its own, as fast a vibration as a cycle can show.
    let frequency = match modes.get(1) {
        Some(mode) => mode.frequency,
        None => std::f64::consts::PI / model.period,
    };
    let speeds = (1..=SPEEDS).map(|i| 4.0 * p.stribeck_speed * f64::from(i) / f64::from(SPEEDS));
    let least = speeds
        .map(|speed| model.friction.vibration_damping(speed, frequency) - p.viscous)
        .fold(0.0, f64::min);
    least / (model.lever * model.lever)
}

/// Speeds, up to four Stribeck speeds, at which that is looked for.
const SPEEDS: u32 = 100;

/// A drive as a linear model may have it, off the one that is assumed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveSituation {
    /// Share of bristles that follow the motion: 0 where the load slides, 1 where it sticks.
    pub sticking: f64,
    /// The load's inertia, as a share of the assumed one.
    pub mass: f64,
    /// σ0, σ1 and σ2 of the friction, as a share of the assumed ones.
    pub friction: f64,
    /// Share of σ0 and σ1 besides.
    pub bristles: f64,
    /// Damping of a load that slides, N·s/m: 0 at χ = 1.
    pub sliding: f64,
}

/// A drive without its position and speed controllers, sampled once in each control period:
/// x(k+1) = A x + B u, y = C x. States are in units of their own; u is in units of the effort
/// limit. The last state is the force that acts against the load, held over a period.
#[derive(Clone, Debug)]
pub struct SampledDrive {
    /// A.
    pub a: DMatrix<f64>,
    /// B.
    pub b: DVector<f64>,
    /// Rows: position that is measured (m), motor speed (rad/s), current (A) where measured.
    pub c: DMatrix<f64>,
    /// Load's position, m or rad.
    pub load: RowDVector<f64>,
    /// Its speed, per second.
    pub load_speed: RowDVector<f64>,
    /// Motor's angle, rad.
    pub motor: RowDVector<f64>,
    /// Its speed, rad/s.
    pub motor_speed: RowDVector<f64>,
    /// Position and speed that the state feedback weighs: the load's, or the motor's as the
    /// load's if nothing else is measured, so that sensor and actuator are at one place.
    pub weighed: [RowDVector<f64>; 2],
    /// What one unit of each state is in SI.
    pub units: DVector<f64>,
}

impl SampledDrive {
    /// The drive of `model` with these natural modes, the rigid motion first. Where
    /// `speed_by_differences`, C's speed is the mean over the last period.
    pub fn new(
        model: &DriveModel,
        modes: &[Mode],
        speed_by_differences: bool,
        at: &DriveSituation,
    ) -> Self {
        let places = Places::of(model, modes.len(), speed_by_differences);
        let units = places.units(model, modes);
        let flow = in_units(&continuous(model, modes, at, &places), model, &units);
        let mut a = DMatrix::zeros(places.size(), places.size());
        let into = hold_voltages(&mut a, &flow, &places, model.drive.late());
        let acts = control_current(&mut a, into, &places, model);
        let b = hold_commands(&mut a, &acts, &places, model.delay / model.period);
        places.shown((a, b), units, model, modes)
    }

    /// Number of states.
    pub fn size(&self) -> usize {
        self.b.len()
    }

    /// Refused where a feedback has no room for as many states.
    pub(super) fn fits(self) -> Result<Self, DesignError> {
        match self.size() {
            states if states > MOST_STATES => Err(DesignError::Size {
                states,
                most: MOST_STATES,
            }),
            _ => Ok(self),
        }
    }
}

/// Where the states of a sampled drive stand: positions and speeds of the modes, the actuator's own state, the current
/// controller's integral, voltages and commands under way, the motor's angle a cycle ago, the force on the load.
#[derive(Clone, Copy)]
struct Places {
    modes: usize,
    /// 1 where the actuator has a state: its current, or its torque behind a lag.
    inner: usize,
    /// 1 where a current controller has an integral.
    held: usize,
    /// Voltages under way: whole periods, and the part of one more.
    under_way: usize,
    /// Commands under way.
    late: usize,
    /// 1 where the speed is a difference of angles.
    angles: usize,
}

impl Places {
    fn of(model: &DriveModel, modes: usize, speed_by_differences: bool) -> Self {
        let (inner, held) = match &model.drive {
            Drive::FieldOriented { .. } => (1, 1),
            Drive::Lag { bandwidth, .. } => (usize::from(bandwidth.is_finite()), 0),
        };
        let periods = |late: f64| {
            let [whole, part] = whole_and_part(late);
            whole as usize + usize::from(part > 0.0)
        };
        Self {
            modes,
            inner,
            held,
            under_way: periods(model.drive.late()),
            late: periods(model.delay / model.period),
            angles: usize::from(speed_by_differences),
        }
    }

    /// States that flow between samples.
    fn flow(&self) -> usize {
        2 * self.modes + self.inner
    }

    /// The first voltage under way.
    fn voltages(&self) -> usize {
        self.flow() + self.held
    }

    /// The first command under way.
    fn past(&self) -> usize {
        self.voltages() + self.under_way
    }

    /// The motor's angle a cycle ago.
    fn before(&self) -> usize {
        self.past() + self.late
    }

    fn size(&self) -> usize {
        self.before() + self.angles + 1
    }

    /// What one unit of each state is in SI: of motion what the greatest torque moves in a cycle.
    fn units(&self, model: &DriveModel, modes: &[Mode]) -> DVector<f64> {
        let (h, limit, n) = (model.period, model.effort_limit, self.modes);
        let push = model.torque_constant() * limit * modes[0].motor.abs() * h * h;
        let mut units = DVector::from_element(self.size(), limit);
        units.rows_mut(0, n).fill(push);
        units.rows_mut(n, n).fill(push / h);
        if self.angles == 1 {
            units[self.before()] = push / modes[0].motor.abs();
        }
        units[self.size() - 1] = greatest_force(model);
        units
    }

    /// The drive of A and B with what is measured and weighed of its states.
    fn shown(
        &self,
        (mut a, b): (DMatrix<f64>, DVector<f64>),
        units: DVector<f64>,
        model: &DriveModel,
        modes: &[Mode],
    ) -> SampledDrive {
        let (n, size, h) = (self.modes, self.size(), model.period);
        let row = |value: fn(&Mode) -> f64, from: usize| {
            RowDVector::from_fn(size, |_, j| {
                let inside = (from..from + n).contains(&j);
                if inside {
                    value(&modes[j - from]) * units[j]
                } else {
                    0.0
                }
            })
        };
        let (motor, load) = (|from| row(|m| m.motor, from), |from| row(|m| m.load, from));
        let position = match model.cascade.from_motor {
            true => motor(0) * model.travel,
            false => load(0),
        };
        let mut speed = motor(n);
        if self.angles == 1 {
            // A state for the motor's angle a cycle ago, in units of the modes' own.
            let (before, now) = (self.before(), motor(0));
            a.row_mut(before).copy_from(&(&now / units[before]));
            speed = now / h;
            speed[before] = -units[before] / h;
        }
        let weighed = match model.cascade.from_motor {
            true => [motor(0), motor(n)].map(|row| row * model.travel),
            false => [load(0), load(n)],
        };
        let mut rows = vec![position, speed];
        if self.held == 1 {
            rows.push(RowDVector::from_fn(size, |_, j| {
                if j == 2 * n { model.effort_limit } else { 0.0 }
            }));
        }
        SampledDrive {
            a,
            b,
            c: DMatrix::from_rows(&rows),
            weighed,
            load: load(0),
            load_speed: load(n),
            motor: motor(0),
            motor_speed: motor(n),
            units,
        }
    }
}

/// Whole periods of a delay, and the part of one more.
fn whole_and_part(late: f64) -> [f64; 2] {
    let whole = (late as usize) as f64;
    [whole, late - whole]
}

/// Of the actuator at the load, N or N·m.
fn greatest_force(model: &DriveModel) -> f64 {
    model.torque_constant() * model.effort_limit / model.travel
}

/// Continuous: mechanics and current, with the inputs v (or the command) and d.
fn continuous(
    model: &DriveModel,
    modes: &[Mode],
    at: &DriveSituation,
    places: &Places,
) -> DMatrix<f64> {
    let (n, flow) = (places.modes, places.flow());
    let motor = DVector::from_iterator(n, modes.iter().map(|m| m.motor));
    let load = DVector::from_iterator(n, modes.iter().map(|m| m.load));
    let extra = model.load_inertia * (at.mass - 1.0);
    let share = extra / (1.0 + extra * load.dot(&load));
    let per_mass = DMatrix::identity(n, n) - &load * load.transpose() * share;
    let p = model.friction.parameters();
    let lever = model.lever * model.lever;
    let stuck = at.sticking * at.bristles;
    let spring = at.friction * p.stiffness * stuck / lever;
    let damping =
        at.friction * (p.viscous + p.damping * stuck) / lever + at.sliding * (1.0 - at.sticking);
    let own = |f: fn(&Mode) -> f64| {
        DMatrix::from_diagonal(&DVector::from_iterator(n, modes.iter().map(f)))
    };
    let outer = &load * load.transpose();
    let stiff = own(|m| m.frequency * m.frequency) + &outer * spring;
    let damp = own(|m| m.damping) + &outer * damping;
    let mut ac = DMatrix::zeros(flow + 2, flow + 2);
    ac.view_mut((0, n), (n, n)).fill_with_identity();
    ac.view_mut((n, 0), (n, n)).copy_from(&-(&per_mass * stiff));
    ac.view_mut((n, n), (n, n)).copy_from(&-(&per_mass * damp));
    let torque = &per_mass * &motor * model.torque_constant();
    let (at_v, at_d) = (flow, flow + 1);
    ac.view_mut((n, at_d), (n, 1))
        .copy_from(&-(&per_mass * &load));
    match &model.drive {
        Drive::FieldOriented { motor: m, gear, .. } => {
            let e = m.parameters();
            let i = 2 * n;
            ac.view_mut((n, i), (n, 1)).copy_from(&torque);
            ac[(i, i)] = -e.resistance / e.inductance_q;
            ac[(i, at_v)] = 1.0 / e.inductance_q;
            let induced = m.electrical_speed(*gear) * e.flux_linkage / e.inductance_q;
            for (j, shape) in motor.iter().enumerate() {
                ac[(i, n + j)] = -induced * shape;
            }
        }
        Drive::Lag { bandwidth, .. } if places.inner == 1 => {
            let i = 2 * n;
            ac.view_mut((n, i), (n, 1)).copy_from(&torque);
            ac[(i, i)] = -bandwidth;
            ac[(i, at_v)] = *bandwidth;
        }
        Drive::Lag { .. } => ac.view_mut((n, at_v), (n, 1)).copy_from(&torque),
    }
    ac
}

/// A flow over one period in the states' own units, where no entry is far from the others.
fn in_units(ac: &DMatrix<f64>, model: &DriveModel, units: &DVector<f64>) -> DMatrix<f64> {
    let (size, h) = (ac.nrows(), model.period);
    let (at_v, at_d) = (size - 2, size - 1);
    let unit = |i: usize| match i {
        i if i == at_v => model.effort_limit,
        i if i == at_d => greatest_force(model),
        i => units[i],
    };
    DMatrix::from_fn(size, size, |i, j| ac[(i, j)] * h * unit(j) / unit(i))
}

/// Puts the flow and the voltages under way into A; what the voltage that is made now does.
fn hold_voltages(
    a: &mut DMatrix<f64>,
    ac: &DMatrix<f64>,
    places: &Places,
    late: f64,
) -> DVector<f64> {
    let (size, flow, voltages) = (places.size(), places.flow(), places.voltages());
    let (at_v, at_d) = (flow, flow + 1);
    let [v_whole, v_part] = whole_and_part(late);
    let ad = ac.exp();
    // Of two voltages in a period the newer acts in the rest of it.
    let rest = match v_part > 0.0 {
        true => (ac * (1.0 - v_part)).exp(),
        false => ad.clone(),
    };
    a.view_mut((0, 0), (flow, flow))
        .copy_from(&ad.view((0, 0), (flow, flow)));
    a.view_mut((0, size - 1), (flow, 1))
        .copy_from(&ad.view((0, at_d), (flow, 1)));
    a[(size - 1, size - 1)] = 1.0;
    let newer = DVector::from_fn(size, |i, _| if i < flow { rest[(i, at_v)] } else { 0.0 });
    let older = DVector::from_fn(size, |i, _| match i < flow {
        true => ad[(i, at_v)] - rest[(i, at_v)],
        false => 0.0,
    });
    // v(k − j): of the voltages under way, or the one that is made now.
    let mut into = DVector::zeros(size);
    let mut acts_after = |j: usize, on: &DVector<f64>| match j {
        0 => into += on,
        j => {
            let column = a.column(voltages + j - 1) + on;
            a.set_column(voltages + j - 1, &column);
        }
    };
    acts_after(v_whole as usize, &newer);
    if v_part > 0.0 {
        acts_after(v_whole as usize + 1, &older);
    }
    for j in 0..places.under_way {
        match j {
            0 => into[voltages] = 1.0,
            j => a[(voltages + j, voltages + j - 1)] = 1.0,
        }
    }
    into
}

/// What the late command does: through the current controller, which is put into A, or at once.
fn control_current(
    a: &mut DMatrix<f64>,
    into: DVector<f64>,
    places: &Places,
    model: &DriveModel,
) -> DVector<f64> {
    let Drive::FieldOriented { q, .. } = &model.drive else {
        return into;
    };
    let h = model.period;
    let pi = [q[0] + q[1] * h, q[1] * h];
    let (i, w) = (places.flow() - 1, places.flow());
    let mut acts = &into * pi[0];
    acts[w] = pi[1];
    let from_current = a.column(i) - &acts;
    a.set_column(i, &from_current);
    a.set_column(w, &into);
    a[(w, w)] = 1.0;
    acts
}

/// Puts the commands under way into A, late by so many cycles; gives B.
fn hold_commands(
    a: &mut DMatrix<f64>,
    acts: &DVector<f64>,
    places: &Places,
    cycles: f64,
) -> DVector<f64> {
    let (past, [whole, part]) = (places.past(), whole_and_part(cycles));
    let mut b = DVector::zeros(places.size());
    // u(k − j): the j-th past command, or the one that is made now.
    let mut late_by = |j: usize, weight: f64| match j {
        0 => b += acts * weight,
        j => {
            let column = a.column(past + j - 1) + acts * weight;
            a.set_column(past + j - 1, &column);
        }
    };
    late_by(whole as usize, 1.0 - part);
    if part > 0.0 {
        late_by(whole as usize + 1, part);
    }
    for j in 0..places.late {
        match j {
            0 => b[past] = 1.0,
            j => a[(past + j, past + j - 1)] = 1.0,
        }
    }
    b
}
