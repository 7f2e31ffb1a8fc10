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
        let n = modes.len();
        let (constant, h, limit) = (model.torque_constant(), model.period, model.effort_limit);
        let cycles = model.delay / h;
        let whole = cycles as usize;
        let part = cycles - whole as f64;
        let late = whole + usize::from(part > 0.0);
        let (inner, held) = match &model.drive {
            Drive::FieldOriented { .. } => (1, 1),
            Drive::Lag { bandwidth, .. } => (usize::from(bandwidth.is_finite()), 0),
        };
        let angles = usize::from(speed_by_differences);
        // Voltages under way: whole periods, and the part of one more.
        let v_late = model.drive.late();
        let (v_whole, v_part) = (v_late as usize, v_late - (v_late as usize) as f64);
        let under_way = v_whole + usize::from(v_part > 0.0);
        let size = 2 * n + inner + held + under_way + late + angles + 1;
        let flow = 2 * n + inner;
        let motor = DVector::from_iterator(n, modes.iter().map(|m| m.motor));
        let load = DVector::from_iterator(n, modes.iter().map(|m| m.load));
        // Units: what the greatest torque moves in a cycle.
        let push = constant * limit * modes[0].motor.abs() * h * h;
        let force = constant * limit / model.travel;
        let mut units = DVector::from_element(size, limit);
        units.rows_mut(0, n).fill(push);
        units.rows_mut(n, n).fill(push / h);
        units[size - 1] = force;

        // Continuous: mechanics and current, with inputs v (or command) and d.
        let extra = model.load_inertia * (at.mass - 1.0);
        let share = extra / (1.0 + extra * load.dot(&load));
        let per_mass = DMatrix::identity(n, n) - &load * load.transpose() * share;
        let p = model.friction.parameters();
        let lever = model.lever * model.lever;
        let stuck = at.sticking * at.bristles;
        let spring = at.friction * p.stiffness * stuck / lever;
        let damping = at.friction * (p.viscous + p.damping * stuck) / lever
            + at.sliding * (1.0 - at.sticking);
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
        let torque = &per_mass * &motor * constant;
        let (at_v, at_d) = (flow, flow + 1);
        ac.view_mut((n, at_d), (n, 1))
            .copy_from(&-(&per_mass * &load));
        let mut pi = [0.0; 2];
        match &model.drive {
            Drive::FieldOriented {
                motor: m, gear, q, ..
            } => {
                let e = m.parameters();
                let i = 2 * n;
                ac.view_mut((n, i), (n, 1)).copy_from(&torque);
                ac[(i, i)] = -e.resistance / e.inductance_q;
                ac[(i, at_v)] = 1.0 / e.inductance_q;
                let induced = m.electrical_speed(*gear) * e.flux_linkage / e.inductance_q;
                for (j, shape) in motor.iter().enumerate() {
                    ac[(i, n + j)] = -induced * shape;
                }
                pi = [q[0] + q[1] * h, q[1] * h];
            }
            Drive::Lag { bandwidth, .. } if inner == 1 => {
                let i = 2 * n;
                ac.view_mut((n, i), (n, 1)).copy_from(&torque);
                ac[(i, i)] = -bandwidth;
                ac[(i, at_v)] = *bandwidth;
            }
            Drive::Lag { .. } => ac.view_mut((n, at_v), (n, 1)).copy_from(&torque),
        }
        // In its own units, where no entry is far from the others.
        let unit = |i: usize| match i {
            i if i == at_v => limit,
            i if i == at_d => force,
            i => units[i],
        };
        let ac = DMatrix::from_fn(flow + 2, flow + 2, |i, j| {
            ac[(i, j)] * h * unit(j) / unit(i)
        });
        let ad = ac.exp();
        // Of two voltages in a period the newer acts in the rest of it.
        let rest = match v_part > 0.0 {
            true => (&ac * (1.0 - v_part)).exp(),
            false => ad.clone(),
        };

        let mut a = DMatrix::zeros(size, size);
        let mut b = DVector::zeros(size);
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
        let voltages = flow + held;
        let mut into = DVector::zeros(size);
        let mut acts_after = |j: usize, on: &DVector<f64>| match j {
            0 => into += on,
            j => {
                let column = a.column(voltages + j - 1) + on;
                a.set_column(voltages + j - 1, &column);
            }
        };
        acts_after(v_whole, &newer);
        if v_part > 0.0 {
            acts_after(v_whole + 1, &older);
        }
        for j in 0..under_way {
            match j {
                0 => into[voltages] = 1.0,
                j => a[(voltages + j, voltages + j - 1)] = 1.0,
            }
        }
        // What the late command does: through the PI, or at once.
        let mut acts = into.clone();
        if held == 1 {
            let (i, w) = (flow - 1, flow);
            acts = &into * pi[0];
            acts[w] = pi[1];
            let from_current = a.column(i) - &acts;
            a.set_column(i, &from_current);
            a.set_column(w, &into);
            a[(w, w)] = 1.0;
        }
        // u(k − j): the j-th past command, or the one that is made now.
        let past = flow + held + under_way;
        let mut late_by = |j: usize, weight: f64| match j {
            0 => b += &acts * weight,
            j => {
                let column = a.column(past + j - 1) + &acts * weight;
                a.set_column(past + j - 1, &column);
            }
        };
        late_by(whole, 1.0 - part);
        if part > 0.0 {
            late_by(whole + 1, part);
        }
        for j in 0..late {
            match j {
                0 => b[past] = 1.0,
                j => a[(past + j, past + j - 1)] = 1.0,
            }
        }

        if angles == 1 {
            units[past + late] = push / motor[0].abs();
        }
        let row = |values: &DVector<f64>, from: usize| {
            RowDVector::from_fn(size, |_, j| {
                let inside = (from..from + n).contains(&j);
                if inside {
                    values[j - from] * units[j]
                } else {
                    0.0
                }
            })
        };
        let (load_at, load_speed) = (row(&load, 0), row(&load, n));
        let position = match model.cascade.from_motor {
            true => row(&motor, 0) * model.travel,
            false => load_at.clone(),
        };
        let mut speed = row(&motor, n);
        if angles == 1 {
            // A state for the motor's angle a cycle ago, in units of the modes' own.
            let (before, now) = (past + late, row(&motor, 0));
            a.row_mut(before).copy_from(&(&now / units[before]));
            speed = now / h;
            speed[before] = -units[before] / h;
        }
        let weighed = match model.cascade.from_motor {
            true => [row(&motor, 0), row(&motor, n)].map(|row| row * model.travel),
            false => [load_at.clone(), load_speed.clone()],
        };
        let mut rows = vec![position, speed];
        if held == 1 {
            rows.push(RowDVector::from_fn(size, |_, j| {
                if j == 2 * n { limit } else { 0.0 }
            }));
        }
        Self {
            a,
            b,
            c: DMatrix::from_rows(&rows),
            weighed,
            load: load_at,
            load_speed,
            motor: row(&motor, 0),
            motor_speed: row(&motor, n),
            units,
        }
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
