//! The slow, obvious integration, from the paper's equations alone: classical
//! Runge–Kutta of fourth order on every coordinate and the bristles, the chain
//! assembled here, the nut's and the friction's laws written out once more.

use feed_dynamics::NutCoupling;
use nalgebra::DMatrix;
use std::f64::consts::{PI, TAU};

/// Motor speed, table displacement, table speed, nut force.
pub type Seen = [f64; 4];

/// What acts on the drive, beside friction.
#[derive(Clone, Copy)]
pub struct Acts {
    /// Motor torque, N·m, from time.
    pub torque: fn(f64) -> f64,
    /// Load on the table, N, from time and table speed.
    pub load: fn(f64, f64) -> f64,
    /// The nut's offset, m, and its rate, m/s, from time.
    pub offset: fn(f64) -> [f64; 2],
    /// m
    pub gap: f64,
}

impl Default for Acts {
    fn default() -> Self {
        Self {
            torque: |_| 0.0,
            load: |_, _| 0.0,
            offset: |_| [0.0; 2],
            gap: 0.0,
        }
    }
}

/// The paper's drive (Tables 2 and 3), 40 mm × 1.5 m of steel in ten elements.
#[derive(Clone, Copy)]
pub struct Reference {
    pub mass: f64,
    pub beta: f64,
    pub coupling: NutCoupling,
    /// Axial stiffness between screw and table with the table at x, N/m.
    pub nut: fn(f64) -> f64,
    /// T_C, T_S (N·m), Ω_S (rad/s), σ0, σ1, σ2 at the screw; none for no friction.
    pub friction: Option<[f64; 6]>,
    pub origin: f64,
    pub state: State,
}

const NODES: usize = 11;
const CHAIN: usize = NODES + 2;
const NUT: f64 = 7.45e7;
const R: f64 = 0.010 / TAU;

/// Angles of motor, sensor and screw, table displacement; their rates; bristles.
#[derive(Clone, Copy)]
pub struct State {
    q: [f64; CHAIN + 1],
    v: [f64; CHAIN + 1],
    z: f64,
}

/// Tridiagonal: diagonal and what is above it.
type Band = [[f64; CHAIN]; 2];

impl Reference {
    /// At rest, relaxed, the table at `origin`.
    pub fn at_rest(coupling: NutCoupling, origin: f64) -> Self {
        Self {
            mass: 515.0,
            beta: 1e-5,
            coupling,
            nut: |_| NUT,
            friction: None,
            origin,
            state: State {
                q: [0.0; CHAIN + 1],
                v: [0.0; CHAIN + 1],
                z: 0.0,
            },
        }
    }

    /// M and K of the chain, the screw's node on or before the nut and its weight.
    fn chain(&self, x: f64) -> (Band, Band, usize, f64) {
        let shear = 206e9 / (2.0 * 1.3);
        let polar = PI * 0.04_f64.powi(4) / 32.0;
        let mut nodes: [f64; NODES] = std::array::from_fn(|i| 0.15 * i as f64);
        let (node, weight) = match self.coupling {
            NutCoupling::ShapeFunctions => {
                let node = ((x / 0.15) as usize).min(NODES - 2);
                (node, 1.0 - (x / 0.15 - node as f64))
            }
            NutCoupling::MovingNode => {
                // Eq. (1); the tests stay inside one element.
                let node = (x / 0.15).ceil() as usize;
                nodes[node] = x;
                (node, 1.0)
            }
        };
        let (mut m, mut k) = ([[0.0; CHAIN]; 2], [[0.0; CHAIN]; 2]);
        (m[0][0], m[0][1]) = (0.0053, 1e-4);
        for i in 0..2 {
            k[0][i] += 2800.0;
            k[0][i + 1] += 2800.0;
            k[1][i] -= 2800.0;
        }
        for e in 0..NODES - 1 {
            let l = nodes[e + 1] - nodes[e];
            let (inertia, stiff) = (7850.0 * polar * l, shear * polar / l);
            for i in [2 + e, 3 + e] {
                m[0][i] += inertia / 3.0;
                k[0][i] += stiff;
            }
            m[1][2 + e] = inertia / 6.0;
            k[1][2 + e] = -stiff;
        }
        (m, k, 2 + node, weight)
    }

    /// M and K of the whole drive with the table at its start.
    pub fn dense(&self) -> [DMatrix<f64>; 2] {
        let (m, k, node, weight) = self.chain(self.origin);
        let full = |band: Band, table: f64| {
            DMatrix::from_fn(CHAIN + 1, CHAIN + 1, |i, j| {
                match (i.max(j), i.abs_diff(j)) {
                    (CHAIN, 0) => table,
                    (CHAIN, _) => 0.0,
                    (_, 0) => band[0][i],
                    (_, 1) => band[1][i.min(j)],
                    _ => 0.0,
                }
            })
        };
        let mut b = DMatrix::zeros(CHAIN + 1, 1);
        b[node] = R * weight;
        b[node + 1] += R * (1.0 - weight);
        b[CHAIN] = -1.0;
        [
            full(m, self.mass),
            full(k, 0.0) + &b * b.transpose() * (self.nut)(self.origin),
        ]
    }

    /// Rates of all of the state, and the nut force.
    fn rate(&self, s: &State, t: f64, acts: &Acts) -> (State, f64) {
        let (m, k, node, weight) = self.chain(self.origin + s.q[CHAIN]);
        let at = |a: &[f64; CHAIN + 1]| weight * a[node] + (1.0 - weight) * a[node + 1];
        let [offset, offset_rate] = (acts.offset)(t);
        let delta = R * at(&s.q) + offset - s.q[CHAIN];
        let closing = R * at(&s.v) + offset_rate - s.v[CHAIN];
        let stiffness = (self.nut)(self.origin + s.q[CHAIN]);
        let nut = nut_force(stiffness, delta, closing, self.beta, acts.gap);

        let mut force = [0.0; CHAIN];
        for i in 0..CHAIN {
            let wound = |i: usize| s.q[i] + self.beta * s.v[i];
            force[i] -= k[0][i] * wound(i);
            if i + 1 < CHAIN {
                force[i] -= k[1][i] * wound(i + 1);
                force[i + 1] -= k[1][i] * wound(i);
            }
        }
        force[0] += (acts.torque)(t);
        force[node] -= R * nut * weight;
        if weight < 1.0 {
            force[node + 1] -= R * nut * (1.0 - weight);
        }
        let (rubbing, bristle_rate) = self.rub(s);
        let mut v = [0.0; CHAIN + 1];
        v[..CHAIN].copy_from_slice(&solve(m, force));
        v[CHAIN] = (nut - rubbing - (acts.load)(t, s.v[CHAIN])) / self.mass;
        let rates = State {
            q: s.v,
            v,
            z: bristle_rate,
        };
        (rates, nut)
    }

    /// Friction on the table, N, and dz/dt: the LuGre law.
    fn rub(&self, s: &State) -> (f64, f64) {
        let Some([coulomb, stiction, stribeck, s0, s1, s2]) = self.friction else {
            return (0.0, 0.0);
        };
        let w = s.v[CHAIN] / R;
        let level = coulomb + (stiction - coulomb) * (-(w / stribeck).powi(2)).exp();
        let rate = w - s0 * w.abs() * s.z / level;
        ((s0 * s.z + s1 * rate + s2 * w) / R, rate)
    }

    /// One step from `t` to `t + h`.
    pub fn step(&mut self, t: f64, h: f64, acts: &Acts) {
        let s = self.state;
        let to = |r: &State, h: f64| s.moved(r, h);
        let a = self.rate(&s, t, acts).0;
        let b = self.rate(&to(&a, 0.5 * h), t + 0.5 * h, acts).0;
        let c = self.rate(&to(&b, 0.5 * h), t + 0.5 * h, acts).0;
        let d = self.rate(&to(&c, h), t + h, acts).0;
        for (rate, part) in [(a, 1.0), (b, 2.0), (c, 2.0), (d, 1.0)] {
            self.state = self.state.moved(&rate, h * part / 6.0);
        }
    }

    pub fn seen(&self, t: f64, acts: &Acts) -> Seen {
        let s = &self.state;
        let (_, nut) = self.rate(s, t, acts);
        [s.v[0], s.q[CHAIN], s.v[CHAIN], nut]
    }

    /// What is seen at the ends of `count` equal parts of `duration`, in steps of `h`.
    pub fn run(mut self, acts: &Acts, duration: f64, count: usize, h: f64) -> Vec<Seen> {
        let part = (duration / count as f64 / h).round() as usize;
        let mut seen = Vec::new();
        for i in 0..count * part {
            self.step(i as f64 * h, h, acts);
            if (i + 1) % part == 0 {
                seen.push(self.seen((i + 1) as f64 * h, acts));
            }
        }
        seen
    }
}

impl State {
    fn moved(&self, rate: &State, h: f64) -> State {
        State {
            q: std::array::from_fn(|i| self.q[i] + h * rate.q[i]),
            v: std::array::from_fn(|i| self.v[i] + h * rate.v[i]),
            z: self.z + h * rate.z,
        }
    }
}

/// A preloaded nut without a gap; with one, one flank at most, which never pulls.
pub fn nut_force(k: f64, delta: f64, closing: f64, beta: f64, gap: f64) -> f64 {
    let damping = beta * k;
    if gap == 0.0 {
        k * delta + damping * closing
    } else if delta > 0.5 * gap {
        f64::max(0.0, k * (delta - 0.5 * gap) + damping * closing)
    } else if delta < -0.5 * gap {
        f64::min(0.0, k * (delta + 0.5 * gap) + damping * closing)
    } else {
        0.0
    }
}

/// m a = f by elimination.
fn solve(m: Band, mut f: [f64; CHAIN]) -> [f64; CHAIN] {
    let [mut diagonal, above] = m;
    for i in 1..CHAIN {
        let factor = above[i - 1] / diagonal[i - 1];
        diagonal[i] -= factor * above[i - 1];
        f[i] -= factor * f[i - 1];
    }
    for i in (0..CHAIN).rev() {
        if i + 1 < CHAIN {
            f[i] -= above[i] * f[i + 1];
        }
        f[i] /= diagonal[i];
    }
    f
}
