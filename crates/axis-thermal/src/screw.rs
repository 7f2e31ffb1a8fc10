//! A screw, its air and its ends.

use std::f64::consts::{FRAC_PI_4, PI};

use crate::error::{ThermalError, check};

/// Most segments of a screw.
pub(crate) const MOST_SEGMENTS: usize = 400;

/// A solid screw. Its place 0 is where positions of the table are 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ThermalScrew {
    /// Length along which the nut may be, m.
    pub length: f64,
    /// Diameter, m.
    pub diameter: f64,
    /// Density, kg/m³.
    pub density: f64,
    /// Specific heat, J/(kg·K).
    pub specific_heat: f64,
    /// Conductivity, W/(m·K).
    pub conductivity: f64,
    /// Linear expansion, 1/K.
    pub expansion: f64,
    /// Length of the shaft between each bearing and the places 0 and `length`, m. It has the
    /// temperature of its bearing.
    pub shaft: f64,
    /// Length of the nut, over which its heat is spread, m.
    pub nut_length: f64,
    /// Segments of equal length.
    pub segments: usize,
    /// Heat that it gives to the air.
    pub air: ScrewAir,
    /// How it is held.
    pub ends: ScrewEnds,
}

/// Heat transfer of a turning shaft to the air, W/(m²·K): h = still + 0.133 Re^⅔ Pr^⅓ λ/D,
/// Re = ωD²/(2ν) (Becker, Int. J. Heat Mass Transfer 6 (1963) 1053,
/// doi:10.1016/0017-9310(63)90006-1; so used for ball screws in
/// doi:10.1016/j.ijmachtools.2011.04.001). Text books state the same law with Re = ωD²/ν, which
/// gives 1.6 times as much: `turning` is a factor for that.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ScrewAir {
    /// At rest: free convection and radiation, W/(m²·K).
    pub still: f64,
    /// Factor of the part by turning.
    pub turning: f64,
}

/// How a screw is held along its axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum ScrewEnds {
    /// Fixed at the driven end; the other end is free or floats.
    #[default]
    OneFixed,
    /// Fixed at both ends.
    BothFixed {
        /// Axial rigidity E A, N.
        rigidity: f64,
        /// Axial stiffness of each bearing, N/m.
        bearing_stiffness: f64,
        /// Tension in the screw at the temperature from which growth is counted, N.
        pretension: f64,
    },
}

/// Of air at 20 °C: conductivity λ, W/(m·K), kinematic viscosity ν, m²/s, Prandtl number
/// (VDI Heat Atlas, 2nd ed., D2.2).
const AIR: [f64; 3] = [0.0257, 15.3e-6, 0.71];

impl Default for ScrewAir {
    /// 6 W/(m²·K) at rest, assumed.
    fn default() -> Self {
        Self {
            still: 6.0,
            turning: 1.0,
        }
    }
}

impl Default for ThermalScrew {
    /// Steel, 40 mm by 1.5 m. Shaft and nut are assumed.
    fn default() -> Self {
        Self {
            length: 1.5,
            diameter: 0.04,
            density: 7850.0,
            specific_heat: 460.0,
            conductivity: 46.0,
            expansion: 11.5e-6,
            shaft: 0.08,
            nut_length: 0.1,
            segments: 60,
            air: ScrewAir::default(),
            ends: ScrewEnds::default(),
        }
    }
}

impl ThermalScrew {
    /// Length of a segment, m.
    pub fn segment(&self) -> f64 {
        self.length / self.segments as f64
    }

    /// Heat capacity of a segment, J/K.
    pub(crate) fn capacity(&self) -> f64 {
        self.density * self.specific_heat * self.area() * self.segment()
    }

    /// Conductance between neighbours, W/K.
    pub(crate) fn conductance(&self) -> f64 {
        self.conductivity * self.area() / self.segment()
    }

    /// A conductance to an end, W/K, in series with half a segment.
    pub(crate) fn end_to_middle(&self, conductance: f64) -> f64 {
        let half = 2.0 * self.conductance();
        conductance * half / (conductance + half)
    }

    fn area(&self) -> f64 {
        FRAC_PI_4 * self.diameter * self.diameter
    }

    /// Conductance of a segment to the air, W/K, where the mean of |ω|^⅔ is `turning` (rad/s)^⅔.
    pub(crate) fn air_conductance(&self, turning: f64) -> f64 {
        let [conductivity, viscosity, prandtl] = AIR;
        let reynolds = (0.5 * self.diameter * self.diameter / viscosity).powf(2.0 / 3.0) * turning;
        let moving = 0.133 * reynolds * prandtl.cbrt() * conductivity / self.diameter;
        let film = self.air.still + self.air.turning * moving;
        film * PI * self.diameter * self.segment()
    }

    pub(crate) fn validate(&self) -> Result<(), ThermalError> {
        let positive = |name, value: f64, unit, most: f64| {
            let inside = value > 0.0 && value <= most;
            check(
                inside,
                name,
                value,
                unit,
                "above 0, of a screw that can be built",
            )
        };
        positive("length of the screw", self.length, "m", 100.0)?;
        positive("diameter of the screw", self.diameter, "m", 1.0)?;
        positive("density of the screw", self.density, "kg/m³", 1e5)?;
        positive("specific_heat", self.specific_heat, "J/(kg·K)", 1e5)?;
        positive("conductivity", self.conductivity, "W/(m·K)", 1e4)?;
        let least = |name, value: f64, unit, most: f64| {
            check(
                (0.0..=most).contains(&value),
                name,
                value,
                unit,
                "0 or above, of a screw that can be built",
            )
        };
        least("expansion of the screw", self.expansion, "1/K", 1e-4)?;
        least("shaft", self.shaft, "m", 100.0)?;
        least("nut_length", self.nut_length, "m", self.length)?;
        least("still air", self.air.still, "W/(m²·K)", 1e4)?;
        least("turning", self.air.turning, "", 100.0)?;
        let segments = self.segments as f64;
        let inside = (2..=MOST_SEGMENTS).contains(&self.segments);
        check(inside, "segments", segments, "", "from 2 to 400")?;
        if let ScrewEnds::BothFixed {
            rigidity,
            bearing_stiffness,
            pretension,
        } = self.ends
        {
            positive("rigidity", rigidity, "N", 1e13)?;
            positive("bearing_stiffness", bearing_stiffness, "N/m", 1e13)?;
            least("pretension", pretension, "N", 1e8)?;
        }
        Ok(())
    }
}
