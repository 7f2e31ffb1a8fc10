//! A start from least squares that is linear in the speed controller's gains.

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use super::equation::Equation;
use super::seen::Seen;

/// What the command is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// u = K_p (Kv e + f v_ref / r − ω) + K_i ∫(…) + c: Kv, f, K_p, K_i.
    ProportionalIntegral,
    /// The same without f and K_i.
    Proportional,
    /// u = K_P e + K_I ∫e + K_D ė + c: K_P, K_I, K_D.
    Pid,
}

/// Kv tried, 1/s, evenly by their logarithms: the first, the factor, and how many.
const KV: (f64, f64, i32) = (0.5, 1.1, 90);
/// Feed-forwards tried.
const FEEDFORWARD: [f64; 7] = [0.0, 0.25, 0.5, 0.75, 0.9, 1.0, 1.1];

/// Sums over all logs of products of e, v_ref and ω and their integrals, at the motor (G),
/// and of these with the command (g).
struct Products {
    all: Matrix6<f64>,
    with_command: Vector6<f64>,
}

/// The gains of a form that leave least of the command, those of a cascade at the motor in
/// effort per rad/s; none if none are above zero.
pub fn start(equation: &Equation<'_>, form: Form, from_motor: bool) -> Option<[f64; 4]> {
    let mut products = Products {
        all: Matrix6::zeros(),
        with_command: Vector6::zeros(),
    };
    for log in &equation.logs {
        let columns = columns(equation, log, from_motor);
        let command = equation.compared(log, true, &unfed(equation, log, form));
        products.all += Matrix6::from_fn(|i, j| dot(&columns[i], &columns[j]));
        products.with_command += Vector6::from_fn(|i, _| dot(&columns[i], &command));
    }
    match form {
        Form::Pid => pid(&products, equation.axis.travel_per_radian()),
        _ => cascade(&products, form),
    }
}

/// e, v_ref and ω at the motor, and their integrals, as they are compared.
fn columns(equation: &Equation<'_>, log: &Seen, from_motor: bool) -> [Vec<f64>; 6] {
    let (h, travel) = (equation.axis.period, equation.axis.travel_per_radian());
    let first = log.measured.first().copied().unwrap_or_default();
    let home = first.position - travel * first.motor_angle;
    let pairs = || log.reference.iter().zip(&log.measured);
    let error = pairs().map(|(reference, seen)| match from_motor {
        true => (reference.position - home) / travel - seen.motor_angle,
        false => (reference.position - seen.position) / travel,
    });
    let error: Vec<f64> = error.collect();
    let fed: Vec<f64> = pairs().map(|(r, _)| r.velocity / travel).collect();
    let speed: Vec<f64> = pairs().map(|(_, seen)| seen.motor_speed).collect();
    let integral = |samples: &[f64]| -> Vec<f64> {
        let sum = samples.iter().scan(0.0, |sum, x| {
            *sum += h * x;
            Some(*sum)
        });
        sum.collect()
    };
    let integrals = [&error, &fed, &speed].map(|samples| integral(samples));
    let [ie, iv, iw] = integrals;
    [error, fed, speed, ie, iv, iw].map(|samples| {
        let at = |k: usize| super::equation::interpolated(&samples, k as f64 * log.log_period / h);
        let shown: Vec<f64> = (0..log.command.len()).map(at).collect();
        equation.compared(log, true, &shown)
    })
}

/// The logged command without the acceleration feed-forward that a cascade of the file has,
/// which stays as it is.
fn unfed(equation: &Equation<'_>, log: &Seen, form: Form) -> Vec<f64> {
    let axis = equation.axis;
    let cascade = (axis.control).cascade(axis.travel_per_radian(), axis.period);
    let fed = cascade.map_or(0.0, |cascade| cascade.acceleration_feedforward);
    if form != Form::ProportionalIntegral || fed == 0.0 {
        return log.command.clone();
    }
    let acceleration: Vec<f64> = log.reference.iter().map(|r| r.acceleration).collect();
    let at = |k: usize| {
        let along = k as f64 * log.log_period / axis.period;
        log.command[k] - fed * super::equation::interpolated(&acceleration, along)
    };
    (0..log.command.len()).map(at).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Kv and f from a grid, K_p and K_i by least squares.
fn cascade(products: &Products, form: Form) -> Option<[f64; 4]> {
    let feedforwards = match form {
        Form::Proportional => &FEEDFORWARD[..1],
        _ => &FEEDFORWARD,
    };
    let mut best: Option<(f64, [f64; 4])> = None;
    for i in 0..KV.2 {
        let kv = KV.0 * KV.1.powi(i);
        for &fed in feedforwards {
            let Some((fall, [kp, ki])) = speed_gains(products, form, kv, fed) else {
                continue;
            };
            if best.is_none_or(|(most, _)| fall > most) {
                best = Some((fall, [kv, fed, kp, ki]));
            }
        }
    }
    best.map(|(_, gains)| gains)
}

/// K_p and K_i under a position controller, and by how much the squares fall.
fn speed_gains(products: &Products, form: Form, kv: f64, fed: f64) -> Option<(f64, [f64; 2])> {
    let a = Vector6::new(kv, fed, -1.0, 0.0, 0.0, 0.0);
    let b = Vector6::new(0.0, 0.0, 0.0, kv, fed, -1.0);
    let g = |x: &Vector6<f64>, y: &Vector6<f64>| x.dot(&(products.all * y));
    let (aa, ab, bb) = (g(&a, &a), g(&a, &b), g(&b, &b));
    let (au, bu) = (a.dot(&products.with_command), b.dot(&products.with_command));
    let det = aa * bb - ab * ab;
    let mut gains = [au / aa, 0.0];
    if form == Form::ProportionalIntegral && det > 1e-12 * aa * bb {
        let both = [(au * bb - bu * ab) / det, (bu * aa - au * ab) / det];
        if both.iter().all(|gain| *gain > 0.0) {
            gains = both;
        }
    }
    let fall = gains[0] * au + gains[1] * bu;
    (gains[0] > 0.0 && fall.is_finite()).then_some((fall, gains))
}

fn pid(products: &Products, travel: f64) -> Option<[f64; 4]> {
    // e, ∫e and ė at the load, of the signals at the motor.
    let columns = [
        Vector6::new(travel, 0.0, 0.0, 0.0, 0.0, 0.0),
        Vector6::new(0.0, 0.0, 0.0, travel, 0.0, 0.0),
        Vector6::new(0.0, travel, -travel, 0.0, 0.0, 0.0),
    ];
    let right = Vector3::from_fn(|i, _| columns[i].dot(&products.with_command));
    let all = Matrix3::from_fn(|i, j| columns[i].dot(&(products.all * columns[j])));
    let gains = all.cholesky()?.solve(&right);
    (gains[0] > 0.0).then(|| [gains[0], gains[1].max(0.0), gains[2].max(0.0), 0.0])
}
