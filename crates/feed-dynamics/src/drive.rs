//! The drive's parameters, checked once.

use beam_fem::{CrossSection, Material};

use crate::error::{not_negative, positive};
use crate::{AxialSupport, DriveError, ScrewShaft};

/// Everything that makes a drive. SI units.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct DriveParameters {
    /// Cross-section of the screw.
    pub section: CrossSection,
    /// Material of the screw.
    pub material: Material,
    /// Length L of the screw between its ends, m.
    pub screw_length: f64,
    /// Number N of finite elements along the screw, at least 2.
    pub elements: usize,
    /// Travel per screw turn, m.
    pub lead: f64,
    /// Inertia j_m of the motor's rotor, kg·m².
    pub motor_inertia: f64,
    /// Inertia j_TS of the torque sensor, kg·m².
    pub sensor_inertia: f64,
    /// Torsional stiffness K_R1 between motor and sensor, N·m/rad.
    pub motor_coupling_stiffness: f64,
    /// Torsional stiffness K_R2 between sensor and screw, N·m/rad.
    pub screw_coupling_stiffness: f64,
    /// Mass m_wt of the table, kg.
    pub table_mass: f64,
    /// Axial stiffness k_scn of the screw–nut pair, N/m.
    pub nut_stiffness: f64,
    /// What holds the screw along its axis, where it and the screw give way along
    /// it: in series with the nut, massless. `None` for a shaft that is rigid there.
    pub axial: Option<AxialSupport>,
    /// Stiffness-proportional damping β in C = βK, s.
    pub stiffness_damping: f64,
}

/// A ball-screw feed drive: immutable, shared by any number of simulations.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        try_from = "crate::stored::StoredDrive",
        into = "crate::stored::StoredDrive"
    )
)]
pub struct FeedDrive {
    parameters: DriveParameters,
    /// The shaft along its axis, on its bearings.
    shaft: Option<ScrewShaft>,
    /// Whether a positive rotation moves the table towards the driven end.
    left_handed: bool,
}

impl FeedDrive {
    /// Checks the parameters and makes the drive.
    ///
    /// # Errors
    /// [`DriveError::Parameter`] names the first field that is out of range.
    pub fn new(parameters: DriveParameters) -> Result<Self, DriveError> {
        let p = &parameters;
        positive([
            ("screw_length", p.screw_length),
            ("lead", p.lead),
            ("motor_inertia", p.motor_inertia),
            ("sensor_inertia", p.sensor_inertia),
            ("motor_coupling_stiffness", p.motor_coupling_stiffness),
            ("screw_coupling_stiffness", p.screw_coupling_stiffness),
            ("table_mass", p.table_mass),
            ("nut_stiffness", p.nut_stiffness),
        ])?;
        not_negative([("stiffness_damping", p.stiffness_damping)])?;
        if !(2..=1000).contains(&p.elements) {
            return Err(DriveError::Parameter {
                name: "elements",
                value: p.elements as f64,
                valid: "between 2 and 1000",
            });
        }
        let shaft = p.axial.map(|support| shaft(p, &support)).transpose()?;
        Ok(Self {
            parameters,
            shaft,
            left_handed: false,
        })
    }

    /// The same drive with a left-handed screw: as made, a positive rotation of
    /// the motor moves the table away from the driven end (x grows); with a left-handed
    /// screw towards it, r < 0.
    #[must_use]
    pub fn left_handed(self) -> Self {
        Self {
            left_handed: true,
            ..self
        }
    }

    /// Whether the screw is left-handed.
    pub fn is_left_handed(&self) -> bool {
        self.left_handed
    }

    /// The parameters it was made from.
    pub fn parameters(&self) -> &DriveParameters {
        &self.parameters
    }

    /// Travel per radian of the screw, r = lead / 2π, m/rad; below zero for a screw that
    /// is [`FeedDrive::left_handed`].
    pub fn travel_per_radian(&self) -> f64 {
        let r = self.parameters.lead / std::f64::consts::TAU;
        if self.left_handed { -r } else { r }
    }

    /// Axial stiffness between screw and table k(x), N/m: of the nut, in series with
    /// the shaft on its bearings where [`DriveParameters::axial`] has them. Beyond an
    /// end of the screw it is that of the end.
    #[inline]
    pub fn contact_stiffness(&self, x: f64) -> f64 {
        let nut = self.parameters.nut_stiffness;
        match &self.shaft {
            None => nut,
            Some(shaft) => 1.0 / (1.0 / nut + shaft.compliance(x)),
        }
    }

    /// Number of generalised coordinates, N + 4.
    pub fn coordinates(&self) -> usize {
        self.parameters.elements + 4
    }

    /// Inertia of everything that rotates, kg·m².
    pub fn rotating_inertia(&self) -> f64 {
        let p = &self.parameters;
        let screw = p.material.density() * p.section.polar_moment() * p.screw_length;
        p.motor_inertia + p.sensor_inertia + screw
    }

    /// Inertia of the whole axis seen at the motor, table included, kg·m².
    pub fn total_inertia(&self) -> f64 {
        self.rotating_inertia() + self.parameters.table_mass * self.travel_per_radian().powi(2)
    }

    /// Whether the position `x` (m from the driven end) is on the screw.
    pub(crate) fn has(&self, x: f64) -> bool {
        (0.0..=self.parameters.screw_length).contains(&x)
    }

    /// Refuses positions off the screw.
    ///
    /// # Errors
    /// [`DriveError::OffScrew`], for one that is no number too.
    pub fn check_position(&self, x: f64) -> Result<(), DriveError> {
        if self.has(x) {
            return Ok(());
        }
        Err(DriveError::OffScrew {
            position: x,
            length: self.parameters.screw_length,
        })
    }
}

/// The screw along its axis.
fn shaft(p: &DriveParameters, support: &AxialSupport) -> Result<ScrewShaft, DriveError> {
    let rigidity = p.material.youngs_modulus() * p.section.area();
    ScrewShaft::new(rigidity, p.screw_length, support.mounting)?
        .on_bearings(support.bearing_stiffness)
}

#[cfg(test)]
pub(crate) mod tests_support {
    use super::*;

    /// The paper's drive with another stiffness-proportional damping, s.
    pub(crate) fn drive_with_damping(stiffness_damping: f64) -> FeedDrive {
        let steel = Material::new(206e9, 0.3, 7850.0).unwrap();
        FeedDrive::new(DriveParameters {
            section: CrossSection::solid_circle(0.040, &steel).unwrap(),
            material: steel,
            screw_length: 1.5,
            elements: 10,
            lead: 0.010,
            motor_inertia: 0.0053,
            sensor_inertia: 1e-4,
            motor_coupling_stiffness: 2800.0,
            screw_coupling_stiffness: 2800.0,
            table_mass: 515.0,
            nut_stiffness: 7.45e7,
            axial: None,
            stiffness_damping,
        })
        .unwrap()
    }
}
