//! The numbers of a thermal model.

use crate::friction::FrictionLaws;
use crate::screw::ThermalScrew;

/// A body of one temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ThermalBody {
    /// Heat capacity, J/K.
    pub capacity: f64,
    /// Conductance to the air around it, W/K.
    pub to_air: f64,
}

/// The bodies of an axis besides the segments of its screw.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ThermalBodies {
    /// Winding and its iron.
    pub winding: ThermalBody,
    /// Housing of the motor; the primary part's frame of a linear motor.
    pub housing: ThermalBody,
    /// Bearing of the screw at the driven end, with its seat.
    pub front_bearing: ThermalBody,
    /// Bearing at the other end.
    pub rear_bearing: ThermalBody,
    /// Nut with its flange.
    pub nut: ThermalBody,
    /// Table, carriage or slide.
    pub table: ThermalBody,
    /// Bed.
    pub bed: ThermalBody,
    /// Scale with its carrier.
    pub scale: ThermalBody,
}

/// What conducts heat between them, W/K.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ThermalLinks {
    /// Winding to housing.
    pub winding_to_housing: f64,
    /// Housing to the front bearing, through flange and bracket.
    pub housing_to_front_bearing: f64,
    /// Housing to the table: a linear motor's primary part is carried by it.
    pub housing_to_table: f64,
    /// Housing to bed: the motor of an axis without a screw stands on it.
    pub housing_to_bed: f64,
    /// Front bearing to bed.
    pub front_bearing_to_bed: f64,
    /// Rear bearing to bed.
    pub rear_bearing_to_bed: f64,
    /// Front bearing to the end of the screw.
    pub front_bearing_to_screw: f64,
    /// Rear bearing to the other end.
    pub rear_bearing_to_screw: f64,
    /// Nut to screw, spread over where the nut is.
    pub nut_to_screw: f64,
    /// Nut to table.
    pub nut_to_table: f64,
    /// Table to bed, through the guides.
    pub table_to_bed: f64,
    /// Scale to bed.
    pub scale_to_bed: f64,
}

/// Dry and viscous friction's shares of something.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FrictionShares {
    /// Of the dry friction.
    pub dry: f64,
    /// Of the viscous friction.
    pub viscous: f64,
}

/// Where the friction of the axis turns into heat. What nut and bearings do not take, the guides do.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct HeatShares {
    /// Nut's.
    pub nut: FrictionShares,
    /// Both bearings'.
    pub bearings: FrictionShares,
    /// The front bearing's share of both bearings'.
    pub front_of_bearings: f64,
    /// Share of the nut's heat that goes into the screw; the rest goes into the nut.
    pub nut_into_screw: f64,
    /// Share of the guides' heat that goes into the table; the rest goes into the bed.
    pub guide_into_table: f64,
}

/// Heat of the winding.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct WindingLoss {
    /// Loss for each square of the motor's torque, W/(N·m)², or W/N² of a linear motor: the
    /// inverse square of the motor constant, 1.5 R/K_t² of a synchronous motor without d current.
    pub per_torque_squared: f64,
    /// Share by which the resistance rises for each kelvin, 1/K.
    pub resistance_per_kelvin: f64,
}

/// Linear expansion of what positions are measured by.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Expansions {
    /// Of the scale, 1/K.
    pub scale: f64,
    /// Position at which the scale is fixed to the bed, m.
    pub scale_fixed_at: f64,
    /// Of the bed, 1/K.
    pub bed: f64,
}

/// All numbers of a thermal model, SI units and °C. The defaults are those of the axis of Liu et
/// al. 2025 (screw 40 mm by 1.5 m, table 515 kg), **assumed** from text-book formulas and usual
/// sizes: none was measured.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ThermalParameters {
    /// The screw; none of an axis without one, whose friction heats the guides alone.
    pub screw: Option<ThermalScrew>,
    /// Other bodies.
    pub bodies: ThermalBodies,
    /// Links between them.
    pub links: ThermalLinks,
    /// Where friction turns into heat.
    pub shares: HeatShares,
    /// How friction changes with temperature.
    pub friction: FrictionLaws,
    /// Winding's heat.
    pub winding: WindingLoss,
    /// Expansion of scale and bed.
    pub expansion: Expansions,
    /// Temperature at which friction and resistance have the values that losses are stated for, °C.
    pub reference_temperature: f64,
}
