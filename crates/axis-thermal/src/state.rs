//! The bodies of an axis, and their temperatures.

use nalgebra::DVector;

/// A body of one temperature; the segments of the screw stand behind them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum HeatNode {
    /// Winding and its iron.
    Winding,
    /// Motor's housing.
    Housing,
    /// Bearing at the driven end.
    FrontBearing,
    /// Bearing at the other end.
    RearBearing,
    /// Nut.
    Nut,
    /// Table, carriage or slide.
    Table,
    /// Bed.
    Bed,
    /// Scale.
    Scale,
}

impl HeatNode {
    /// All, in their order.
    pub const ALL: [Self; 8] = [
        Self::Winding,
        Self::Housing,
        Self::FrontBearing,
        Self::RearBearing,
        Self::Nut,
        Self::Table,
        Self::Bed,
        Self::Scale,
    ];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Winding => "winding",
            Self::Housing => "motor housing",
            Self::FrontBearing => "front bearing",
            Self::RearBearing => "rear bearing",
            Self::Nut => "nut",
            Self::Table => "table",
            Self::Bed => "bed",
            Self::Scale => "scale",
        }
    }
}

/// Number of bodies before the screw's segments.
pub(crate) const BODIES: usize = HeatNode::ALL.len();

/// The temperatures of an axis at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct ThermalState {
    /// Since its start, s.
    pub time: f64,
    pub(crate) temperatures: DVector<f64>,
}

impl ThermalState {
    /// Temperature of a body, °C.
    pub fn of(&self, node: HeatNode) -> f64 {
        self.temperatures[node as usize]
    }

    /// Temperatures of the screw's segments from the driven end, °C; none without a screw.
    pub fn screw(&self) -> &[f64] {
        &self.temperatures.as_slice()[BODIES..]
    }
}
