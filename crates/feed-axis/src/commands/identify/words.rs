//! What was identified, as people read it.

use std::fmt;
use std::path::PathBuf;

use axis_sim::SixDigits;
use axis_sim::friction::FrictionUnits;
use serde::Serialize;

use super::Transfer;
use super::friction::{Found, Friction};

/// What was identified.
#[derive(Serialize)]
pub(super) struct Identified<'a> {
    #[serde(skip)]
    pub units: FrictionUnits,
    pub friction: &'a Friction,
    /// Without and with friction feed-forward.
    pub transfer_functions: &'a [Transfer],
    /// What the axis file lacks for them.
    #[serde(skip)]
    pub lacks: Option<&'static str>,
    /// The axis file with this friction.
    pub axis_file: PathBuf,
}

impl fmt::Display for Identified<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let friction = self.friction;
        let used = friction.runs.iter().filter(|run| run.left_out.is_none());
        let constant = used.clone().filter(|run| run.constant_speed).count();
        let varying = used.count() - constant;
        let left_out = friction.runs.len() - constant - varying;
        let small = friction.small_motions.iter();
        let small = small.filter(|motion| motion.left_out.is_none()).count();
        write!(
            f,
            "identify: friction at {} from {constant} stretches of constant speed",
            self.units.at
        )?;
        if varying > 0 {
            write!(f, ", {varying} speeds at which it changes slowly")?;
        }
        write!(f, " and {small} small motion(s) about a standstill")?;
        if left_out > 0 {
            write!(
                f,
                "; {left_out} stretches left out for vibration, standstill or bristles that still bend"
            )?;
        }
        let simulated = if friction.simulated {
            " (simulated)"
        } else {
            ""
        };
        writeln!(f, "{simulated}")?;
        for parameter in &friction.parameters {
            writeln!(f, "  {}", line(parameter))?;
        }
        for open in friction.open.iter().chain(&friction.notes) {
            writeln!(f, "  {open}")?;
        }
        match (self.transfer_functions, self.lacks) {
            ([alone, beside], _) => writeln!(
                f,
                "  transfer functions of order {} and {}",
                alone.poles.len(),
                beside.poles.len()
            )?,
            (_, Some(lacks)) => writeln!(f, "  no transfer functions: the axis has no {lacks}")?,
            _ => {}
        }
        write!(
            f,
            "  axis file with this friction: {}",
            self.axis_file.display()
        )
    }
}

fn line(found: &Found) -> String {
    let value = format!("{} = {} {}", found.name, SixDigits(found.value), found.unit);
    match found.interval_95 {
        Some([low, high]) => format!("{value}   95 %: {} to {}", SixDigits(low), SixDigits(high)),
        None => format!("{value}   ({})", found.source),
    }
}
