//! Many rows at once: outputs, and their derivatives by weights and inputs.

use alloc::vec;
use alloc::vec::Vec;

use crate::backward::Evaluated;
use crate::error::{rows_of, same_length};
use crate::simd::Kernel;
use crate::{AllTansig, Error, Network, Scratch, Transfers};

/// Most bytes of a table of derivatives: rows may be given in portions.
const MAX_TABLE: u64 = 4 << 30;

impl Network {
    /// Outputs for many rows of inputs, both row-major and in the caller's
    /// units; each row has the bits of [`Network::evaluate`]. Rows do not
    /// depend on each other: several threads may share them out, each with a
    /// scratch of its own.
    ///
    /// ```
    /// use cfnn::{Network, Scaling, Shape};
    /// let shape = Shape { inputs: 2, hidden: vec![], outputs: 1 };
    /// let scaling = Scaling::from_ranges(&[(-1.0, 1.0); 2], &[(-1.0, 1.0)])?;
    /// let network = Network::new(shape, scaling, vec![0.5, 2.0, -1.0])?;
    /// let mut y = [0.0; 3];
    /// network.evaluate_rows(&[0.0, 0.0, 1.0, 0.0, 1.0, 1.0], &mut network.scratch(), &mut y)?;
    /// assert_eq!(y, [0.5, 2.5, 1.5]);
    /// # Ok::<(), cfnn::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::EmptyLayer`] without a whole row, [`Error::Length`] if the
    /// inputs are not whole rows or the outputs are not as many, or for a
    /// scratch made by another network.
    pub fn evaluate_rows(
        &self,
        inputs: &[f64],
        scratch: &mut Scratch,
        outputs: &mut [f64],
    ) -> Result<(), Error> {
        let rows = rows_of("input values", inputs, self.shape().inputs)?;
        let expected = rows.saturating_mul(self.shape().outputs);
        same_length("output values", outputs.len(), expected)?;
        self.check_scratch(scratch)?;
        self.run::<true>(inputs, scratch, outputs);
        Ok(())
    }

    /// The Jacobian of the outputs by the weights, for rows of inputs in the
    /// caller's units: row-major, one row for each output of each row of
    /// inputs (row `r O + o`), one column for each weight in the order of
    /// [`Network::weights`]. In the output's unit per unit of weight.
    /// Columns of links that the architecture lacks are zero: those weights
    /// cannot change.
    ///
    /// By backpropagation: `∂y_o/∂W[i, j] = δ_oj a_i` times half the output's
    /// range (Hagan and Menhaj 1994, doi 10.1109/72.329697, for layers that
    /// see one layer; here each sees all before it).
    ///
    /// ```
    /// use cfnn::{Network, Scaling, Shape};
    /// // y = 0.5 + 2 x: by the bias 1, by the slope x.
    /// let shape = Shape { inputs: 1, hidden: vec![], outputs: 1 };
    /// let scaling = Scaling::from_ranges(&[(-1.0, 1.0)], &[(-1.0, 1.0)])?;
    /// let network = Network::new(shape, scaling, vec![0.5, 2.0])?;
    /// assert_eq!(network.jacobian(&[0.25, -1.0])?, [1.0, 0.25, 1.0, -1.0]);
    /// # Ok::<(), cfnn::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::EmptyLayer`] without a whole row, [`Error::Length`] if the
    /// inputs are not whole rows, [`Error::DerivativeMemory`] for a table of
    /// more than 4 GiB.
    pub fn jacobian(&self, inputs: &[f64]) -> Result<Vec<f64>, Error> {
        self.derivatives_of_rows(inputs, Derivative::Weights)
    }

    /// Derivatives of the outputs by the inputs, for rows of inputs:
    /// row-major, one row for each output of each row of inputs (row
    /// `r O + o`), one column for each input; all in the caller's units.
    /// Dropped inputs have 0. Without allocation:
    /// [`crate::FixedNetwork::sensitivities`].
    ///
    /// ```
    /// use cfnn::{Network, Scaling, Shape};
    /// // The range of x is 2, that of y is 20.
    /// let shape = Shape { inputs: 1, hidden: vec![], outputs: 1 };
    /// let scaling = Scaling::from_ranges(&[(0.0, 2.0)], &[(0.0, 20.0)])?;
    /// let network = Network::new(shape, scaling, vec![0.0, 1.0])?;
    /// assert_eq!(network.sensitivities(&[0.25])?, [10.0]);
    /// # Ok::<(), cfnn::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Network::jacobian`].
    pub fn sensitivities(&self, inputs: &[f64]) -> Result<Vec<f64>, Error> {
        self.derivatives_of_rows(inputs, Derivative::Inputs)
    }

    fn derivatives_of_rows(&self, inputs: &[f64], of: Derivative) -> Result<Vec<f64>, Error> {
        let rows = rows_of("input values", inputs, self.shape().inputs)?;
        let columns = match of {
            Derivative::Weights => self.weights().len(),
            Derivative::Inputs => self.shape().inputs,
        };
        let free = self.architecture().free();
        let mut scratch = self.scratch();
        let mut table = vec![0.0; table_size(rows, self.shape().outputs, columns)?];
        let mut output = vec![0.0; self.shape().outputs];
        let mut adjoint = scratch.activations.clone();
        let tables = table.chunks_exact_mut(self.shape().outputs * columns);
        for (input, table) in inputs.chunks_exact(self.shape().inputs).zip(tables) {
            self.run::<false>(input, &mut scratch, &mut output);
            for (o, row) in table.chunks_exact_mut(columns).enumerate() {
                self.adjoint(o, &scratch, &mut adjoint);
                match of {
                    Derivative::Weights => {
                        self.by_weights(o, &scratch.activations, &adjoint, row);
                        if let Some(free) = &free {
                            keep(free, row);
                        }
                    }
                    Derivative::Inputs => self.by_inputs(o, &adjoint, row),
                }
            }
        }
        Ok(table)
    }

    /// Derivatives of a scaled output: see [`Evaluated::derivatives`].
    fn adjoint(&self, output: usize, scratch: &Scratch, adjoint: &mut [f64]) {
        let transfers = self.architecture.transfers();
        if transfers.is_empty() {
            let evaluated = self.evaluated(AllTansig, scratch);
            let kernel = Adjoint {
                evaluated,
                output,
                adjoint,
            };
            scratch.vectors.run(kernel);
        } else {
            let evaluated = self.evaluated(transfers, scratch);
            let kernel = Adjoint {
                evaluated,
                output,
                adjoint,
            };
            scratch.vectors.run(kernel);
        }
    }

    fn evaluated<'a, X>(&'a self, transfers: X, scratch: &'a Scratch) -> Evaluated<'a, f64, X> {
        Evaluated {
            hidden: &self.shape().hidden,
            outputs: self.shape().outputs,
            transfers,
            weights: &self.packed,
            activations: &scratch.activations,
        }
    }

    fn by_weights(&self, output: usize, activations: &[f64], adjoint: &[f64], row: &mut [f64]) {
        let scale = self.scaling().output()[output].half_width();
        let mut rest = row;
        let mut seen = 1 + self.shape().inputs;
        for &neurons in &self.shape().hidden {
            let (own, later) = rest.split_at_mut(seen * neurons);
            rest = later;
            let delta = &adjoint[seen..][..neurons];
            for (to, a) in own.chunks_exact_mut(neurons).zip(activations) {
                for (to, d) in to.iter_mut().zip(delta) {
                    *to = scale * d * a;
                }
            }
            seen += neurons;
        }
        let outputs = self.shape().outputs;
        for (to, a) in rest[output..].iter_mut().step_by(outputs).zip(activations) {
            *to = scale * a;
        }
    }

    fn by_inputs(&self, output: usize, adjoint: &[f64], row: &mut [f64]) {
        let scale = self.scaling().output()[output].half_width();
        let ranges = self.scaling().input();
        for ((to, d), range) in row.iter_mut().zip(&adjoint[1..]).zip(ranges) {
            *to = d * scale * range.gain();
        }
    }
}

/// Numbers of a table, if it is not too large.
fn table_size(rows: usize, outputs: usize, columns: usize) -> Result<usize, Error> {
    let size = [outputs, columns]
        .iter()
        .fold(rows, |n, &m| n.saturating_mul(m));
    let bytes = (size as u64).saturating_mul(8);
    if bytes > MAX_TABLE {
        return Err(Error::DerivativeMemory {
            bytes,
            limit: MAX_TABLE,
        });
    }
    Ok(size)
}

#[derive(Debug, Clone, Copy)]
enum Derivative {
    Weights,
    Inputs,
}

struct Adjoint<'a, X> {
    evaluated: Evaluated<'a, f64, X>,
    output: usize,
    adjoint: &'a mut [f64],
}

impl<X: Transfers> Kernel for Adjoint<'_, X> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.evaluated.derivatives(self.output, self.adjoint);
    }
}

/// Zero everywhere but at the given places, which rise.
fn keep(places: &[usize], row: &mut [f64]) {
    let mut kept = places.iter().peekable();
    for (index, value) in row.iter_mut().enumerate() {
        if kept.next_if(|&&place| place == index).is_none() {
            *value = 0.0;
        }
    }
}
