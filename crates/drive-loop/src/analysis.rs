//! Analysis of an axis' loops: margins over a set of corners, and curves of the axis as it is.

use axis_sim::Axis;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::LoopError;
use crate::law::{LoopAt, LoopGains};
use crate::loops::{CornerLoop, hertz};
use crate::margins::CornerMargins;
use crate::plant::Number;
use crate::set::{AxisLoops, LoopSet};

/// The loops of an axis, analysed: what `analyse` writes.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct LoopAnalysis {
    /// Of this form.
    pub schema: u32,
    /// Name of the axis.
    pub axis: String,
    /// Its fingerprint.
    pub axis_fingerprint: String,
    /// Version of the program.
    pub version: String,
    /// Unit of the load's position: "m" or "rad".
    pub position_unit: String,
    /// Unit of what moves it: "N" or "N·m".
    pub force_unit: String,
    /// Control period, s.
    pub period_s: f64,
    /// Cycles of delay that were added to the file's.
    pub added_delay_cycles: f64,
    /// Frequencies of the natural modes at the first position, Hz, the rigid motion left out, up to
    /// half the sampling rate.
    pub modes_hz: Vec<f64>,
    /// Maximum sensitivities of all corners.
    pub worst: WorstMargins,
    /// All corners; the axis as its file says first, sliding, then stuck.
    pub corners: Vec<CornerMargins>,
    /// Curves of the first two.
    pub curves: Vec<LoopCurves>,
    /// What the linear model does not see, and what is missing for a figure, in words.
    pub notes: Vec<String>,
}

/// The worst over all corners, each with the number of its corner from 0; none where a corner is not
/// stable.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct WorstMargins {
    /// Maximum sensitivity at either cut.
    pub sensitivity: Option<f64>,
    /// Its corner.
    pub sensitivity_corner: usize,
    /// The same with one more cycle of delay.
    pub sensitivity_late: Option<f64>,
    /// Its corner.
    pub sensitivity_late_corner: usize,
    /// Corners that are not stable.
    pub unstable: usize,
}

/// Responses over the frequency, as pairs of real and imaginary part.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct LoopCurves {
    /// Whether the load sticks in them.
    pub stuck: bool,
    /// Hz.
    pub frequency_hz: Vec<f64>,
    /// Open loop, cut at the command.
    pub open_command: Vec<[f64; 2]>,
    /// Open position loop, its speed loop closed.
    pub open_position: Vec<[f64; 2]>,
    /// Motor's speed per set point of the speed controller; empty of a PID controller, which has none.
    pub speed_followed: Vec<[f64; 2]>,
    /// The load's motion per force on it, m/N or rad/(N·m).
    pub compliance: Vec<[f64; 2]>,
}

impl LoopCurves {
    fn of(corner: &CornerLoop, gains: &LoopGains, is_pid: bool) -> Self {
        let each = |of: &dyn Fn(&LoopAt) -> Number| {
            let all = corner.points.iter().map(of);
            all.map(|value| [value.re, value.im]).collect()
        };
        Self {
            stuck: corner.at.stuck,
            frequency_hz: corner.points.iter().map(|p| hertz(p.frequency)).collect(),
            open_command: each(&|p| p.cut(gains, false)[0]),
            open_position: each(&|p| p.cut(gains, false)[1]),
            speed_followed: match is_pid {
                true => Vec::new(),
                false => each(&|p| p.speed_followed(gains)),
            },
            compliance: each(&|p| p.compliance(gains)),
        }
    }
}

impl LoopAnalysis {
    /// Number of this form.
    pub const SCHEMA: u32 = 1;

    /// Of an axis, over a set.
    ///
    /// # Errors
    /// [`LoopError`] where the axis has no such loops, or the set is not valid.
    pub fn of(axis: &Axis, set: &LoopSet) -> Result<Self, LoopError> {
        let loops = AxisLoops::new(axis, set)?;
        let gains = loops.gains();
        let corners: Vec<CornerMargins> = loops
            .corners
            .par_iter()
            .map(|corner| corner.margins(&loops.model, &gains))
            .collect();
        let freedom = axis.freedom();
        let top = 0.5 / axis.period;
        Ok(Self {
            schema: Self::SCHEMA,
            axis: axis.name.clone(),
            axis_fingerprint: axis.fingerprint.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            position_unit: freedom.unit().to_owned(),
            force_unit: freedom.force()[1].to_owned(),
            period_s: axis.period,
            added_delay_cycles: set.delay,
            modes_hz: loops
                .modes
                .iter()
                .map(|w| hertz(*w))
                .filter(|f| *f < top)
                .collect(),
            worst: worst(&corners),
            curves: loops.corners[..2.min(loops.corners.len())]
                .iter()
                .map(|corner| LoopCurves::of(corner, &gains, loops.model.is_pid))
                .collect(),
            corners,
            notes: notes(axis, &loops),
        })
    }

    /// The corner of the axis as its file says, the load sliding.
    pub fn own(&self) -> &CornerMargins {
        &self.corners[0]
    }
}

fn worst(corners: &[CornerMargins]) -> WorstMargins {
    let greatest = |of: &dyn Fn(&CornerMargins) -> [Option<f64>; 2]| {
        let mut at = (0, Some(0.0));
        for (i, corner) in corners.iter().enumerate() {
            let [a, b] = of(corner).map(|s| s.unwrap_or(f64::INFINITY));
            let most = a.max(b);
            if most > at.1.unwrap_or(f64::INFINITY) || i == 0 {
                at = (i, most.is_finite().then_some(most));
            }
        }
        at
    };
    let now = greatest(&|c| [c.command.sensitivity, c.position.sensitivity]);
    let late = greatest(&|c| [c.command.sensitivity_late, c.position.sensitivity_late]);
    WorstMargins {
        sensitivity: now.1,
        sensitivity_corner: now.0,
        sensitivity_late: late.1,
        sensitivity_late_corner: late.0,
        unstable: corners.iter().filter(|corner| !corner.stable).count(),
    }
}

/// What the linear loop does not see.
fn notes(axis: &Axis, loops: &AxisLoops) -> Vec<String> {
    let mut all = Vec::new();
    if loops.model.is_pid {
        all.push(
            "the control is a PID controller of the position: there is one loop, and both cuts are that loop"
                .to_owned(),
        );
    }
    if axis.mechanism.backlash() > 0.0 {
        all.push(
            "the free travel of the transmission (backlash) is left out: the loop is that of closed flanks"
                .to_owned(),
        );
    }
    if !axis.effects.is_empty() {
        all.push(
            "of the file's effects those count that change a parameter of a part or the friction; bodies that swing, waves and errors of sensors are left out"
                .to_owned(),
        );
    }
    let signal_path = loops.model.signal_path();
    if signal_path.speed_every > 1 || signal_path.position_every > 1 {
        all.push(
            "a loop that is slower than the control enters the margins with its mean delay; stability is checked at the loops' own rates"
                .to_owned(),
        );
    }
    all
}
