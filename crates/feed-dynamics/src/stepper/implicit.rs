//! The obvious stepper: Newmark's average acceleration (γ = ½, β = ¼) on the
//! drive's own M(x), C(x) and K(x), with either nut coupling.
//!
//! `S a₁ = F₁ − K (q_p + β v_p)` with `S = M + (h²/4 + βh/2) K`, where q_p
//! and v_p hold all that is known at the start. Solved for the rotating chain
//! alone, whose S is tridiagonal, and for a unit force of the nut on it, so a
//! step costs a few operations a node; the nut's force then follows from its law
//! on the end values, and the table's acceleration from that.

use beam_fem::{Mesh, MovingNode, Tridiagonal};

use super::nut::Contact;
use super::{
    NutErrors, Observation, Settled, StepReport, TableMotion, TimeStepper, check_step, find_load,
};
use crate::matrices::{Chain, NutCoupling, NutSeat};
use crate::{DriveError, FeedDrive};

/// The drive for implicit steps of one length.
#[derive(Clone, Debug)]
pub struct ImplicitStepper {
    drive: FeedDrive,
    coupling: NutCoupling,
    step: f64,
    /// Nodes of the uniform mesh, m.
    uniform: Vec<f64>,
}

/// State of an [`ImplicitStepper`]: displacement, velocity and acceleration of
/// each of the N + 4 coordinates.
#[derive(Clone, Debug)]
pub struct ImplicitState {
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    origin: f64,
    nut_force: f64,
    load: f64,
    /// Of the nut, at the end of the last step.
    errors: NutErrors,
    chain: Chain,
    /// Where the screw's nodes are, m.
    nodes: Vec<f64>,
    work: Work,
}

/// What a step needs room for; nothing in it outlives the step.
#[derive(Clone, Debug)]
struct Work {
    known: Vec<f64>,
    rhs: Vec<f64>,
    unit: Vec<f64>,
    lhs: Tridiagonal,
}

impl ImplicitStepper {
    /// Prepares steps of `step` seconds with the given nut coupling.
    ///
    /// # Errors
    /// [`DriveError::Parameter`] if the step is not positive and finite.
    pub fn new(drive: &FeedDrive, coupling: NutCoupling, step: f64) -> Result<Self, DriveError> {
        check_step(step)?;
        Ok(Self {
            uniform: Mesh::uniform(drive.parameters().screw_length, drive.parameters().elements)?
                .nodes()
                .to_vec(),
            drive: drive.clone(),
            coupling,
            step,
        })
    }

    /// Positions of the screw's nodes with the table at `x`, m.
    fn nodes(&self, x: f64) -> Vec<f64> {
        let mut nodes = self.uniform.clone();
        if let (NutCoupling::MovingNode, Some((node, at))) = (self.coupling, self.place(x)) {
            nodes[node] = at;
        }
        nodes
    }

    /// The node that follows the nut with the table at `x`, kept on the screw, and
    /// where it is, m.
    fn place(&self, x: f64) -> Option<(usize, f64)> {
        let p = self.drive.parameters();
        let x = x.clamp(0.0, p.screw_length);
        // Every x on the screw has a place, since the parameters were checked;
        // only one that is no number has none.
        MovingNode::place(p.screw_length, p.elements, x, MovingNode::MIN_FRACTION).ok()
    }

    /// The nut's seat follows the table at `x`, and with it the moving node: only
    /// the two elements beside it change. Where it jumps to the next place in the
    /// mesh, the rotations are carried over by interpolation.
    fn move_seat(&self, state: &mut ImplicitState, x: f64) {
        let p = self.drive.parameters();
        if self.coupling == NutCoupling::ShapeFunctions {
            let cells = p.elements as f64;
            let along = (x / p.screw_length * cells).clamp(0.0, cells);
            let node = (along as usize).min(p.elements - 1);
            let weights = [1.0 - (along - node as f64), along - node as f64];
            state.chain.seat = NutSeat { node, weights };
            return;
        }
        let Some((node, position)) = self.place(x) else {
            return;
        };
        let last = state.chain.seat.node + 1;
        if node == last {
            state.nodes[node] = position;
        } else {
            let before = state.nodes.clone();
            state.nodes[last] = self.uniform[last];
            state.nodes[node] = position;
            state.chain.renew_at(last, &state.nodes, p);
            state.chain.seat.node = node - 1;
            let nodes = &state.nodes;
            for values in [&mut state.q, &mut state.v, &mut state.a] {
                let screw = &mut values[2..2 + nodes.len()];
                let carried: Vec<f64> = nodes
                    .iter()
                    .map(|&at| interpolate(&before, screw, at))
                    .collect();
                screw.copy_from_slice(&carried);
            }
        }
        state.chain.renew_at(node, &state.nodes, p);
    }

    /// `(rθ − y)` at the nut, from values laid out as the coordinates are.
    fn stretch(&self, values: &[f64], seat: &NutSeat) -> f64 {
        let at = 2 + seat.node;
        let rotation = seat.weights[0] * values[at] + seat.weights[1] * values[at + 1];
        self.drive.travel_per_radian() * rotation - values[values.len() - 1]
    }
}

impl TimeStepper for ImplicitStepper {
    type State = ImplicitState;

    fn step_length(&self) -> f64 {
        self.step
    }

    fn of_length(&self, step: f64) -> Result<Self, DriveError> {
        Self::new(&self.drive, self.coupling, step)
    }

    fn travel_per_radian(&self) -> f64 {
        self.drive.travel_per_radian()
    }

    fn settled_torque(&self, _: f64, motion: &Settled) -> f64 {
        motion.motor_torque(&self.drive)
    }

    fn settled(&self, x: f64, motion: &Settled) -> Result<ImplicitState, DriveError> {
        self.drive.check_position(x)?;
        motion.check()?;
        let r = self.drive.travel_per_radian();
        let chain = self.drive.chain(x, self.coupling)?;
        let n = self.drive.coordinates();
        let alpha = motion.acceleration / r;
        let torque = motion.motor_torque(&self.drive);
        let nut_force = motion.nut_force(&self.drive);

        // Walk down the chain: each spring carries the torque that what lies
        // beyond it needs.
        let mut q = vec![0.0; n];
        let mut carried = torque;
        for i in 0..n - 2 {
            carried -= row_sum(&chain.mass, i) * alpha;
            if i >= 2 && i - 2 == chain.seat.node {
                carried -= r * nut_force * chain.seat.weights[0];
            }
            if i >= 2 && i - 2 == chain.seat.node + 1 {
                carried -= r * nut_force * chain.seat.weights[1];
            }
            q[i + 1] = q[i] + carried / chain.stiffness.off_diagonal[i];
        }
        let turn =
            (nut_force / self.drive.contact_stiffness(x) - self.stretch(&q, &chain.seat)) / r;
        q[..n - 1].iter_mut().for_each(|angle| *angle += turn);
        let rigid = |rate: f64| {
            let mut values = vec![rate / r; n];
            values[n - 1] = rate;
            values
        };
        Ok(ImplicitState {
            q,
            v: rigid(motion.speed),
            a: rigid(motion.acceleration),
            origin: x,
            nut_force,
            load: motion.load,
            errors: NutErrors::default(),
            nodes: self.nodes(x),
            work: Work {
                known: vec![0.0; n],
                rhs: vec![0.0; n - 1],
                unit: vec![0.0; n - 1],
                lhs: chain.mass.clone(),
            },
            chain,
        })
    }

    fn step_through(
        &self,
        state: &mut ImplicitState,
        torque: f64,
        errors: &NutErrors,
        load: impl FnMut(TableMotion) -> f64,
    ) -> StepReport {
        let h = self.step;
        let p = self.drive.parameters();
        let (r, beta) = (self.drive.travel_per_radian(), p.stiffness_damping);
        let last = state.q.len() - 1;

        // The seat with the table at the end of the step.
        let x = state.origin + state.q[last] + h * state.v[last];
        self.move_seat(state, x);
        let seat = state.chain.seat;
        let [n1, n2] = seat.weights;
        let at = 2 + seat.node;

        // q_p and v_p.
        for i in 0..=last {
            state.q[i] += h * state.v[i] + 0.25 * h * h * state.a[i];
            state.v[i] += 0.5 * h * state.a[i];
        }

        // Accelerations of the chain without the nut, and those that a newton of
        // it adds: it pushes the table on and turns the screw back.
        let Work {
            known,
            rhs,
            unit,
            lhs,
        } = &mut state.work;
        for (known, (q, v)) in known.iter_mut().zip(state.q.iter().zip(&state.v)) {
            *known = q + beta * v;
        }
        multiply(&state.chain.stiffness, known, rhs);
        rhs.iter_mut().for_each(|f| *f = -*f);
        rhs[0] += torque;
        unit.fill(0.0);
        unit[at] = -r * n1;
        unit[at + 1] = -r * n2;
        copy(&state.chain.mass, lhs);
        add_scaled(lhs, 0.25 * h * h + 0.5 * beta * h, &state.chain.stiffness);
        solve_tridiagonal(lhs, [rhs, unit]);
        let turn = |a: &[f64]| r * (n1 * a[at] + n2 * a[at + 1]);

        // The nut's law on the end values, which are linear in its force and in
        // the load.
        let (per_newton, free) = (1.0 / p.table_mass - turn(unit), turn(rhs));
        let stiffness = self.drive.contact_stiffness(x);
        let contact = Contact {
            stiffness,
            damping: stiffness * beta,
            travel: 0.25 * h * h * per_newton,
            speed: 0.5 * h * per_newton,
            half_gap: 0.5 * errors.gap(),
        };
        let compression = self.stretch(&state.q, &seat) + errors.offset();
        let closing = self.stretch(&state.v, &seat) + errors.offset_rate();
        let nut = |load: f64| {
            let parting = free + load / p.table_mass;
            contact.force(
                compression + 0.25 * h * h * parting,
                closing + 0.5 * h * parting,
            )
        };
        let motion = |load: f64| {
            let a = (nut(load) - load) / p.table_mass;
            TableMotion {
                displacement: state.q[last] + 0.25 * h * h * a,
                speed: state.v[last] + 0.5 * h * a,
            }
        };
        let (end_load, found) = find_load(state.load, 0.5 * h / p.table_mass, motion, load);
        let nut_force = nut(end_load);

        for (a, (free, per_newton)) in state.a.iter_mut().zip(rhs.iter().zip(&*unit)) {
            *a = free + nut_force * per_newton;
        }
        state.a[last] = (nut_force - end_load) / p.table_mass;
        for i in 0..=last {
            state.q[i] += 0.25 * h * h * state.a[i];
            state.v[i] += 0.5 * h * state.a[i];
        }
        state.nut_force = nut_force;
        state.load = end_load;
        state.errors = *errors;
        StepReport {
            load: found,
            on_screw: self.drive.has(state.origin + state.q[last]),
        }
    }

    fn observe(&self, state: &ImplicitState) -> Observation {
        let last = state.q.len() - 1;
        Observation {
            motor_angle: state.q[0],
            motor_speed: state.v[0],
            displacement: state.q[last],
            speed: state.v[last],
            transmission_force: state.nut_force,
        }
    }

    fn energy(&self, state: &ImplicitState) -> f64 {
        let last = state.q.len() - 1;
        let speed = state.v[last];
        let chain = quadratic_form(&state.chain.mass, &state.v)
            + quadratic_form(&state.chain.stiffness, &state.q);
        let strain = state
            .errors
            .strain(self.stretch(&state.q, &state.chain.seat));
        let stiffness = self.drive.contact_stiffness(state.origin + state.q[last]);
        0.5 * (chain
            + self.drive.parameters().table_mass * speed * speed
            + stiffness * strain * strain)
    }
}

/// Value at `at` of what is linear between the nodes.
fn interpolate(nodes: &[f64], values: &[f64], at: f64) -> f64 {
    let after = nodes
        .partition_point(|&node| node < at)
        .clamp(1, nodes.len() - 1);
    let (x0, x1) = (nodes[after - 1], nodes[after]);
    let part = (at - x0) / (x1 - x0);
    values[after - 1] + part * (values[after] - values[after - 1])
}

fn row_sum(t: &Tridiagonal, i: usize) -> f64 {
    let before = if i > 0 { t.off_diagonal[i - 1] } else { 0.0 };
    before + t.diagonal[i] + t.off_diagonal.get(i).copied().unwrap_or(0.0)
}

fn add_scaled(to: &mut Tridiagonal, factor: f64, from: &Tridiagonal) {
    for (a, b) in to.diagonal.iter_mut().zip(&from.diagonal) {
        *a += factor * b;
    }
    for (a, b) in to.off_diagonal.iter_mut().zip(&from.off_diagonal) {
        *a += factor * b;
    }
}

fn copy(from: &Tridiagonal, to: &mut Tridiagonal) {
    to.diagonal.copy_from_slice(&from.diagonal);
    to.off_diagonal.copy_from_slice(&from.off_diagonal);
}

/// `vᵀ t v` with the first entries of `v`, as many as there are rows.
fn quadratic_form(t: &Tridiagonal, v: &[f64]) -> f64 {
    let own: f64 = t.diagonal.iter().zip(v).map(|(d, v)| d * v * v).sum();
    let beside: f64 = t
        .off_diagonal
        .iter()
        .zip(v.windows(2))
        .map(|(o, v)| o * v[0] * v[1])
        .sum();
    own + 2.0 * beside
}

/// Product with the first entries of `v`, as many as there are rows.
fn multiply(t: &Tridiagonal, v: &[f64], product: &mut [f64]) {
    for (p, (d, x)) in product.iter_mut().zip(t.diagonal.iter().zip(v)) {
        *p = d * x;
    }
    for (i, o) in t.off_diagonal.iter().enumerate() {
        product[i] += o * v[i + 1];
        product[i + 1] += o * v[i];
    }
}

/// Thomas' elimination for two right-hand sides at once; the matrix is
/// positive definite, so no pivoting is needed.
fn solve_tridiagonal(t: &mut Tridiagonal, mut sides: [&mut [f64]; 2]) {
    let n = t.diagonal.len();
    for i in 1..n {
        let factor = t.off_diagonal[i - 1] / t.diagonal[i - 1];
        t.diagonal[i] -= factor * t.off_diagonal[i - 1];
        for b in &mut sides {
            b[i] -= factor * b[i - 1];
        }
    }
    for i in (0..n).rev() {
        for b in &mut sides {
            let after = if i + 1 < n {
                t.off_diagonal[i] * b[i + 1]
            } else {
                0.0
            };
            b[i] = (b[i] - after) / t.diagonal[i];
        }
    }
}

#[cfg(test)]
mod energy_tests;
