//! Values as serde reads and writes them (feature `serde`): what the constructors refuse does not get in.

use serde::{Deserialize, Serialize};

use crate::{BeltStrands, DriveError, DriveParameters, FeedDrive, RigidDrive};

#[derive(Serialize, Deserialize)]
#[serde(rename = "FeedDrive", deny_unknown_fields)]
pub(crate) struct StoredDrive {
    parameters: DriveParameters,
    #[serde(default)]
    left_handed: bool,
}

impl TryFrom<StoredDrive> for FeedDrive {
    type Error = DriveError;

    fn try_from(stored: StoredDrive) -> Result<Self, DriveError> {
        let drive = Self::new(stored.parameters)?;
        Ok(match stored.left_handed {
            true => drive.left_handed(),
            false => drive,
        })
    }
}

impl From<FeedDrive> for StoredDrive {
    fn from(drive: FeedDrive) -> Self {
        Self {
            left_handed: drive.is_left_handed(),
            parameters: drive.parameters().clone(),
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(rename = "RigidDrive", deny_unknown_fields)]
pub(crate) struct StoredRigidDrive {
    inertia: f64,
    travel_per_radian: f64,
}

impl TryFrom<StoredRigidDrive> for RigidDrive {
    type Error = DriveError;

    fn try_from(stored: StoredRigidDrive) -> Result<Self, DriveError> {
        Self::new(stored.inertia, stored.travel_per_radian)
    }
}

impl From<RigidDrive> for StoredRigidDrive {
    fn from(drive: RigidDrive) -> Self {
        Self {
            inertia: drive.inertia(),
            travel_per_radian: drive.travel_per_radian(),
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(rename = "BeltStrands", deny_unknown_fields)]
pub(crate) struct StoredStrands {
    specific_stiffness: f64,
    shortest: f64,
    total: f64,
}

impl TryFrom<StoredStrands> for BeltStrands {
    type Error = DriveError;

    fn try_from(stored: StoredStrands) -> Result<Self, DriveError> {
        Self::new(stored.specific_stiffness, stored.shortest, stored.total)
    }
}

impl From<BeltStrands> for StoredStrands {
    fn from(strands: BeltStrands) -> Self {
        Self {
            specific_stiffness: strands.specific_stiffness,
            shortest: strands.shortest,
            total: strands.total,
        }
    }
}
