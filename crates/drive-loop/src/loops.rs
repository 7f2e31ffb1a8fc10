//! The loop over a grid of frequencies, in one corner.

use std::f64::consts::{PI, TAU};

use compensator::{Mode, SampledDrive};

use crate::law::{LoopAt, LoopGains};
use crate::measured_plant::MeasuredPlant;
use crate::plant::{Corner, LoopModel, Number, PlantAt, PlantResponse};

/// Lowest frequency, of half the sampling rate: where a double integrator is still far above the
/// rounding of the drive's matrices.
const LOWEST: f64 = 1e-5;
/// Frequencies of the even grid.
const EVEN: usize = 200;
/// Greatest change of phase (rad) and of the logarithm of the magnitude from one frequency to the next; a gap
/// with more is halved, up to so many times.
const PHASE: f64 = 0.15;
const SIZE: f64 = 0.3;
const HALVINGS: u32 = 9;
/// Share of the motor's speed that the load must have for its response to count in that.
const SEEN: f64 = 1e-3;

/// The loop of an axis in one corner.
pub(crate) struct CornerLoop {
    pub at: Corner,
    pub points: Vec<LoopAt>,
    pub drive: SampledDrive,
    response: PlantResponse,
    /// What was measured there, in the model's place within its band.
    measured: Option<MeasuredPlant>,
    /// Integrators of the loop cut at the command at low frequency.
    pub integrators: u32,
}

/// Maximum sensitivities of one corner, infinite where the loop is not stable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sensitivities {
    /// At the command and at the position.
    pub now: [f64; 2],
    /// With one more cycle of delay.
    pub late: [f64; 2],
}

impl CornerLoop {
    pub fn new(model: &LoopModel, modes: &[Mode], at: &Corner) -> Self {
        let drive = model.drive(modes, at);
        let response = PlantResponse::new(&drive, &model.model);
        let top = PI / (model.period() * f64::from(model.signal_path().speed_every.max(1)));
        let points = grid(&response, top)
            .iter()
            .map(|plant| LoopAt::new(model, plant))
            .collect();
        Self {
            at: *at,
            points,
            drive,
            response,
            measured: None,
            integrators: u32::from(model.integrates()) + u32::from(!at.stuck),
        }
    }

    /// The same with a measured response in the model's place: on its own lines within its band. Its
    /// answer to forces is the model's.
    pub fn measured(model: &LoopModel, modes: &[Mode], measured: &MeasuredPlant) -> Self {
        let at = Corner {
            position: measured.position,
            mass: 1.0,
            friction: 1.0,
            stuck: false,
        };
        let mut corner = Self::new(model, modes, &at);
        let Some([low, high]) = measured.band_hz() else {
            return corner;
        };
        corner.measured = Some(measured.clone());
        corner
            .points
            .retain(|p| !(low..=high).contains(&hertz(p.frequency)));
        let lines = measured.lines.iter();
        let own: Vec<LoopAt> = lines
            .filter_map(|line| corner.at(model, TAU * line.frequency_hz))
            .collect();
        corner.points.extend(own);
        corner
            .points
            .sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
        corner
    }

    /// Whether a measured response stands in the model's place.
    pub fn is_measured(&self) -> bool {
        self.measured.is_some()
    }

    /// The model's drive at an angular frequency.
    pub fn plant(&self, frequency: f64) -> Option<PlantAt> {
        self.response.at(frequency)
    }

    /// The loop at an angular frequency that is not on the grid.
    pub fn at(&self, model: &LoopModel, frequency: f64) -> Option<LoopAt> {
        let plant = self.response.at(frequency)?;
        let measured = self.measured.as_ref().and_then(|m| m.at(frequency));
        Some(match measured {
            Some(command) => {
                let measured = PlantAt { command, ..plant };
                LoopAt::of_measured(model, &measured, &plant)
            }
            None => LoopAt::new(model, &plant),
        })
    }

    /// Peaks of the sensitivities on the grid.
    pub fn sensitivities(&self, gains: &LoopGains) -> Sensitivities {
        let [now, late] = [false, true].map(|is_late| {
            let mut least = [f64::INFINITY; 2];
            let mut turned = Turning::default();
            for point in self.points.iter().rev() {
                let [l, l_p] = point.cut(gains, is_late);
                let one = l + 1.0;
                turned.to(one);
                least[0] = least[0].min(one.norm_sqr());
                least[1] = least[1].min((l_p + 1.0).norm_sqr());
            }
            match turned.is_stable(self.integrators) {
                true => least.map(|square| 1.0 / square.sqrt()),
                false => [f64::INFINITY; 2],
            }
        });
        Sensitivities { now, late }
    }
}

/// The phase of 1 + L from half the sampling rate down.
#[derive(Default)]
struct Turning {
    before: Option<Number>,
    phase: f64,
}

impl Turning {
    fn to(&mut self, one: Number) {
        self.phase += match self.before {
            Some(before) => (one * before.conj()).arg(),
            // Real at half the sampling rate: 0, or π where L is beyond −1.
            None => one.arg(),
        };
        self.before = Some(one);
    }

    /// Nyquist's criterion: a pair of unstable poles turns it by 2π more than the integrators do.
    fn is_stable(&self, integrators: u32) -> bool {
        (self.phase + 0.5 * PI * f64::from(integrators)).abs() < PI
    }
}

/// Frequencies up to half the rate of the speed controller, at which the drive is known well enough to go by straight lines between.
fn grid(response: &PlantResponse, top: f64) -> Vec<PlantAt> {
    let even = (0..=EVEN).map(|i| top * LOWEST.powf(1.0 - i as f64 / EVEN as f64));
    let even: Vec<PlantAt> = even.filter_map(|w| response.at(w)).collect();
    let mut all = Vec::with_capacity(2 * even.len());
    for pair in even.windows(2) {
        all.push(pair[0]);
        halve(response, &pair[0], &pair[1], HALVINGS, &mut all);
    }
    all.extend(even.last());
    all
}

fn halve(
    response: &PlantResponse,
    low: &PlantAt,
    high: &PlantAt,
    depth: u32,
    all: &mut Vec<PlantAt>,
) {
    let far = |place: usize| {
        let ratio = high.command[place] / low.command[place];
        ratio.arg().abs() > PHASE || ratio.norm().ln().abs() > SIZE
    };
    // Far above its resonances the load moves so little that only rounding shows.
    let moves = |at: &PlantAt| {
        let [_, motor, load] = at.command.map(|response| response.norm());
        load * at.frequency > SEEN * response.travel() * motor
    };
    let is_far = far(1) || (moves(low) || moves(high)) && far(2);
    if depth == 0 || !is_far {
        return;
    }
    let Some(middle) = response.at((low.frequency * high.frequency).sqrt()) else {
        return;
    };
    halve(response, low, &middle, depth - 1, all);
    all.push(middle);
    halve(response, &middle, high, depth - 1, all);
}

/// Hz.
pub(crate) fn hertz(frequency: f64) -> f64 {
    frequency / TAU
}
