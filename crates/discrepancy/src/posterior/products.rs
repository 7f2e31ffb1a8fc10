//! Whitened columns, and their products band by band.

use std::ops::Range;

use nalgebra::{Complex, DMatrix, DVector};
use rayon::prelude::*;

use crate::spectrum::{Amplitudes, Layout, Whitener};

/// A reference spectrum, one spectral matrix a band.
pub struct Reference<'a> {
    layout: &'a Layout,
    whitener: Whitener,
    /// Places of the whitened numbers, one band and channel after another.
    order: Vec<usize>,
    /// Which of these are of each band and channel.
    rows: Vec<Range<usize>>,
}

impl<'a> Reference<'a> {
    pub fn new(layout: &'a Layout, spectra: &[DMatrix<Complex<f64>>]) -> Self {
        let groups = layout.groups();
        let mut order: Vec<usize> = (0..groups.len()).collect();
        order.sort_by_key(|&i| groups[i]);
        let last = groups.iter().max().map_or(0, |g| g + 1);
        let mut rows = Vec::with_capacity(last);
        let mut from = 0;
        for group in 0..last {
            let to = from + order[from..].partition_point(|&i| groups[i] <= group);
            rows.push(from..to);
            from = to;
        }
        Self {
            layout,
            whitener: layout.whitener(spectra),
            order,
            rows,
        }
    }

    /// Whitened numbers of these columns, a column each.
    fn whitened(&self, columns: &[&Amplitudes]) -> DMatrix<f64> {
        let one = |column: &&Amplitudes| {
            let white = self.layout.whiten(&self.whitener, column);
            DVector::from_iterator(self.order.len(), self.order.iter().map(|&i| white[i]))
        };
        let all: Vec<DVector<f64>> = columns.par_iter().map(one).collect();
        DMatrix::from_columns(&all)
    }

    /// These columns, of which products are made.
    pub fn products(&self, columns: &[&Amplitudes]) -> Products {
        let counts = self.rows.iter().map(|rows| 0.5 * rows.len() as f64);
        Products {
            counts: counts.collect(),
            white: self.whitened(columns),
            rows: self.rows.clone(),
        }
    }
}

/// Whitened columns, the rest first, of which products are made band by band and channel by channel.
pub struct Products {
    /// Complex values of each band and channel.
    pub counts: Vec<f64>,
    rows: Vec<Range<usize>>,
    white: DMatrix<f64>,
}

impl Products {
    /// Of whitened columns that are all of one band and channel.
    #[cfg(test)]
    pub fn of_one_band(white: DMatrix<f64>) -> Self {
        Self {
            counts: vec![0.5 * white.nrows() as f64],
            rows: vec![0..white.nrows()],
            white,
        }
    }

    /// Number of columns, the rest among them.
    pub fn columns(&self) -> usize {
        self.white.ncols()
    }

    /// Products of some columns with each other.
    pub fn of(&self, columns: &[usize]) -> Vec<DMatrix<f64>> {
        let some = self.white.select_columns(columns);
        let gram = |rows: &Range<usize>| {
            let part = some.rows(rows.start, rows.len());
            // As a product of two matrices, which is far faster than `tr_mul`.
            part.transpose() * part
        };
        self.rows.iter().map(gram).collect()
    }

    /// All columns, each number weighed as its band and channel.
    pub fn weighed(&self, weights: &[f64]) -> DMatrix<f64> {
        let mut all = self.white.clone();
        for (rows, weight) in self.rows.iter().zip(weights) {
            all.rows_mut(rows.start, rows.len())
                .scale_mut(weight.sqrt());
        }
        all
    }

    /// With columns more, which are weighed sums of columns that are there.
    pub fn with(&mut self, sums: &[Vec<(usize, f64)>]) -> Range<usize> {
        let first = self.columns();
        let white = std::mem::replace(&mut self.white, DMatrix::zeros(0, 0));
        let mut white = white.resize_horizontally(first + sums.len(), 0.0);
        for (k, sum) in sums.iter().enumerate() {
            for &(column, by) in sum {
                let of = white.column(column).into_owned();
                white.column_mut(first + k).axpy(by, &of, 1.0);
            }
        }
        self.white = white;
        first..first + sums.len()
    }
}

/// The sum of products weighed band by band.
pub fn weighed(grams: &[DMatrix<f64>], weights: &[f64]) -> DMatrix<f64> {
    let n = grams.first().map_or(0, DMatrix::ncols);
    let mut sum = DMatrix::zeros(n, n);
    for (gram, weight) in grams.iter().zip(weights) {
        let pairs = sum.iter_mut().zip(gram.iter());
        pairs.for_each(|(s, g): (&mut f64, &f64)| *s += weight * g);
    }
    sum
}
