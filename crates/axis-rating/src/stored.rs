//! Values as serde reads and writes them (feature `serde`): what the constructors refuse does not get in.

use crate::{RatingError, TorqueCurve};

impl TryFrom<Vec<[f64; 2]>> for TorqueCurve {
    type Error = RatingError;

    fn try_from(points: Vec<[f64; 2]>) -> Result<Self, RatingError> {
        Self::new(points)
    }
}

impl From<TorqueCurve> for Vec<[f64; 2]> {
    fn from(curve: TorqueCurve) -> Self {
        curve.points().to_vec()
    }
}
