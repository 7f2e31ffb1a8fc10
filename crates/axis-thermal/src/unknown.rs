//! The numbers of a thermal model that nobody knows, as factors on what is assumed.

use crate::friction::TemperatureLaw;
use crate::parameters::ThermalParameters;

/// A number, or several that go together, that logs of growth can tell something of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum ThermalUnknown {
    /// Nut's share of friction, dry and viscous.
    NutShare,
    /// Bearings' share.
    BearingsShare,
    /// Share of the nut's heat that goes into the screw.
    NutIntoScrew,
    /// Fall of viscous friction with temperature.
    ViscousFall,
    /// Fall of dry friction with temperature.
    DryFall,
    /// Rise of the preload with the screw's temperature.
    PreloadRise,
    /// Air around the screw at rest.
    StillAir,
    /// Air around the turning screw.
    TurningAir,
    /// Capacity of the front bearing.
    FrontCapacity,
    /// Front bearing to bed.
    FrontToBed,
    /// Front bearing to screw.
    FrontToScrew,
    /// Rear bearing to bed.
    RearToBed,
    /// Rear bearing to screw.
    RearToScrew,
    /// Capacity of the nut.
    NutCapacity,
    /// Nut to screw.
    NutToScrew,
    /// Nut to table.
    NutToTable,
    /// Capacity of the table.
    TableCapacity,
}

/// The greatest sum of two shares.
const WHOLE: f64 = 0.98;

impl ThermalUnknown {
    /// All.
    pub const ALL: [Self; 17] = [
        Self::NutShare,
        Self::BearingsShare,
        Self::NutIntoScrew,
        Self::ViscousFall,
        Self::DryFall,
        Self::PreloadRise,
        Self::StillAir,
        Self::TurningAir,
        Self::FrontCapacity,
        Self::FrontToBed,
        Self::FrontToScrew,
        Self::RearToBed,
        Self::RearToScrew,
        Self::NutCapacity,
        Self::NutToScrew,
        Self::NutToTable,
        Self::TableCapacity,
    ];

    /// Multiplies it by a factor; shares stay below what makes 1 together.
    pub fn scale(self, p: &mut ThermalParameters, by: f64) {
        let share = |of: &mut f64, other: f64| *of = (*of * by).min(WHOLE - other.min(WHOLE));
        match self {
            Self::NutShare => {
                share(&mut p.shares.nut.dry, p.shares.bearings.dry);
                share(&mut p.shares.nut.viscous, p.shares.bearings.viscous);
            }
            Self::BearingsShare => {
                share(&mut p.shares.bearings.dry, p.shares.nut.dry);
                share(&mut p.shares.bearings.viscous, p.shares.nut.viscous);
            }
            Self::NutIntoScrew => share(&mut p.shares.nut_into_screw, 0.0),
            Self::ViscousFall => scale_law(&mut p.friction.viscous, by),
            Self::DryFall => scale_law(&mut p.friction.dry, by),
            Self::PreloadRise => p.friction.preload_per_kelvin *= by,
            Self::FrontCapacity => p.bodies.front_bearing.capacity *= by,
            Self::FrontToBed => p.links.front_bearing_to_bed *= by,
            Self::FrontToScrew => p.links.front_bearing_to_screw *= by,
            Self::RearToBed => p.links.rear_bearing_to_bed *= by,
            Self::RearToScrew => p.links.rear_bearing_to_screw *= by,
            Self::NutCapacity => p.bodies.nut.capacity *= by,
            Self::NutToScrew => p.links.nut_to_screw *= by,
            Self::NutToTable => p.links.nut_to_table *= by,
            Self::TableCapacity => p.bodies.table.capacity *= by,
            Self::StillAir | Self::TurningAir => {
                let Some(screw) = &mut p.screw else {
                    return;
                };
                match self {
                    Self::StillAir => screw.air.still *= by,
                    _ => screw.air.turning *= by,
                }
            }
        }
    }
}

fn scale_law(law: &mut TemperatureLaw, by: f64) {
    if let TemperatureLaw::Exponential { per_kelvin } | TemperatureLaw::Linear { per_kelvin } = law
    {
        *per_kelvin *= by;
    }
}
