//! Tables of measured errors, for `discover --summary`.

use std::path::Path;

use axis_sim::Axis;
use miette::Result;

use super::axis::small_screw;
use super::{Input, Kind, Verdict, fault, refused};
use crate::commands::torture::mutate;
use crate::commands::torture::random::Source;
use feed_axis::commands::discover;

const BASE: &str = "trajectory,experiment_max_um,experiment_mean_um,note
1,55.89,6.56,a
2,59.20,6.68,b
3,52.22,5.01,\"c, d\"
4,52.22,5.36,
5,52.2,6.343,e
6,52.2,7.01,f
";

struct ErrorTable {
    axis: Axis,
}

/// The table of the paper's experiment.
pub fn kind() -> Result<Box<dyn Kind>> {
    let axis = Axis::parse("base", &small_screw())?;
    Ok(Box::new(ErrorTable { axis }))
}

impl Kind for ErrorTable {
    fn name(&self) -> &'static str {
        "table of errors"
    }

    fn share(&self) -> usize {
        4
    }

    fn input(&self, random: &mut Source) -> Input {
        Input {
            file: "table.csv".to_owned(),
            bytes: mutate::text(BASE, random),
            damaged: false,
        }
    }

    fn judge(&self, input: &Input, desk: &Path) -> Verdict {
        let rows = match discover::read_summary(&desk.join(&input.file), &self.axis) {
            Ok(rows) => rows,
            Err(e) => return refused(e, input, std::str::from_utf8(&input.bytes).is_ok()),
        };
        let sound = |row: &discrepancy::summary::MeasuredError| {
            (1..=self.axis.trajectories.len()).contains(&row.trajectory)
                && row.max.is_finite()
                && row.max > 0.0
                && row.mean.is_finite()
                && row.mean > 0.0
        };
        if rows.is_empty() || !rows.iter().all(sound) {
            return fault("rows are accepted that are no errors of a trajectory");
        }
        Verdict::Accepted
    }
}
