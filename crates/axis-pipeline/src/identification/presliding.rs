//! Small motions about a standstill: where the bristles bend and do not slide.

use std::ops::Range;

use axis_sim::balance::FrictionCourse;
use lugre::identify::{
    MeasuredMotion, PreslidingFit, PreslidingRecord, StaticFit, identify_presliding,
};

use super::found::SmallMotion;
use super::steady::Record;

/// Share of the Coulomb level below which a contact does not slide: sliding friction is at
/// least that level.
const BELOW: f64 = 0.9;

/// Way between two stretches below that level, in lengths of the way that the load goes below it, up to
/// which they are parts of one small motion. The bristles are then bent anew ten times over at most,
/// and slide no further than the law is simulated along with ease.
const JOINED: f64 = 10.0;

/// Most of the Coulomb level that inertia may take: of what it takes, a part is unknown.
const MOST_INERTIA: f64 = 0.5;

/// Noise of the inertia's force that is let through, as a share of the Coulomb level.
const QUIET: f64 = 0.02;

/// Least change of friction, as a share of the Coulomb level, and least way, in deviations of the
/// position's noise, of a motion that tells a stiffness. Twelve deviations are three and a half
/// steps of an encoder (a step is √12 of them).
const LEAST_FRICTION: f64 = 0.2;
const LEAST_WAY: f64 = 12.0;

/// Shortest of these motions, s, and fewest samples of a fit. Three swings of 2 Hz take longer; the ringing of
/// a machine that stops, in which its own modes take part, is shorter.
const SHORTEST: f64 = 0.5;
const FEWEST: usize = 32;

/// Samples of a fit per period of the cut-off. A motion of a quarter of the cut-off is taken as straight
/// between them, which is (2π/4/40)²/12 = 0.01 % of its way.
const RATE: f64 = 40.0;

/// Least share of the whole way for a swing to count, and fewest swings: to, fro, and to again. One way
/// alone is a start or a stop, which inertia and the curve's own errors weigh on more than bristles.
const SWING: f64 = 0.2;
const SWINGS: usize = 3;

/// Small motions of a record, each with what it tells.
pub(super) fn small_motions(record: &Record<'_>, statics: &StaticFit) -> Vec<SmallMotion> {
    let lever = record.axis.friction.lever(record.axis.travel_per_radian());
    let coulomb = statics.coulomb.value / lever;
    let offset = statics.torque_offset.value / lever;
    let whole = 0..record.position.len();
    // To find them, smoother than to fit them: a quarter of the highest cut-off.
    let coarse = 0.025 / record.shown.period();
    let cutoff = coarse.min(
        record
            .shown
            .quiet_cutoff(record.axis, whole, QUIET * coulomb),
    );
    let course = record.shown.friction(record.axis, cutoff);
    let level = Level {
        coulomb,
        offset,
        course: &course,
    };
    let found = level.motions(record);
    let fitted = found.into_iter().map(|samples| SmallMotion {
        log: record.log,
        time: record.time(&samples),
        fit: fit(record, &samples, statics, coulomb),
    });
    fitted.collect()
}

/// Friction against the level at which it slides.
struct Level<'a> {
    coulomb: f64,
    offset: f64,
    course: &'a FrictionCourse,
}

impl Level<'_> {
    fn motions(&self, record: &Record<'_>) -> Vec<Range<usize>> {
        let mut joined = self.joined(self.below());
        let period = record.shown.period();
        let shortest = ((SHORTEST / period).ceil() as usize).max(FEWEST);
        let least_way = LEAST_WAY * record.shown.speed_uncertainty(1.0) / std::f64::consts::SQRT_2;
        let tells = |samples: &Range<usize>| {
            let [way, change] = [&self.course.position, &self.course.force].map(|series| {
                let part = &series[samples.clone()];
                let ends = [f64::INFINITY, f64::NEG_INFINITY];
                let [low, high] = part
                    .iter()
                    .fold(ends, |[a, b], v| [f64::min(a, *v), f64::max(b, *v)]);
                high - low
            });
            let mut holes = record.shown.holes().iter();
            let whole = holes.all(|hole| hole.end <= samples.start || hole.start >= samples.end);
            let least = least_way.max(SWING * way);
            samples.len() >= shortest
                && swings(&self.course.position[samples.clone()], least) >= SWINGS
                && way > least_way
                && change > LEAST_FRICTION * self.coulomb
                && whole
        };
        joined.retain(tells);
        joined
    }

    /// Stretches in which friction stays below the level and inertia takes little.
    fn below(&self) -> Vec<Range<usize>> {
        let is_below = |k: usize| {
            (self.course.force[k] - self.offset).abs() < BELOW * self.coulomb
                && self.course.inertia[k].abs() < MOST_INERTIA * self.coulomb
        };
        let mut found = Vec::new();
        let mut begun = None;
        for k in 0..self.course.force.len() {
            match (is_below(k), begun) {
                (true, None) => begun = Some(k),
                (false, Some(start)) => {
                    found.push(start..k);
                    begun = None;
                }
                _ => {}
            }
        }
        found.extend(begun.map(|start| start..self.course.force.len()));
        found
    }

    /// Neighbouring stretches between which the load goes only a few times as far as in them,
    /// as one.
    fn joined(&self, stretches: Vec<Range<usize>>) -> Vec<Range<usize>> {
        let way = |from: usize, to: usize| {
            let part = &self.course.position[from..to];
            let steps = part.windows(2).map(|w| (w[1] - w[0]).abs());
            steps.sum::<f64>()
        };
        let quiet = |from: usize, to: usize| {
            let mut inertia = self.course.inertia[from..to].iter();
            inertia.all(|i| i.abs() < MOST_INERTIA * self.coulomb)
        };
        let mut found: Vec<Range<usize>> = Vec::new();
        for stretch in stretches {
            if let Some(last) = found.last_mut() {
                let inside = |s: &Range<usize>| way(s.start, s.end);
                let most = JOINED * inside(last).min(inside(&stretch));
                if quiet(last.end, stretch.start) && way(last.end, stretch.start) <= most {
                    last.end = stretch.end;
                    continue;
                }
            }
            found.push(stretch);
        }
        found
    }
}

/// How often a motion goes farther than `least` one way before it turns.
fn swings(position: &[f64], least: f64) -> usize {
    let Some(&first) = position.first() else {
        return 0;
    };
    // The ends of the way since the last turn, and which of them was reached last.
    let (mut low, mut high) = (first, first);
    let (mut upward, mut count) = (None, 0);
    for &x in position {
        (low, high) = (low.min(x), high.max(x));
        let turned = match upward {
            None if x - low > least => Some(true),
            None if high - x > least => Some(false),
            Some(true) if high - x > least => Some(false),
            Some(false) if x - low > least => Some(true),
            _ => None,
        };
        if turned.is_some() {
            (upward, low, high) = (turned, x, x);
            count += 1;
        }
    }
    count
}

/// The bristles of one small motion.
fn fit(
    record: &Record<'_>,
    samples: &Range<usize>,
    statics: &StaticFit,
    coulomb: f64,
) -> Result<PreslidingFit, String> {
    let lever = record.axis.friction.lever(record.axis.travel_per_radian());
    let period = record.shown.period();
    let cutoff = record
        .shown
        .quiet_cutoff(record.axis, samples.clone(), QUIET * coulomb);
    let course = record.shown.friction(record.axis, cutoff);
    let every = ((1.0 / (RATE * cutoff * period)).floor() as usize)
        .min(samples.len() / FEWEST)
        .max(1);
    let pick = |series: &[f64], by: f64| -> Vec<f64> {
        let inside = samples.clone().step_by(every);
        inside.map(|k| by * series[k]).collect()
    };
    let speed = pick(&course.speed, 1.0 / lever);
    let friction = pick(&course.force, lever);
    let motion = PreslidingRecord {
        time_step: every as f64 * period,
        motion: MeasuredMotion::Speed(&speed),
        torque: &friction,
    };
    identify_presliding(statics, &motion).map_err(|why| why.to_string())
}
