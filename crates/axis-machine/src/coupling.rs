//! What one axis does to where another carries the tool: squareness, straightness, cross-talk.
//!
//! ```text
//! p_i = q_i + Σ_j ( φ_ij q_j + w_ij(q_j) + k_ij q̈_j )
//! ```
//!
//! q_i is the position that the scale of axis i shows, p_i that of the tool along it. On a circle of radius R at feed v,
//! q = R (cos θ, sin θ), a squareness φ of X by Y moves the tool by φ R sin θ in X, radially by
//!
//! ```text
//! φ R sin θ cos θ = ½ φ R sin 2θ           k a_y cos θ = −½ k (v²/R) sin 2θ
//! ```
//!
//! and a cross-talk k by the second: at one feed the two cannot be told apart ([`crate::fit_circles`]). The form of
//! the cross-talk, Δs_i = Σ k_ij a_j, is that of HEIDENHAIN's CTC (Cross Talk Compensation); the
//! equations above are written down from the geometry.

use crate::error::MachineError;
use crate::straightness::Straightness;

/// What axis `by` does to the tool's position along axis `of`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AxisCoupling {
    /// Which axis, from 0.
    pub of: usize,
    /// By the motion of which, from 0.
    pub by: usize,
    /// Squareness error φ, rad (m/m): the tool moves so far along `of` per travel of `by`.
    pub squareness: f64,
    /// Cross-talk k, m/(m/s²) = s²: the tool moves so far along `of` per acceleration of `by`.
    pub crosstalk: f64,
    /// Straightness of `by` in the direction of `of`, over the position of `by` that its scale shows.
    pub straightness: Option<Straightness>,
}

/// All that lies between the axes of a machine.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coupling {
    pairs: Vec<AxisCoupling>,
}

/// Greatest squareness error, rad: 10 mm/m.
pub(crate) const MOST_SQUARENESS: f64 = 0.01;

/// Greatest cross-talk, m/(m/s²): 1 mm/(m/s²).
pub(crate) const MOST_CROSSTALK: f64 = 1e-3;

impl Coupling {
    /// Of these pairs; several of one pair add up.
    ///
    /// # Errors
    /// [`MachineError::Invalid`] for a pair of one axis with itself, a squareness beyond 0.01 rad or a cross-talk beyond
    /// 0.001 m/(m/s²).
    pub fn new(pairs: Vec<AxisCoupling>) -> Result<Self, MachineError> {
        for pair in &pairs {
            let refuse = |what, value, unit, valid: &str| {
                Err(MachineError::Invalid {
                    what,
                    axis: pair.of + 1,
                    value,
                    unit,
                    valid: valid.to_owned(),
                })
            };
            if pair.of == pair.by {
                let (what, number) = (
                    "the axis that acts on the tool's position",
                    pair.by as f64 + 1.0,
                );
                return refuse(what, number, "", "another one");
            }
            // Both false for a NaN too.
            let square = pair.squareness.abs() <= MOST_SQUARENESS;
            if !square {
                return refuse(
                    "the squareness",
                    pair.squareness,
                    "rad",
                    "from -0.01 to 0.01 rad (10 000 µm/m)",
                );
            }
            let small = pair.crosstalk.abs() <= MOST_CROSSTALK;
            if !small {
                let valid = "from -0.001 to 0.001 m/(m/s²) (1000 µm/(m/s²))";
                return refuse("the cross-talk", pair.crosstalk, "m/(m/s²)", valid);
            }
        }
        Ok(Self { pairs })
    }

    /// Its pairs.
    pub fn pairs(&self) -> &[AxisCoupling] {
        &self.pairs
    }

    /// Whether an acceleration moves the tool.
    pub(crate) fn has_crosstalk(&self) -> bool {
        self.pairs.iter().any(|pair| pair.crosstalk != 0.0)
    }

    /// Those that move the tool along axis `of`.
    pub(crate) fn of(&self, of: usize) -> impl Iterator<Item = &AxisCoupling> {
        self.pairs.iter().filter(move |pair| pair.of == of)
    }

    /// How far the tool is moved along each axis, m. `positions` (m) are in the path's coordinates, and `zeros` (m) those of the
    /// axes where these are 0; `accelerations` in m/s².
    pub fn shift<const D: usize>(
        &self,
        positions: &[f64; D],
        zeros: &[f64; D],
        accelerations: &[f64; D],
    ) -> [f64; D] {
        let mut shift = [0.0; D];
        for pair in self.pairs.iter().filter(|pair| pair.of < D && pair.by < D) {
            let bow = pair.straightness.as_ref();
            let bow = bow.map_or(0.0, |table| {
                table.at(zeros[pair.by] + positions[pair.by])[0]
            });
            shift[pair.of] += pair.squareness * positions[pair.by]
                + bow
                + pair.crosstalk * accelerations[pair.by];
        }
        shift
    }
}
