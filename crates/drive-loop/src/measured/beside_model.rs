//! Measured lines beside the model at their place.

use frequency_response::{FrequencyResponse, LoopLine, ResponseLine};

use super::model_at::ModelAt;
use crate::law::LoopAt;
use crate::measured_plant::{MeasuredPlant, PlantLine};
use crate::plant::PlantAt;

/// Deviation of a line, as a share of it, from which on it does not count: few averages make a coherence
/// that is high by chance.
const CERTAIN: f64 = 0.2;

/// Lines that follow one, half of which must count for it to be within the band.
const FOLLOWING: usize = 16;

/// The lines from the first to the last around which most lines count: single ones beyond do so by
/// chance.
fn band(lines: &[ResponseLine], counts: impl Fn(&ResponseLine) -> bool) -> &[ResponseLine] {
    let good = |part: &[ResponseLine]| 2 * part.iter().filter(|l| counts(l)).count() > part.len();
    let mut parts = lines.windows(FOLLOWING.min(lines.len()).max(1));
    let Some(from) = parts.position(&good) else {
        return &[];
    };
    let rest = &lines[from..];
    let size = FOLLOWING.min(rest.len());
    let end = rest.windows(size).position(|part| !good(part));
    // Where half of a part do not count, its first half is the end of the band.
    &rest[..end.map_or(rest.len(), |end| end + size / 2)]
}

impl MeasuredPlant {
    /// Of the responses of angle, speed and load. A line counts where the motor's has that coherence
    /// (where there is none, the load's); the others follow the model on lines where theirs has not.
    pub(crate) fn new(
        at: &ModelAt,
        responses: [Option<&FrequencyResponse>; 3],
        coherence: f64,
    ) -> Self {
        // Where the speed that counts is derived from the load's position, the motor's says nothing.
        let [angle, speed, load] = responses;
        let responses = match at.model.is_pid && at.model.sensing.motor_from_load {
            true => [None, None, load],
            false => [angle, speed, load],
        };
        let main = if responses[1].is_some() {
            1
        } else if responses[0].is_some() {
            0
        } else {
            2
        };
        let line_of = |which: usize, frequency_hz: f64| -> Option<&ResponseLine> {
            let lines = &responses[which]?.lines;
            let place = lines.partition_point(|l| l.frequency_hz < 0.999_999 * frequency_hz);
            let near = |l: &&ResponseLine| (l.frequency_hz / frequency_hz - 1.0).abs() < 1e-6;
            lines.get(place).filter(near)
        };
        let counts = |line: &&ResponseLine| {
            line.coherence >= coherence && line.deviation < CERTAIN * line.value.norm()
        };
        let own = responses[main].map_or(&[][..], |response| &response.lines);
        let mut lines = Vec::new();
        for line in band(own, |line| counts(&line)).iter().filter(counts) {
            let Some(model) = at.shown(line.frequency_hz) else {
                continue;
            };
            let ratio = line.value / model[main];
            let mut command = model.map(|value| value * ratio);
            let mut deviation =
                command.map(|value| value.norm() * line.deviation / line.value.norm());
            for which in 0..3 {
                let own = line_of(which, line.frequency_hz);
                if let Some(own) = own.filter(|own| own.coherence >= coherence) {
                    command[which] = own.value;
                    deviation[which] = own.deviation;
                }
            }
            let is_finite = command.iter().all(|c| c.re.is_finite() && c.im.is_finite());
            if is_finite {
                lines.push(PlantLine {
                    frequency_hz: line.frequency_hz,
                    command,
                    deviation,
                });
            }
        }
        Self {
            position: at.corner.at.position,
            lines,
        }
    }

    /// The motor's speed where the log has none: from the response of the motor's angle (0) or the load's
    /// position (2), in the manner in which the drive derives it.
    pub(crate) fn speed_of(
        at: &ModelAt,
        response: &FrequencyResponse,
        which: usize,
    ) -> FrequencyResponse {
        let mut speed = response.clone();
        for line in &mut speed.lines {
            let Some(model) = at.shown(line.frequency_hz) else {
                continue;
            };
            let by = model[1] / model[which];
            line.value *= by;
            line.deviation *= by.norm();
        }
        speed
    }

    /// The loop of a controller on these lines, cut at the command and at the position.
    pub(crate) fn loops(&self, at: &ModelAt) -> [Vec<LoopLine>; 2] {
        [0, 1].map(|place| {
            let line = |line: &PlantLine| loop_line(line, place, at);
            self.lines.iter().filter_map(line).collect()
        })
    }
}

fn loop_line(line: &PlantLine, place: usize, at: &ModelAt) -> Option<LoopLine> {
    let plant = at.plant(line.frequency_hz)?;
    let cut = |command| {
        let measured = PlantAt { command, ..plant };
        LoopAt::of_measured(&at.model, &measured, &plant).cut(&at.gains, false)[place]
    };
    let value = cut(line.command);
    // The loop cut at the command is linear in the responses; the other one nearly so where errors
    // are small. Errors of different sensors count as independent.
    let mut square = 0.0;
    for (which, deviation) in line.deviation.iter().enumerate() {
        let mut moved = line.command;
        moved[which] += *deviation;
        square += (cut(moved) - value).norm_sqr();
    }
    Some(LoopLine {
        frequency_hz: line.frequency_hz,
        value,
        deviation: square.sqrt(),
    })
}
