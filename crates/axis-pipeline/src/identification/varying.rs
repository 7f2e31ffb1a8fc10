//! Friction against speed from motions whose speed changes slowly, for logs without enough
//! runs at constant speed.
//!
//! Over a window the mean torque is the mean of friction plus inertia times the change of speed
//! over its length, whatever goes on inside. The inertia is found from the same windows, as
//! that of an axis file may be a guess.

use std::collections::BTreeMap;

use axis_log::PlusMinus;
use lugre::identify::ConstantSpeedRun;
use nalgebra::{SMatrix, SVector};

use super::found::SpeedRun;
use super::steady::Record;

/// Length of a window, s, and fewest samples in it.
const WINDOW: f64 = 0.1;
const FEWEST_IN_WINDOW: usize = 16;

/// Most that the speed may change over a window, as a share of its mean.
const CHANGE: f64 = 0.5;

/// Speeds that count as one run: this many to a decade.
const PER_DECADE: f64 = 8.0;

/// Fewest windows of a run: with fewer their scatter says little.
const FEWEST: usize = 4;

/// Rounds of the robust fit, and the residual, in deviations, beyond which a window weighs
/// less (P. J. Huber, Ann. Math. Statist. 35 (1964) 73–101, doi:10.1214/aoms/1177703732).
const ROUNDS: usize = 20;
const OUTLYING: f64 = 1.345;

/// The standard error of the inertia, as a share, above which the axis file's stands.
const INERTIA_KNOWN: f64 = 0.2;

/// A window.
struct Window {
    log: usize,
    time: [f64; 2],
    /// m/s or rad/s of the load.
    speed: f64,
    acceleration: f64,
    /// Motor's less loads, at the load.
    force: f64,
}

/// The runs that are found so, and what is worth telling of the inertia.
pub(super) struct Varying {
    pub runs: Vec<SpeedRun>,
    pub windows: usize,
    pub note: Option<String>,
}

/// Runs made of windows of like speed, over all logs.
pub(super) fn runs(records: &[Record<'_>]) -> Varying {
    let windows: Vec<Window> = records.iter().flat_map(windows).collect();
    let Some(record) = records.first() else {
        return Varying {
            runs: Vec::new(),
            windows: 0,
            note: None,
        };
    };
    let filed = record.inertia();
    let found = inertia(&windows).filter(|[value, error]| *error < INERTIA_KNOWN * value);
    let inertia = found.map_or(filed, |[value, _]| value);
    let note = found.map(|[value, error]| {
        format!(
            "too few stretches of constant speed: friction was read from {} short windows of slowly changing speed as well, with the inertia that they show, {} times the axis file's",
            windows.len(),
            PlusMinus::new(value / filed, error / filed, 3)
        )
    });
    let lever = record.axis.friction.lever(record.axis.travel_per_radian());
    let mut bins: BTreeMap<(usize, bool, i64), Vec<&Window>> = BTreeMap::new();
    for window in &windows {
        let place = (PER_DECADE * window.speed.abs().log10()).floor() as i64;
        let key = (window.log, window.speed > 0.0, place);
        bins.entry(key).or_default().push(window);
    }
    let many = bins.into_values().filter(|bin| bin.len() >= FEWEST);
    Varying {
        runs: many.map(|bin| run(&bin, inertia, lever)).collect(),
        windows: windows.len(),
        note,
    }
}

/// Windows side by side in which the load slides one way throughout, and did in the one before.
fn windows(record: &Record<'_>) -> Vec<Window> {
    let period = record.shown.period();
    let length = ((WINDOW / period).round() as usize).max(FEWEST_IN_WINDOW);
    let time = length as f64 * period;
    let slides = |from: usize| {
        let quarter = length / 4;
        let speeds = [0, 1, 2, 3].map(|i| {
            let at = from + i * quarter;
            record.mean_speed(at, at + quarter)
        });
        let moves = speeds.iter().all(|&v| record.moves(v, 0.25 * time));
        let one_way = speeds.iter().all(|v| v * speeds[0] > 0.0);
        let free = record.taken[from..from + length].iter().all(|taken| !taken);
        (moves && one_way && free).then_some(speeds[0].signum())
    };
    let starts = (0..record.position.len().saturating_sub(length)).step_by(length);
    let mut before = None;
    let mut found = Vec::new();
    for from in starts {
        let now = slides(from);
        if now.is_some() && now == before {
            let samples = from..from + length;
            let speed = record.mean_speed(from, from + length);
            let acceleration = record.acceleration(&samples);
            if (acceleration * time).abs() <= CHANGE * speed.abs() {
                let force = &record.force[samples.clone()];
                found.push(Window {
                    log: record.log,
                    time: record.time(&samples),
                    force: force.iter().sum::<f64>() / length as f64,
                    speed,
                    acceleration,
                });
            }
        }
        before = now;
    }
    found
}

/// The inertia that the windows show beside Coulomb's and viscous friction and an offset, with
/// its standard error; `None` if they do not tell it.
fn inertia(windows: &[Window]) -> Option<[f64; 2]> {
    type Row = SVector<f64, 4>;
    let count = windows.len();
    if count < 4 * FEWEST {
        return None;
    }
    let rows = |w: &Window| Row::new(w.acceleration, w.speed.signum(), w.speed, 1.0);
    // Columns of one size, so that the normal equations can be solved.
    let sum = |i: usize| -> f64 { windows.iter().map(|w| rows(w)[i].powi(2)).sum() };
    let scale = Row::from_fn(|i, _| sum(i).sqrt().max(f64::MIN_POSITIVE));
    let mut weights = vec![1.0; count];
    let mut found = None;
    for _ in 0..ROUNDS {
        let mut normal = SMatrix::<f64, 4, 4>::zeros();
        let mut right = Row::zeros();
        for (window, weight) in windows.iter().zip(&weights) {
            let row = rows(window).component_div(&scale);
            normal += row * row.transpose() * *weight;
            right += row * (window.force * weight);
        }
        let inverse = normal.cholesky()?.inverse();
        let solution = inverse * right;
        let off = |w: &Window| w.force - rows(w).component_div(&scale).dot(&solution);
        let residuals: Vec<f64> = windows.iter().map(off).collect();
        let mut sizes: Vec<f64> = residuals.iter().map(|r| r.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        // The median of normal residuals is 0.6745 of their deviation.
        let deviation = (sizes[count / 2] / 0.6745).max(f64::MIN_POSITIVE);
        weights = residuals
            .iter()
            .map(|r| (OUTLYING * deviation / r.abs()).min(1.0))
            .collect();
        let squares: f64 = residuals.iter().zip(&weights).map(|(r, w)| w * r * r).sum();
        let variance = squares / (count - 4) as f64 * correlation_time(&residuals);
        let error = (inverse[(0, 0)] * variance).sqrt();
        found = Some([solution[0] / scale[0], error / scale[0]]);
    }
    found.filter(|[value, error]| *value > 0.0 && error.is_finite())
}

/// Windows of like speed as one run; its standard error is that of their scatter.
fn run(bin: &[&Window], inertia: f64, lever: f64) -> SpeedRun {
    let count = bin.len() as f64;
    let friction: Vec<f64> = bin
        .iter()
        .map(|w| lever * (w.force - inertia * w.acceleration))
        .collect();
    let torque = friction.iter().sum::<f64>() / count;
    let rest: Vec<f64> = friction.iter().map(|f| f - torque).collect();
    let squares: f64 = rest.iter().map(|r| r * r).sum();
    let error = (squares / (count * (count - 1.0)) * correlation_time(&rest)).sqrt();
    let speed = bin.iter().map(|w| w.speed).sum::<f64>() / count / lever;
    SpeedRun {
        log: bin[0].log,
        time: [bin[0].time[0], bin[bin.len() - 1].time[1]],
        run: ConstantSpeedRun {
            speed,
            speed_standard_error: None,
            torque,
            torque_standard_error: (error > 0.0).then_some(error),
            vibration: 0.0,
            vibration_frequency: 0.0,
        },
        steady: false,
        // In the window before it slid already.
        distance: f64::INFINITY,
        left_out: None,
    }
}

/// How many neighbours say the same: 1 + 2 Σ ρ_k up to the first lag beyond five times that,
/// 1 at least (A. Sokal's window).
pub(super) fn correlation_time(residuals: &[f64]) -> f64 {
    let n = residuals.len();
    let power: f64 = residuals.iter().map(|r| r * r).sum();
    if power <= 0.0 {
        return 1.0;
    }
    let mut time = 1.0;
    for lag in 1..n / 2 {
        if lag as f64 > 5.0 * f64::max(time, 1.0) {
            break;
        }
        let pairs = residuals.iter().zip(&residuals[lag..]);
        time += 2.0 * pairs.map(|(a, b)| a * b).sum::<f64>() / power;
    }
    f64::max(time, 1.0)
}
