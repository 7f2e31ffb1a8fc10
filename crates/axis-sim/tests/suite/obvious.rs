//! A slow, obvious simulation of trajectory 1 of the axis of Liu et al. 2025
//! (Machines 13(5), 433, doi:10.3390/machines13050433), for comparison.
//!
//! Written from the equations and the values of the page on the axis alone, in
//! the most direct way: dense matrices, the classical Runge–Kutta method of
//! fourth order with steps of a microsecond, every law spelled out. It uses
//! nothing of the project's crates and reads no axis file.
//!
//! The fastest mode of the screw's mesh has 7·10⁴ rad/s and is damped with a
//! rate of 3·10⁴ 1/s: a microsecond is a thirtieth of what is stable, and
//! halving it moves the table by less than a picometre.

/// Motor, torque sensor, eleven nodes of the screw, table.
const COORDINATES: usize = 14;
const TABLE: usize = COORDINATES - 1;
/// Elements of the screw.
const ELEMENTS: usize = 10;

type Vector = [f64; COORDINATES];
type Matrix = [Vector; COORDINATES];

/// rad/s in one rpm.
const RPM: f64 = std::f64::consts::TAU / 60.0;
/// Travel per radian, m/rad.
const R: f64 = 0.010 / std::f64::consts::TAU;
const SCREW_LENGTH: f64 = 1.5;
const NUT_STIFFNESS: f64 = 7.45e7;
const STIFFNESS_DAMPING: f64 = 1e-5;
/// Table position at the start, m.
const START: f64 = 0.6;
/// Control period, s.
pub const PERIOD: f64 = 1e-4;

/// What the machine and its controller are at a sampling instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Row {
    /// s.
    pub time: f64,
    /// m.
    pub reference: f64,
    /// m.
    pub position: f64,
    /// rad.
    pub motor_angle: f64,
    /// rad/s.
    pub motor_speed: f64,
    /// A.
    pub iq: f64,
}

/// All that changes by differential equations.
#[derive(Clone, Copy)]
struct State {
    q: Vector,
    v: Vector,
    id: f64,
    iq: f64,
    z: f64,
}

impl State {
    const REST: Self = Self {
        q: [0.0; COORDINATES],
        v: [0.0; COORDINATES],
        id: 0.0,
        iq: 0.0,
        z: 0.0,
    };

    fn plus(mut self, h: f64, rate: &Self) -> Self {
        for i in 0..COORDINATES {
            self.q[i] += h * rate.q[i];
            self.v[i] += h * rate.v[i];
        }
        self.id += h * rate.id;
        self.iq += h * rate.iq;
        self.z += h * rate.z;
        self
    }
}

/// The torsional chain without the nut.
struct Chain {
    inverse_mass: Matrix,
    stiffness: Matrix,
}

impl Chain {
    fn new() -> Self {
        let diameter = 0.040_f64;
        let polar = std::f64::consts::PI * diameter.powi(4) / 32.0;
        let shear_modulus = 206e9 / (2.0 * (1.0 + 0.3));
        let length = SCREW_LENGTH / ELEMENTS as f64;
        let spring = shear_modulus * polar / length;
        let inertia = 7850.0 * polar * length;

        let mut mass = [[0.0; COORDINATES]; COORDINATES];
        let mut stiffness = [[0.0; COORDINATES]; COORDINATES];
        mass[0][0] = 0.0053;
        mass[1][1] = 1e-4;
        mass[TABLE][TABLE] = 515.0;
        let mut between = |a: usize, b: usize, k: f64| {
            stiffness[a][a] += k;
            stiffness[b][b] += k;
            stiffness[a][b] -= k;
            stiffness[b][a] -= k;
        };
        between(0, 1, 2800.0);
        between(1, 2, 2800.0);
        for element in 0..ELEMENTS {
            let (a, b) = (2 + element, 3 + element);
            between(a, b, spring);
            mass[a][a] += inertia / 3.0;
            mass[b][b] += inertia / 3.0;
            mass[a][b] += inertia / 6.0;
            mass[b][a] += inertia / 6.0;
        }
        Self {
            inverse_mass: inverse(mass),
            stiffness,
        }
    }

    /// What the nut's spring is stretched by: its product with the coordinates.
    /// The nut sits on the screw's mesh where the table is.
    fn nut(x: f64) -> Vector {
        let along = x / SCREW_LENGTH * ELEMENTS as f64;
        let element = (along.floor() as usize).min(ELEMENTS - 1);
        let part = along - element as f64;
        let mut nut = [0.0; COORDINATES];
        nut[2 + element] = R * (1.0 - part);
        nut[3 + element] = R * part;
        nut[TABLE] = -1.0;
        nut
    }

    /// M⁻¹ (F − K (q + β v)).
    fn acceleration(&self, state: &State, torque: f64, load: f64) -> Vector {
        let p: Vector = std::array::from_fn(|i| state.q[i] + STIFFNESS_DAMPING * state.v[i]);
        let nut = Self::nut(START + state.q[TABLE]);
        let stretch = dot(&nut, &p);
        let mut force: Vector = std::array::from_fn(|i| {
            -dot(&self.stiffness[i], &p) - NUT_STIFFNESS * nut[i] * stretch
        });
        force[0] += torque;
        force[TABLE] -= load;
        self.inverse_mass.map(|row| dot(&row, &force))
    }
}

fn dot(a: &Vector, b: &Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Gauss and Jordan; the matrix is positive definite.
fn inverse(mut a: Matrix) -> Matrix {
    let mut b = [[0.0; COORDINATES]; COORDINATES];
    for (i, row) in b.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    for i in 0..COORDINATES {
        let pivot = a[i][i];
        for j in 0..COORDINATES {
            a[i][j] /= pivot;
            b[i][j] /= pivot;
        }
        for k in (0..COORDINATES).filter(|k| *k != i) {
            let factor = a[k][i];
            for j in 0..COORDINATES {
                a[k][j] -= factor * a[i][j];
                b[k][j] -= factor * b[i][j];
            }
        }
    }
    b
}

/// Rates of change under the held voltages `ud` and `uq`.
fn rates(chain: &Chain, s: &State, ud: f64, uq: f64) -> State {
    // Motor.
    let (pairs, resistance, ld, lq) = (4.0, 0.75, 4.11e-3, 13.2e-3);
    let flux = 1.641 / (1.5 * pairs);
    let electrical = pairs * s.v[0];
    let torque = 1.5 * pairs * (flux * s.iq + (ld - lq) * s.id * s.iq);

    // LuGre, at the table, on the equivalent screw speed.
    let (coulomb, stiction, stribeck) = (0.6757, 0.7653, 25.9147 * RPM);
    let (sigma0, sigma1, sigma2) = (1.5875 / RPM, 0.1593 / RPM, 0.0003 / RPM);
    let w = s.v[TABLE] / R;
    let level = coulomb + (stiction - coulomb) * (-(w / stribeck).powi(2)).exp();
    let z_rate = w - sigma0 * w.abs() * s.z / level;
    let friction = sigma0 * s.z + sigma1 * z_rate + sigma2 * w;

    State {
        q: s.v,
        v: chain.acceleration(s, torque, friction / R),
        id: (ud - resistance * s.id + electrical * lq * s.iq) / ld,
        iq: (uq - resistance * s.iq - electrical * (ld * s.id + flux)) / lq,
        z: z_rate,
    }
}

/// One classical Runge–Kutta step.
fn runge_kutta(chain: &Chain, s: &State, ud: f64, uq: f64, h: f64) -> State {
    let k1 = rates(chain, s, ud, uq);
    let k2 = rates(chain, &s.plus(0.5 * h, &k1), ud, uq);
    let k3 = rates(chain, &s.plus(0.5 * h, &k2), ud, uq);
    let k4 = rates(chain, &s.plus(h, &k3), ud, uq);
    s.plus(h / 6.0, &k1)
        .plus(h / 3.0, &k2)
        .plus(h / 3.0, &k3)
        .plus(h / 6.0, &k4)
}

/// A PI controller that integrates first; at its limit the integral waits.
struct Pi {
    proportional: f64,
    integral: f64,
    limit: f64,
    sum: f64,
}

impl Pi {
    fn new(proportional: f64, integral: f64, limit: f64) -> Self {
        Self {
            proportional,
            integral,
            limit,
            sum: 0.0,
        }
    }

    fn output(&mut self, error: f64) -> f64 {
        let sum = self.sum + self.integral * error * PERIOD;
        let output = self.proportional * error + sum;
        if output.abs() <= self.limit {
            self.sum = sum;
        }
        output.clamp(-self.limit, self.limit)
    }
}

/// Position and velocity of trajectory 1: 300 mm at 100 mm/s, 225 mm/s² and
/// 1200 mm/s³, in seven phases of constant jerk.
fn reference(t: f64) -> (f64, f64) {
    let (speed, acceleration, jerk) = (0.100, 0.225, 1.200);
    let rise = acceleration / jerk;
    let hold = speed / acceleration - rise;
    let cruise = duration() - 2.0 * (2.0 * rise + hold);
    let phases = [
        (rise, jerk),
        (hold, 0.0),
        (rise, -jerk),
        (cruise, 0.0),
        (rise, -jerk),
        (hold, 0.0),
        (rise, jerk),
    ];
    let (mut s, mut v, mut a, mut left) = (START, 0.0, 0.0, t);
    for (length, jerk) in phases {
        let dt = left.min(length);
        s += v * dt + a * dt * dt / 2.0 + jerk * dt * dt * dt / 6.0;
        v += a * dt + jerk * dt * dt / 2.0;
        a += jerk * dt;
        left -= dt;
    }
    (s, v)
}

/// d/V + V/A + A/J, s.
pub fn duration() -> f64 {
    0.300 / 0.100 + 0.100 / 0.225 + 0.225 / 1.200
}

/// Follows the trajectory for `cycles` control cycles with `steps` Runge–Kutta
/// steps in each, and shows every sampling instant.
pub fn simulate(cycles: usize, steps: usize, mut show: impl FnMut(&Row)) {
    let chain = Chain::new();
    let voltage = 540.0 / 3f64.sqrt();
    let position_gain = 280.2 * RPM * 1e3;
    let mut speed_loop = Pi::new(0.0678 / RPM, 0.7122 / RPM, 15.0);
    let mut d_loop = Pi::new(2.776, 626.2, voltage);
    let mut q_loop = Pi::new(8.805, 1003.3, voltage);
    let mut state = State::REST;
    for k in 0..cycles {
        let time = k as f64 * PERIOD;
        let (s_ref, v_ref) = reference(time);
        let row = Row {
            time,
            reference: s_ref,
            position: START + state.q[TABLE],
            motor_angle: state.q[0],
            motor_speed: state.v[0],
            iq: state.iq,
        };
        show(&row);

        let speed_ref = position_gain * (s_ref - row.position) + v_ref / R;
        let iq_ref = speed_loop.output(speed_ref - row.motor_speed);
        let ud = d_loop.output(0.0 - state.id);
        let uq = q_loop.output(iq_ref - state.iq);
        for _ in 0..steps {
            state = runge_kutta(&chain, &state, ud, uq, PERIOD / steps as f64);
        }
    }
}

/// Steps of a cycle in the committed file: a microsecond each.
pub const STEPS: usize = 100;
/// Cycles between the file's rows: 5 ms.
pub const EVERY: usize = 50;
/// First line of the file.
pub const HEADER: &str = "t_s,position_ref_m,position_m,motor_angle_rad,motor_speed_rad_s,iq_a";

/// A line of the file.
pub fn line(row: &Row) -> String {
    format!(
        "{:.3},{:.13},{:.13},{:.9e},{:.9e},{:.9e}",
        row.time, row.reference, row.position, row.motor_angle, row.motor_speed, row.iq
    )
}
