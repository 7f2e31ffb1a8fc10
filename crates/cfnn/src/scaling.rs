use alloc::vec::Vec;

use crate::error::{rows_of, same_length};
use crate::{Error, ScalingRange};

/// Min-max scaling of all inputs and outputs to `[-1, 1]`, stored with the
/// network so that it takes and gives the caller's units.
#[derive(Debug, Clone, PartialEq)]
pub struct Scaling {
    input: Vec<ScalingRange<f64>>,
    output: Vec<ScalingRange<f64>>,
}

impl Scaling {
    /// Scaling with given `(minimum, maximum)` of each input and output.
    ///
    /// # Errors
    /// [`Error::Range`] if a range is empty or not finite.
    pub fn from_ranges(input: &[(f64, f64)], output: &[(f64, f64)]) -> Result<Self, Error> {
        let ranges = |what, pairs: &[(f64, f64)]| {
            pairs
                .iter()
                .map(|&(low, high)| ScalingRange::new(what, low, high))
                .collect::<Result<Vec<_>, _>>()
        };
        Ok(Self {
            input: ranges("input", input)?,
            output: ranges("output", output)?,
        })
    }

    /// Scaling by the extremes of the samples; both slices hold one sample
    /// after the other (row-major), `inputs` and `outputs` numbers each.
    ///
    /// # Errors
    /// [`Error::EmptyLayer`] for zero inputs, outputs or samples,
    /// [`Error::Length`] when a slice does not divide into rows or the row
    /// counts differ, [`Error::Range`] for a column that is constant or not
    /// finite (a constant input carries nothing: leave it out).
    pub fn fit(
        inputs: usize,
        input_rows: &[f64],
        outputs: usize,
        output_rows: &[f64],
    ) -> Result<Self, Error> {
        for (what, width) in [("inputs", inputs), ("outputs", outputs)] {
            if width == 0 {
                return Err(Error::EmptyLayer { what, index: 0 });
            }
        }
        let rows = rows_of("input values", input_rows, inputs)?;
        let expected = rows.saturating_mul(outputs);
        same_length("output values", output_rows.len(), expected)?;
        Self::from_ranges(
            &extremes(inputs, input_rows),
            &extremes(outputs, output_rows),
        )
    }

    /// One range for each input.
    #[must_use]
    pub fn input(&self) -> &[ScalingRange<f64>] {
        &self.input
    }

    /// One range for each output.
    #[must_use]
    pub fn output(&self) -> &[ScalingRange<f64>] {
        &self.output
    }
}

/// Smallest and largest value of each column; a NaN makes both ends NaN.
fn extremes(width: usize, rows: &[f64]) -> Vec<(f64, f64)> {
    (0..width)
        .map(|column| {
            let start = (f64::INFINITY, f64::NEG_INFINITY);
            rows.iter()
                .skip(column)
                .step_by(width)
                .fold(start, |(low, high), &v| {
                    if v.is_nan() || low.is_nan() {
                        (f64::NAN, f64::NAN)
                    } else {
                        (low.min(v), high.max(v))
                    }
                })
        })
        .collect()
}
