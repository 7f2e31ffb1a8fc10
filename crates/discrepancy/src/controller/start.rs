//! A start from least squares that is linear in products of the gains.

use axis_sim::Axis;
use nalgebra::{DMatrix, DVector, Matrix6, Vector6};

use super::low_pass::low_pass;
use super::seen::{Seen, interpolated};

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

/// Gains to begin with.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// As the form has them; at the motor for a cascade, effort per rad/s.
    pub gains: [f64; 4],
    /// Of the logged command, in control cycles.
    pub delay: f64,
}

/// Delays tried, in control cycles.
const DELAYS: std::ops::RangeInclusive<i32> = -4..=12;
/// Kv tried, 1/s, evenly by their logarithms: the first, the factor, and how many.
const KV: (f64, f64, i32) = (0.5, 1.1, 90);
/// Feed-forwards tried.
const FEEDFORWARD: [f64; 7] = [0.0, 0.25, 0.5, 0.75, 0.9, 1.0, 1.1];

/// Sums over all logs of products of the signals e, v_ref, ω and their integrals (G), and of
/// these with the command (g).
struct Products {
    delay: f64,
    all: Matrix6<f64>,
    with_command: Vector6<f64>,
}

/// The gains of a form that leave least of the command; none where none are above zero.
pub fn start(
    axis: &Axis,
    logs: &[Seen],
    cutoff: f64,
    form: Form,
    from_motor: bool,
) -> Option<Start> {
    let signals: Vec<Filtered> = logs
        .iter()
        .map(|log| filtered(axis, log, cutoff, from_motor))
        .collect();
    let mut all = Matrix6::zeros();
    for signal in &signals {
        all += Matrix6::from_fn(|i, j| dot(&signal.columns[i], &signal.columns[j]));
    }
    let candidates = DELAYS.map(|halves| {
        let delay = 0.5 * f64::from(halves);
        let mut with_command = Vector6::zeros();
        for signal in &signals {
            let late: Vec<f64> = (0..signal.command.len())
                .map(|k| interpolated(&signal.command, k as f64 + delay))
                .collect();
            with_command += Vector6::from_fn(|i, _| dot(&signal.columns[i], &late));
        }
        Products {
            delay,
            all,
            with_command,
        }
    });
    let found = candidates.filter_map(|products| match form {
        Form::Pid => pid(&products, axis.travel_per_radian()),
        _ => cascade(&products, form),
    });
    let best = found.max_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, start)| start)
}

struct Filtered {
    columns: [Vec<f64>; 6],
    command: Vec<f64>,
}

fn filtered(axis: &Axis, log: &Seen, cutoff: f64, from_motor: bool) -> Filtered {
    let (h, travel) = (axis.period, axis.travel_per_radian());
    let home = log.measured[0].position - travel * log.measured[0].motor_angle;
    let pairs = || log.reference.iter().zip(&log.measured);
    let error = pairs().map(|(reference, seen)| match from_motor {
        true => (reference.position - home) / travel - seen.motor_angle,
        false => (reference.position - seen.position) / travel,
    });
    let error: Vec<f64> = error.collect();
    let fed: Vec<f64> = pairs()
        .map(|(reference, _)| reference.velocity / travel)
        .collect();
    let speed: Vec<f64> = pairs().map(|(_, seen)| seen.motor_speed).collect();
    let integral = |samples: &[f64]| -> Vec<f64> {
        let sum = samples.iter().scan(0.0, |sum, x| {
            *sum += h * x;
            Some(*sum)
        });
        sum.collect()
    };
    let [ie, iv, iw] = [&error, &fed, &speed].map(|samples| integral(samples));
    let pass = |samples: Vec<f64>| {
        let mut passed = low_pass(&samples, cutoff, h);
        let mean = passed.iter().sum::<f64>() / passed.len() as f64;
        let lost = passed.iter_mut().zip(&log.missing);
        lost.for_each(|(x, lost)| *x = if *lost { 0.0 } else { *x - mean });
        passed
    };
    let command = log
        .command
        .iter()
        .zip(&log.added)
        .map(|(u, added)| u - added);
    Filtered {
        columns: [error, fed, speed, ie, iv, iw].map(pass),
        command: pass(command.collect()),
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// By how much the squares fall, and the gains.
fn cascade(products: &Products, form: Form) -> Option<(f64, Start)> {
    let feedforwards = match form {
        Form::Proportional => &FEEDFORWARD[..1],
        _ => &FEEDFORWARD,
    };
    let mut best: Option<(f64, Start)> = None;
    for i in 0..KV.2 {
        let kv = KV.0 * KV.1.powi(i);
        for &fed in feedforwards {
            let a = Vector6::new(kv, fed, -1.0, 0.0, 0.0, 0.0);
            let b = Vector6::new(0.0, 0.0, 0.0, kv, fed, -1.0);
            let g = |x: &Vector6<f64>, y: &Vector6<f64>| (x.transpose() * products.all * y)[0];
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
            let [kp, ki] = gains;
            let fall = kp * au + ki * bu;
            if kp > 0.0 && fall.is_finite() && best.is_none_or(|(most, _)| fall > most) {
                let start = Start {
                    gains: [kv, fed, kp, ki],
                    delay: products.delay,
                };
                best = Some((fall, start));
            }
        }
    }
    best
}

fn pid(products: &Products, travel: f64) -> Option<(f64, Start)> {
    // e, ∫e and ė at the load, of the signals at the motor.
    let mut columns = DMatrix::zeros(6, 3);
    columns[(0, 0)] = travel;
    columns[(3, 1)] = travel;
    columns[(1, 2)] = travel;
    columns[(2, 2)] = -travel;
    let all = DMatrix::from_fn(6, 6, |i, j| products.all[(i, j)]);
    let command = DVector::from_fn(6, |i, _| products.with_command[i]);
    let right = columns.transpose() * command;
    let gains = (columns.transpose() * all * columns)
        .cholesky()?
        .solve(&right);
    let fall = gains.dot(&right);
    let gains = [gains[0], gains[1], gains[2], 0.0].map(|gain| gain.max(0.0));
    (gains[0] > 0.0).then_some((
        fall,
        Start {
            gains,
            delay: products.delay,
        },
    ))
}
