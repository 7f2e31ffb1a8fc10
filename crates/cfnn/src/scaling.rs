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
    /// finite (a constant input carries nothing: [`Scaling::fit_varying`]).
    pub fn fit(
        inputs: usize,
        input_rows: &[f64],
        outputs: usize,
        output_rows: &[f64],
    ) -> Result<Self, Error> {
        check_tables(inputs, input_rows, outputs, output_rows)?;
        Self::from_ranges(
            &extremes(inputs, input_rows),
            &extremes(outputs, output_rows),
        )
    }

    /// As [`Scaling::fit`] where some inputs do not vary: with the inputs whose
    /// values are all the same, which [`crate::Architecture::without_inputs`]
    /// takes (MATLAB's `removeconstantrows` before `mapminmax`). Such an input
    /// gets a range around its value; the network takes 0 for it, whatever comes.
    ///
    /// ```
    /// use cfnn::Scaling;
    /// let (scaling, constant) = Scaling::fit_varying(2, &[1.0, 7.0, 3.0, 7.0], 1, &[0.0, 1.0])?;
    /// assert_eq!(constant, [1]);
    /// assert_eq!(scaling.input()[0].maximum(), 3.0);
    /// # Ok::<(), cfnn::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Scaling::fit`], but for constant inputs; their values must be
    /// below half of the largest `f64`.
    pub fn fit_varying(
        inputs: usize,
        input_rows: &[f64],
        outputs: usize,
        output_rows: &[f64],
    ) -> Result<(Self, Vec<usize>), Error> {
        check_tables(inputs, input_rows, outputs, output_rows)?;
        let mut ranges = extremes(inputs, input_rows);
        let mut constant = Vec::new();
        for (index, (low, high)) in ranges.iter_mut().enumerate() {
            if low == high {
                constant.push(index);
                let half = low.abs().max(1.0);
                (*low, *high) = (*low - half, *high + half);
            }
        }
        let scaling = Self::from_ranges(&ranges, &extremes(outputs, output_rows))?;
        Ok((scaling, constant))
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

/// Refuses tables that are not as many whole rows each, at least one.
fn check_tables(
    inputs: usize,
    input_rows: &[f64],
    outputs: usize,
    output_rows: &[f64],
) -> Result<(), Error> {
    for (what, width) in [("inputs", inputs), ("outputs", outputs)] {
        if width == 0 {
            return Err(Error::EmptyLayer { what, index: 0 });
        }
    }
    let rows = rows_of("input values", input_rows, inputs)?;
    let expected = rows.saturating_mul(outputs);
    same_length("output values", output_rows.len(), expected)
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
