//! The best linear map from a cycle's inputs to its increment: the figure
//! that a network has to beat.

use axis_sim::CycleInput;
use nalgebra::{DMatrix, DVector};

use crate::sampling::SampleSet;
use crate::{Figures, PipelineError};

/// `increment = offset + slopes · [S, v, a, I_qr]`, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearMap {
    /// Constant part, m.
    pub offset: f64,
    /// Slopes over position, speed, acceleration and current command.
    pub slopes: [f64; 4],
}

impl LinearMap {
    /// Least squares over a sample set, by QR of the scaled inputs.
    ///
    /// # Errors
    /// [`PipelineError::TooFewSamples`] below five samples, or where an input
    /// does not vary.
    pub fn fit(samples: &SampleSet) -> Result<Self, PipelineError> {
        let rows: Vec<[f64; 4]> = samples.inputs.iter().map(input_row).collect();
        // Each column scaled by its largest value, so that QR sees like sizes.
        let scale: [f64; 4] = std::array::from_fn(|i| {
            rows.iter()
                .fold(f64::MIN_POSITIVE, |most, row| most.max(row[i].abs()))
        });
        let matrix = DMatrix::from_fn(rows.len(), 5, |row, column| match column {
            0 => 1.0,
            _ => rows[row][column - 1] / scale[column - 1],
        });
        let few = || PipelineError::TooFewSamples {
            found: rows.len(),
            needed: 5,
        };
        if rows.len() < 5 {
            return Err(few());
        }
        let qr = matrix.qr();
        let mut right = DVector::from_column_slice(&samples.increments);
        qr.q_tr_mul(&mut right);
        let solution = qr
            .r()
            .solve_upper_triangular(&right.rows(0, 5).into_owned())
            .ok_or_else(few)?;
        Ok(Self {
            offset: solution[0],
            slopes: std::array::from_fn(|i| solution[i + 1] / scale[i]),
        })
    }

    /// The predicted increment, m.
    pub fn increment(&self, input: &CycleInput) -> f64 {
        let row = input_row(input);
        let terms = row.iter().zip(self.slopes).map(|(x, slope)| x * slope);
        self.offset + terms.sum::<f64>()
    }

    /// What the map leaves of each increment, m.
    pub fn residuals(&self, samples: &SampleSet) -> Vec<f64> {
        let rows = samples.inputs.iter().zip(&samples.increments);
        rows.map(|(x, y)| y - self.increment(x)).collect()
    }

    /// Maximum and mean of the absolute residuals, in µm or µrad.
    ///
    /// # Errors
    /// [`PipelineError`] for an empty set.
    pub fn errors(&self, samples: &SampleSet) -> Result<Figures, PipelineError> {
        Figures::of_si(&self.residuals(samples))
    }
}

/// The inputs in the paper's order.
pub(crate) fn input_row(input: &CycleInput) -> [f64; 4] {
    [
        input.position,
        input.speed,
        input.acceleration,
        input.command,
    ]
}
