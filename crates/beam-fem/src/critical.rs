//! Critical speeds and the Campbell diagram.

use nalgebra::{Complex, DMatrix, DVector, SymmetricEigen};

use crate::error::{finite, positive};
use crate::system::SystemMatrices;
use crate::whirl::{WhirlAnalysis, WhirlMode, WhirlSpectrum};
use crate::{BeamError, BeamModel};

/// A speed at which a mode whirls in a fixed ratio to the spin.
#[derive(Clone, Debug, PartialEq)]
pub struct CriticalSpeed {
    /// Spin speed Ω, rad/s.
    pub spin: f64,
    /// The mode there, undamped: λ = iω with Ω = ratio · ω.
    pub mode: WhirlMode,
}

impl WhirlAnalysis {
    /// Undamped critical speeds, the lowest `count`, forward and backward: spins Ω =
    /// `ratio` · ω at which a mode whirls at ω, from one eigenproblem and no diagram,
    /// K q = ω² (M − i·ratio·G) q (Nelson and McVaugh 1976, J. Eng. Ind. 98, 593, doi
    /// 10.1115/1.3438942). A ratio of 1 is synchronous, which unbalance excites; 1/2 is
    /// an excitation at twice the spin. Damping is left out, that within the shaft too; there may be fewer than
    /// `count`, since discs with J_p > J_d stiffen against forward whirl.
    ///
    /// # Errors
    /// [`BeamError::Parameter`] for a ratio that is not finite and above zero,
    /// [`BeamError::NotSymmetric`] with cross stiffness that is not symmetric
    /// ([`WhirlAnalysis::crossings`] is for that), [`BeamError::Unsupported`] if a rigid motion is free,
    /// [`BeamError::NotConverged`].
    pub fn critical_speeds(
        &self,
        ratio: f64,
        count: usize,
    ) -> Result<Vec<CriticalSpeed>, BeamError> {
        positive("ratio", ratio)?;
        self.system.check_symmetric(
            "WhirlAnalysis::crossings finds the critical speeds of such bearings",
        )?;
        if self.squares.iter().any(|s| *s <= 0.0) {
            return Err(BeamError::Unsupported {
                task: "a critical speed",
            });
        }
        let n = self.squares.len();
        let rates: Vec<f64> = self.squares.iter().map(|s| s.sqrt()).collect();
        // D⁻¹ (1 − i·ratio·G) D⁻¹ y = ω⁻² y, Hermitian, y = D η.
        let hermitian = DMatrix::from_fn(n, n, |i, j| {
            let one = if i == j { 1.0 } else { 0.0 };
            Complex::new(one, -ratio * self.gyroscopic[(i, j)]) / (rates[i] * rates[j])
        });
        if !hermitian
            .iter()
            .all(|v| v.re.is_finite() && v.im.is_finite())
        {
            return Err(BeamError::NotFinite {
                field: "gyroscopic",
            });
        }
        let eigen = SymmetricEigen::try_new(hermitian, f64::EPSILON, 1000 * n)
            .ok_or(BeamError::NotConverged)?;
        let mut ranks: Vec<usize> = (0..n).filter(|&k| eigen.eigenvalues[k] > 0.0).collect();
        ranks.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let found = ranks.into_iter().take(count).map(|k| {
            let whirl = eigen.eigenvalues[k].sqrt().recip();
            let column = eigen.eigenvectors.column(k);
            let eta = DVector::from_fn(n, |i, _| column[i] / rates[i]);
            let eta = &eta / Complex::new(eta.norm(), 0.0);
            CriticalSpeed {
                spin: ratio * whirl,
                mode: self.mode(Complex::new(0.0, whirl), &eta),
            }
        });
        Ok(found.filter(|c| c.spin.is_finite()).collect())
    }

    /// Critical speeds with damping and any bearings: where a damped frequency equals
    /// Ω/`ratio`, between the first and last of `spins` (rad/s, ascending), each to ten
    /// digits. Two crossings of one curve between neighbouring spins are missed.
    ///
    /// # Errors
    /// [`BeamError::Parameter`] for a ratio that is not finite and above zero and spins
    /// that are not finite or do not ascend; those of [`WhirlAnalysis::at`].
    pub fn crossings(&self, ratio: f64, spins: &[f64]) -> Result<Vec<f64>, BeamError> {
        positive("ratio", ratio)?;
        check_ascending(spins)?;
        let gaps = |spin: f64| -> Result<Vec<f64>, BeamError> {
            let frequencies = self.frequencies(spin)?;
            Ok(frequencies.iter().map(|w| w - spin / ratio).collect())
        };
        let mut out = Vec::new();
        let mut before: Option<(f64, Vec<f64>)> = None;
        for &spin in spins {
            let now = gaps(spin)?;
            if let Some((start, old)) = &before {
                // The lists are of one length; a curve is its place in the order.
                for (curve, (a, b)) in old.iter().zip(&now).enumerate() {
                    if *a > 0.0 && *b <= 0.0 || *a < 0.0 && *b >= 0.0 {
                        let at = |spin: f64| gaps(spin).map(|g| g[curve]);
                        out.push(root(&at, [*start, spin], [*a, *b])?);
                    }
                }
            }
            before = Some((spin, now));
        }
        out.sort_by(f64::total_cmp);
        Ok(out)
    }

    /// The lowest `count` modes at each of `spins` (rad/s): the Campbell diagram of a
    /// model whose bearings do not depend on speed. For others: [`campbell`].
    ///
    /// # Errors
    /// As [`WhirlAnalysis::at`].
    pub fn campbell(&self, spins: &[f64], count: usize) -> Result<Vec<WhirlSpectrum>, BeamError> {
        spins.iter().map(|spin| self.lowest(*spin, count)).collect()
    }
}

/// The lowest `count` modes at each of `spins` (rad/s) of a model that depends on the
/// speed: `model` gives it for each, with the bearing coefficients of that speed.
///
/// # Errors
/// Those of `model`, [`BeamModel::matrices`] and [`WhirlAnalysis::at`].
pub fn campbell(
    spins: &[f64],
    count: usize,
    mut model: impl FnMut(f64) -> Result<BeamModel, BeamError>,
) -> Result<Vec<WhirlSpectrum>, BeamError> {
    let mut at = |spin: &f64| -> Result<WhirlSpectrum, BeamError> {
        let system: SystemMatrices = model(*spin)?.matrices()?;
        WhirlAnalysis::new(&system)?.lowest(*spin, count)
    };
    spins.iter().map(&mut at).collect()
}

fn check_ascending(spins: &[f64]) -> Result<(), BeamError> {
    let mut before = f64::NEG_INFINITY;
    for &spin in spins {
        finite("spin", spin)?;
        if spin <= before {
            return Err(BeamError::Parameter {
                field: "spin",
                value: spin,
                valid: "above the one before it",
            });
        }
        before = spin;
    }
    Ok(())
}

/// Root of a continuous function between two places with values of different sign:
/// false position with the Illinois rule (Dowell and Jarratt 1971, BIT 11, 168).
fn root(
    at: &impl Fn(f64) -> Result<f64, BeamError>,
    ends: [f64; 2],
    values: [f64; 2],
) -> Result<f64, BeamError> {
    let ([mut a, mut b], [mut fa, mut fb]) = (ends, values);
    for _ in 0..100 {
        if fb == 0.0 || (b - a).abs() <= 1e-10 * b.abs() {
            break;
        }
        let next = b - fb * (b - a) / (fb - fa);
        let value = at(next)?;
        if value * fb < 0.0 {
            (a, fa) = (b, fb);
        } else {
            fa *= 0.5;
        }
        (b, fb) = (next, value);
    }
    Ok(b)
}
