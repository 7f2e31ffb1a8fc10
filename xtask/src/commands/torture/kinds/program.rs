//! Motion programs, damaged and made anew.

use std::path::Path;

use trajectories::Motion;

use super::{Input, Kind, Verdict, fault, refused};
use crate::commands::torture::random::Source;
use crate::commands::torture::{grammar, mutate};
use feed_axis::commands::motions;

const BASE: &str = "start_mm = 600
[[steps]]
dwell = { duration_s = 0.25 }
[[steps]]
move = { to_mm = 800, velocity_mm_s = 100, acceleration_mm_s2 = 225, jerk_mm_s3 = 1200 }
[[steps]]
move_by = { by_mm = -20, velocity_mm_s = 100, acceleration_mm_s2 = 225, jerk_mm_s3 = 1200 }
[[steps]]
sine = { amplitude_mm = 1.0, frequency_hz = 5.0, cycles = 2 }
[[steps]]
chirp = { amplitude_mm = 0.1, from_frequency_hz = 1, to_frequency_hz = 50, duration_s = 2, ramp_s = 0.2, sweep = \"logarithmic\" }
";

struct ProgramFile {
    generated: bool,
}

/// Programs damaged and made anew.
pub fn kinds() -> Vec<Box<dyn Kind>> {
    let kind = |generated| -> Box<dyn Kind> { Box::new(ProgramFile { generated }) };
    vec![kind(false), kind(true)]
}

impl Kind for ProgramFile {
    fn name(&self) -> &'static str {
        if self.generated {
            "motion program, made anew"
        } else {
            "motion program, damaged"
        }
    }

    fn share(&self) -> usize {
        4
    }

    fn input(&self, random: &mut Source) -> Input {
        let bytes = if self.generated {
            grammar::program(random).into_bytes()
        } else {
            mutate::text(BASE, random)
        };
        Input {
            file: "program.toml".to_owned(),
            bytes,
            damaged: false,
        }
    }

    fn judge(&self, input: &Input, desk: &Path) -> Verdict {
        let program = match motions::program(&desk.join(&input.file)) {
            Ok(program) => program,
            Err(e) => return refused(e, input, std::str::from_utf8(&input.bytes).is_ok()),
        };
        let duration = program.duration();
        if !(duration.is_finite() && duration >= 0.0) {
            return fault(format!("accepted, with a duration of {duration} s"));
        }
        let ends = [
            -1.0,
            0.0,
            duration,
            2.0 * duration + 1.0,
            f64::INFINITY,
            f64::NAN,
        ];
        let inside = (1..8).map(|k| duration * f64::from(k) / 8.0);
        for t in ends.into_iter().chain(inside) {
            let s = program.at(t);
            if !(s.position + s.velocity + s.acceleration + s.jerk).is_finite() {
                return fault(format!("accepted, and at {t} s a setpoint is not a number"));
            }
        }
        // What a drive is sent must meet at the end of the motion.
        let (last, end) = (program.at(duration), program.end());
        if last.position != end || last.velocity != 0.0 {
            return fault(format!(
                "ends at {} m at {} m/s, not at rest at {end} m",
                last.position, last.velocity
            ));
        }
        Verdict::Accepted
    }
}
