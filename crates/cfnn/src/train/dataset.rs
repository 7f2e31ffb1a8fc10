use std::vec::Vec;

use crate::error::{all_finite, rows_of, same_length};
use crate::{Error, Scaling};

/// Samples to train on, in the caller's units.
#[derive(Debug, Clone, PartialEq)]
pub struct Dataset {
    inputs: usize,
    outputs: usize,
    input_rows: Vec<f64>,
    target_rows: Vec<f64>,
    weights: Option<Vec<f64>>,
}

impl Dataset {
    /// Samples as two row-major tables: `inputs` numbers a sample in
    /// `input_rows`, `outputs` numbers a sample in `target_rows`.
    ///
    /// # Errors
    /// [`Error::EmptyLayer`] for zero inputs, outputs or samples,
    /// [`Error::Length`] if a table does not divide into rows or the
    /// tables differ in their number of rows, [`Error::NotFinite`].
    pub fn new(
        inputs: usize,
        outputs: usize,
        input_rows: Vec<f64>,
        target_rows: Vec<f64>,
    ) -> Result<Self, Error> {
        for (what, size) in [("inputs", inputs), ("outputs", outputs)] {
            if size == 0 {
                return Err(Error::EmptyLayer { what, index: 0 });
            }
        }
        let samples = rows_of("input values", &input_rows, inputs)?;
        let expected = samples.saturating_mul(outputs);
        same_length("target values", target_rows.len(), expected)?;
        all_finite("input values", &input_rows)?;
        all_finite("target values", &target_rows)?;
        Ok(Self {
            inputs,
            outputs,
            input_rows,
            target_rows,
            weights: None,
        })
    }

    /// With a weight for each sample: training minimises `Σ w r²` (MATLAB's
    /// error weights `EW`). Loss and normalisation divide by the number of
    /// samples, whatever their weights. A sample of weight 0 does not count.
    ///
    /// ```
    /// use cfnn::train::Dataset;
    /// let data = Dataset::new(1, 1, vec![0.0, 1.0, 2.0], vec![0.0, 1.0, 9.0])?;
    /// // The third is known to a tenth of the others' deviation only: its variance is 100 times theirs.
    /// let data = data.with_weights(vec![1.0, 1.0, 0.01])?;
    /// assert_eq!(data.weights(), Some(&[1.0, 1.0, 0.01][..]));
    /// # Ok::<(), cfnn::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Length`] for another number than samples, [`Error::NotFinite`],
    /// [`Error::Negative`] for one below zero or if all are zero.
    pub fn with_weights(mut self, weights: Vec<f64>) -> Result<Self, Error> {
        same_length("sample weights", weights.len(), self.len())?;
        all_finite("sample weights", &weights)?;
        let wrong = match weights.iter().position(|&w| w < 0.0) {
            None if weights.iter().all(|&w| w == 0.0) => Some(0),
            found => found,
        };
        if let Some(index) = wrong {
            return Err(Error::Negative {
                what: "sample weights",
                index,
                value: weights[index],
            });
        }
        self.weights = Some(weights);
        Ok(self)
    }

    /// The weights of the samples, if they have any.
    #[must_use]
    pub fn weights(&self) -> Option<&[f64]> {
        self.weights.as_deref()
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.input_rows.len() / self.inputs
    }

    /// Never true: an empty data set cannot be made.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.input_rows.is_empty()
    }

    /// Numbers per sample on the input side.
    #[must_use]
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// Numbers per sample on the target side.
    #[must_use]
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// The inputs of one sample; none if there is no such sample.
    #[must_use]
    pub fn input(&self, sample: usize) -> Option<&[f64]> {
        self.input_rows.chunks_exact(self.inputs).nth(sample)
    }

    /// The targets of one sample; none if there is no such sample.
    #[must_use]
    pub fn target(&self, sample: usize) -> Option<&[f64]> {
        self.target_rows.chunks_exact(self.outputs).nth(sample)
    }

    /// Input `i` of a sample that exists, scaled.
    pub(super) fn scaled_input(&self, scaling: &Scaling, sample: usize, i: usize) -> f64 {
        scaling.input()[i].to_unit(self.input_rows[sample * self.inputs + i])
    }

    /// Target `o` of a sample that exists, scaled.
    fn scaled_target(&self, scaling: &Scaling, sample: usize, o: usize) -> f64 {
        scaling.output()[o].to_unit(self.target_rows[sample * self.outputs + o])
    }

    /// Min-max scaling fitted to these samples.
    ///
    /// # Errors
    /// As [`Scaling::fit`].
    pub fn scaling(&self) -> Result<Scaling, Error> {
        Scaling::fit(
            self.inputs,
            &self.input_rows,
            self.outputs,
            &self.target_rows,
        )
    }

    /// The same where some inputs do not vary, with those inputs.
    ///
    /// ```
    /// use cfnn::train::{Dataset, Trainer, TrainingSettings};
    /// use cfnn::{Architecture, Shape};
    /// // The second input does not vary.
    /// let x = vec![0.0, 7.0, 1.0, 7.0, 2.0, 7.0, 3.0, 7.0];
    /// let data = Dataset::new(2, 1, x, vec![0.0, 1.0, 4.0, 9.0])?;
    /// let (scaling, constant) = data.scaling_of_varying()?;
    /// let shape = Shape { inputs: 2, hidden: vec![2], outputs: 1 };
    /// let architecture = Architecture::from(shape).without_inputs(&constant)?;
    /// let trainer = Trainer::new(architecture, scaling, &data, TrainingSettings::default())?;
    /// let network = trainer.network();
    /// let mut scratch = network.scratch();
    /// let y = network.predict_one(&[1.5, 7.0], &mut scratch)?;
    /// assert_eq!(y, network.predict_one(&[1.5, f64::NAN], &mut scratch)?);
    /// # Ok::<(), cfnn::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Scaling::fit_varying`].
    pub fn scaling_of_varying(&self) -> Result<(Scaling, Vec<usize>), Error> {
        Scaling::fit_varying(
            self.inputs,
            &self.input_rows,
            self.outputs,
            &self.target_rows,
        )
    }

    /// A hash of sizes and bits (64-bit FNV-1a over words), by which a
    /// checkpoint recognises its data. Not proof against intent.
    #[must_use]
    pub fn fingerprint(&self) -> u64 {
        let sizes = [self.inputs as u64, self.outputs as u64];
        let weights = self.weights.iter().flatten();
        let values = self.input_rows.iter().chain(&self.target_rows);
        let values = values.chain(weights);
        sizes.into_iter().chain(values.map(|v| v.to_bits())).fold(
            0xcbf2_9ce4_8422_2325,
            |hash, word| {
                let mixed = (hash ^ word).wrapping_mul(0x0000_0100_0000_01b3);
                mixed ^ (mixed >> 29)
            },
        )
    }
}

/// Number of samples worked on together. Part of the definition of the
/// result's bits: sums run over a block first and over the blocks after that.
pub(super) const BLOCK: usize = 256;

/// Up to [`BLOCK`] samples, scaled, column by column.
#[derive(Debug, Clone)]
pub(super) struct SampleBlock {
    pub rows: usize,
    /// `rows x inputs`, column-major.
    pub inputs: Vec<f64>,
    /// `rows x outputs`, column-major.
    pub targets: Vec<f64>,
    /// Square roots of the samples' weights; none if all are 1.
    pub roots: Option<Vec<f64>>,
}

/// Cuts the chosen samples into scaled blocks.
pub(super) fn blocks(data: &Dataset, chosen: &[usize], scaling: &Scaling) -> Vec<SampleBlock> {
    let column_major = |chosen: &[usize], width: usize, value: &dyn Fn(usize, usize) -> f64| {
        let columns = (0..width).flat_map(|c| chosen.iter().map(move |&s| (s, c)));
        columns.map(|(s, c)| value(s, c)).collect::<Vec<_>>()
    };
    chosen
        .chunks(BLOCK)
        .map(|chosen| SampleBlock {
            rows: chosen.len(),
            inputs: column_major(chosen, data.inputs, &|s, c| {
                data.scaled_input(scaling, s, c)
            }),
            targets: column_major(chosen, data.outputs, &|s, c| {
                data.scaled_target(scaling, s, c)
            }),
            roots: (data.weights.as_ref())
                .map(|weights| chosen.iter().map(|&s| libm::sqrt(weights[s])).collect()),
        })
        .collect()
}
