//! Designs whose variables have given rank correlations.

use crate::{Design, LhsError, Marginal, Normal};

/// Rounds in which the correlation of the scores is corrected by what the
/// ranks still lack. After a few the gain is below the grain of n ranks; only
/// what is better is kept, so more do no harm.
const ROUNDS: usize = 16;

/// Least pivot of a Cholesky factor: 1 − R² of a variable on those before it,
/// rounded at 10⁻¹⁶ times the number of variables (1024 at most).
const LEAST_PIVOT: f64 = 1e-12;

/// A correlation matrix that variables can have together: symmetric, ones on
/// the diagonal, positive definite.
#[derive(Debug, Clone, PartialEq)]
pub struct CorrelationMatrix {
    dims: usize,
    values: Vec<f64>,
}

impl CorrelationMatrix {
    /// Takes the m × m `values`, row after row, for `dims` = m variables.
    ///
    /// # Errors
    /// `dims` is zero or above [`MAX_DIMS`](crate::MAX_DIMS), there are not
    /// m² values, an entry on the diagonal is not 1 or another not within
    /// (−1, 1), the matrix is not symmetric, or not positive definite (the
    /// message names a factor of the correlations that would make it so).
    pub fn new(dims: usize, values: &[f64]) -> Result<Self, LhsError> {
        crate::design::check_dims(dims)?;
        if values.len() != dims * dims {
            return Err(LhsError::Index {
                what: "values of a correlation matrix:",
                found: values.len(),
                valid: "the square of the number of variables,",
                limit: dims * dims,
            });
        }
        for (at, &value) in values.iter().enumerate() {
            let (row, column) = (at / dims, at % dims);
            let mirrored = values[column * dims + row];
            let valid = match row == column {
                true if value != 1.0 => "1 on the diagonal",
                false if !(value > -1.0 && value < 1.0) => "above -1 and below 1",
                false if value != mirrored => "equal to the entry across the diagonal",
                _ => continue,
            };
            return Err(LhsError::Correlation {
                row,
                column,
                value,
                valid,
            });
        }
        match cholesky(dims, values) {
            Ok(_) => Ok(Self {
                dims,
                values: values.to_vec(),
            }),
            Err(variable) => Err(LhsError::NotPositiveDefinite {
                variable,
                factor: valid_factor(dims, values),
            }),
        }
    }

    /// Number of variables m.
    pub fn dims(&self) -> usize {
        self.dims
    }

    /// The m² entries, row after row.
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}

/// A design with its rank correlations.
#[derive(Debug, Clone, PartialEq)]
pub struct RankCorrelated {
    /// The design: each column holds the values it held before.
    pub design: Design,
    /// Its [`rank_correlation`], m × m, row after row.
    pub correlation: Vec<f64>,
    /// The greatest difference of an entry from its target.
    pub deviation: f64,
}

/// Spearman's rank correlation of every two columns, m × m, row after row,
/// ones on the diagonal. Equal values share the mean of their ranks
/// (midranks). An entry is NaN if one of its two columns is constant.
/// O(n m (m + log n)) time.
pub fn rank_correlation(design: &Design) -> Vec<f64> {
    let columns: Vec<Vec<f64>> = (0..design.dims()).map(|j| midranks(design, j)).collect();
    correlations(&columns)
}

/// Rearranges the values within each column so that the columns have rank
/// correlations as near as possible to `target`: Iman and Conover 1982, doi
/// 10.1080/03610918208812265. A Latin hypercube stays one, each marginal
/// keeps its values; the first column keeps its order too.
///
/// The ranks of the design, as normal scores Φ⁻¹(rank/(n + 1)) (van der
/// Waerden), are freed of the correlation that they have by chance, given
/// that of the target by Cholesky factors, and their order is taken over. As
/// normal variables of correlation ρ have the rank correlation
/// (6/π) asin(ρ/2) (Pearson 1907), scores get 2 sin(π/6 · target); what the
/// ranks then lack is added to it in 15 rounds, each kept only if it is better.
///
/// ```
/// use lhs::{CorrelationMatrix, LatinHypercube, rank_correlated};
///
/// let design = LatinHypercube::new(200, 2, 1)?.design()?;
/// let target = CorrelationMatrix::new(2, &[1.0, -0.6, -0.6, 1.0])?;
/// let made = rank_correlated(&design, &target)?;
/// assert!((made.correlation[1] + 0.6).abs() < 1e-3);
/// # Ok::<(), lhs::LhsError>(())
/// ```
///
/// No random number is drawn: the result depends on `design` and `target`
/// alone. The remaining difference is in `deviation`; it falls with n, and is
/// larger for targets that are nearly singular. O(n m (m + log n)) time for
/// each round.
///
/// # Errors
/// The target is of another number of variables; n ≤ m; a column is
/// constant; or the columns of the design depend on each other linearly, so
/// that nothing can free them.
pub fn rank_correlated(
    design: &Design,
    target: &CorrelationMatrix,
) -> Result<RankCorrelated, LhsError> {
    let (n, dims) = (design.len(), design.dims());
    if target.dims != dims {
        return Err(LhsError::Index {
            what: "variables of the correlation matrix:",
            found: target.dims,
            valid: "the number of columns of the design,",
            limit: dims,
        });
    }
    if n <= dims {
        return Err(LhsError::Argument {
            what: "points of a design to be correlated",
            found: n,
            valid: "more than its number of variables",
        });
    }
    let sorted: Vec<Vec<f64>> = (0..dims).map(|j| sorted_column(design, j)).collect();
    if sorted.iter().any(|s| s[0] == s[n - 1]) {
        return Err(LhsError::Argument {
            what: "different values in a column to be correlated",
            found: 1,
            valid: "at least 2",
        });
    }
    let free = uncorrelated_scores(design)?;
    let wanted = |value: &f64| match *value {
        1.0 => 1.0,
        r => 2.0 * libm::sin(std::f64::consts::FRAC_PI_6 * r),
    };
    let mut inner: Vec<f64> = target.values.iter().map(wanted).collect();
    if cholesky(dims, &inner).is_err() {
        inner.clone_from(&target.values);
    }
    let first = cholesky(dims, &inner).map_err(|column| LhsError::DependentColumns { column })?;
    let mut best = ordered_like(&free, &first, &sorted, target);
    let mut gain = 1.0;
    for _ in 1..ROUNDS {
        let mut corrected = inner.clone();
        for at in (0..dims * dims).filter(|at| at / dims != at % dims) {
            corrected[at] += gain * (target.values[at] - best.correlation[at]);
        }
        // Half the correction where the whole leaves the positive definite
        // matrices, or does harm because of the grain of the ranks.
        let made = cholesky(dims, &corrected).map(|f| ordered_like(&free, &f, &sorted, target));
        match made {
            Ok(made) if made.deviation < best.deviation => {
                (best, inner) = (made, corrected);
            }
            _ => gain *= 0.5,
        }
    }
    Ok(best)
}

/// The design whose columns have the values `sorted` in the order of the
/// scores `free`, correlated by `factor`.
fn ordered_like(
    free: &[Vec<f64>],
    factor: &[f64],
    sorted: &[Vec<f64>],
    target: &CorrelationMatrix,
) -> RankCorrelated {
    let (dims, n) = (free.len(), free[0].len());
    let mut values = vec![0.0; n * dims];
    for j in 0..dims {
        let row = &factor[j * dims..][..=j];
        let score = |i: usize| -> f64 { row.iter().zip(free).map(|(f, s)| f * s[i]).sum() };
        let scores: Vec<f64> = (0..n).map(score).collect();
        for (rank, i) in order(&scores).into_iter().enumerate() {
            values[i * dims + j] = sorted[j][rank];
        }
    }
    let design = Design::from_valid(dims, values);
    let correlation = rank_correlation(&design);
    let pairs = correlation.iter().zip(&target.values);
    let deviation = pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
    RankCorrelated {
        design,
        correlation,
        deviation,
    }
}

/// The normal scores of the ranks, freed of their correlation, column after
/// column.
fn uncorrelated_scores(design: &Design) -> Result<Vec<Vec<f64>>, LhsError> {
    let (n, dims) = (design.len(), design.dims());
    let normal = Normal::new(0.0, 1.0)?;
    let score = |rank: usize| normal.inverse_cdf((rank + 1) as f64 / (n + 1) as f64);
    let mut columns = Vec::with_capacity(dims);
    for j in 0..dims {
        let column: Vec<f64> = design.column(j).collect();
        let mut scores = vec![0.0; n];
        for (rank, i) in order(&column).into_iter().enumerate() {
            scores[i] = score(rank);
        }
        columns.push(scores);
    }
    let own = cholesky(dims, &correlations(&columns))
        .map_err(|column| LhsError::DependentColumns { column })?;
    // Forward substitution, one column at a time.
    for j in 0..dims {
        let (before, from) = columns.split_at_mut(j);
        let row = &own[j * dims..][..=j];
        for (i, s) in from[0].iter_mut().enumerate() {
            let known: f64 = row.iter().zip(&*before).map(|(f, b)| f * b[i]).sum();
            *s = (*s - known) / row[j];
        }
    }
    Ok(columns)
}

/// Row numbers in the order of the values; of equal ones, in that of rows.
fn order(values: &[f64]) -> Vec<usize> {
    let mut rows: Vec<usize> = (0..values.len()).collect();
    rows.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    rows
}

fn sorted_column(design: &Design, dim: usize) -> Vec<f64> {
    let mut column: Vec<f64> = design.column(dim).collect();
    column.sort_by(f64::total_cmp);
    column
}

/// Ranks from 0; equal values share their mean.
fn midranks(design: &Design, dim: usize) -> Vec<f64> {
    let column: Vec<f64> = design.column(dim).collect();
    let rows = order(&column);
    let mut ranks = vec![0.0; rows.len()];
    let mut first = 0;
    for equal in rows.chunk_by(|&a, &b| column[a] == column[b]) {
        let mean = first as f64 + 0.5 * (equal.len() - 1) as f64;
        equal.iter().for_each(|&i| ranks[i] = mean);
        first += equal.len();
    }
    ranks
}

/// Pearson's correlation of every two columns, m × m.
fn correlations(columns: &[Vec<f64>]) -> Vec<f64> {
    let dims = columns.len();
    let centred = |column: &Vec<f64>| -> Vec<f64> {
        let mean = column.iter().sum::<f64>() / column.len() as f64;
        column.iter().map(|v| v - mean).collect()
    };
    let columns: Vec<Vec<f64>> = columns.iter().map(centred).collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let lengths: Vec<f64> = columns.iter().map(|c| dot(c, c).sqrt()).collect();
    let mut all = vec![1.0; dims * dims];
    for j in 0..dims {
        for k in 0..j {
            let r = dot(&columns[j], &columns[k]) / lengths[j] / lengths[k];
            let r = r.clamp(-1.0, 1.0);
            (all[j * dims + k], all[k * dims + j]) = (r, r);
        }
    }
    all
}

/// The lower Cholesky factor, m × m, of a matrix with ones on its diagonal;
/// the first row without a pivot as the error.
fn cholesky(dims: usize, matrix: &[f64]) -> Result<Vec<f64>, usize> {
    let mut factor = vec![0.0; dims * dims];
    for j in 0..dims {
        for k in 0..=j {
            let rows = factor[j * dims..][..k].iter().zip(&factor[k * dims..][..k]);
            let known: f64 = rows.map(|(a, b)| a * b).sum();
            let open = matrix[j * dims + k] - known;
            factor[j * dims + k] = match j == k {
                false => open / factor[k * dims + k],
                true if open.is_nan() || open <= LEAST_PIVOT => return Err(j),
                true => open.sqrt(),
            };
        }
    }
    Ok(factor)
}

/// A factor of the entries off the diagonal, in hundredths, with which the
/// matrix is positive definite: the greatest of them, by halving.
fn valid_factor(dims: usize, matrix: &[f64]) -> f64 {
    let holds = |percent: u32| {
        let factor = f64::from(percent) / 100.0;
        let mut scaled: Vec<f64> = matrix.iter().map(|v| v * factor).collect();
        scaled.iter_mut().step_by(dims + 1).for_each(|v| *v = 1.0);
        cholesky(dims, &scaled).is_ok()
    };
    let (mut good, mut bad) = (0, 100);
    while bad - good > 1 {
        let middle = (good + bad) / 2;
        match holds(middle) {
            true => good = middle,
            false => bad = middle,
        }
    }
    f64::from(good) / 100.0
}
