//! Machines and hours for [`HeatedScrew`](crate::HeatedScrew).

use std::f64::consts::PI;

use crate::heat::{HeatLaws, HeatNumbers, HeatedScrew};
use crate::motion::Motion;
use crate::parameters::Parameters;

impl HeatNumbers {
    /// What `data/axes/screw-heat.toml` assumes, written once more.
    pub const ASSUMED: Self = Self {
        capacity: [2500.0, 7000.0, 5000.0, 3000.0, 3000.0, 120e3, 900e3, 1500.0],
        air: [0.0, 2.5, 0.0, 0.0, 0.6, 8.0, 25.0, 0.15],
        link: [4.0, 0.8, 6.0, 4.0, 6.0, 5.0, 10.0, 1.0],
        nut_screw: 15.0,
        nut_share: [0.45, 0.55],
        bearing_share: [0.30, 0.30],
        steel: [7850.0, 460.0, 46.0],
        expansion: 11.5e-6,
        shaft: 0.08,
        nut_length: 0.1,
        still_air: 6.0,
    };

    /// A machine of which that is a guess: shares, conductances and capacities are 10 to 60 % off.
    pub const OTHER: Self = Self {
        capacity: [2500.0, 7000.0, 6500.0, 3600.0, 2400.0, 95e3, 900e3, 1500.0],
        link: [4.0, 0.8, 8.0, 3.0, 4.5, 7.0, 14.0, 1.0],
        nut_screw: 11.0,
        nut_share: [0.38, 0.48],
        bearing_share: [0.36, 0.38],
        still_air: 8.0,
        ..Self::ASSUMED
    };
}

impl Parameters {
    /// The paper's axis with the viscous friction that meets its measured errors, 0.00312 N·m/rpm.
    pub fn paper_with_measured_viscosity() -> Self {
        Self {
            viscous: 0.00312 * 30.0 / PI,
            ..Self::paper()
        }
    }

    /// Inertia of all that moves, at the motor, kg·m².
    pub fn inertia(&self) -> f64 {
        let screw = self.density * PI * self.screw_diameter.powi(4) / 32.0 * self.screw_length;
        self.motor_inertia + self.sensor_inertia + screw + self.table_mass * self.travel().powi(2)
    }
}

impl HeatedScrew {
    /// [`HeatNumbers::ASSUMED`] with the library's laws, at a temperature, °C.
    pub fn assumed(temperature: f64) -> Self {
        let axis = Parameters::paper_with_measured_viscosity();
        Self::at(axis, HeatNumbers::ASSUMED, HeatLaws::SAME, temperature)
    }

    /// [`HeatNumbers::OTHER`] with other laws.
    pub fn other(temperature: f64) -> Self {
        let axis = Parameters::paper_with_measured_viscosity();
        Self::at(axis, HeatNumbers::OTHER, HeatLaws::OTHER, temperature)
    }
}

/// There and back between two places (m) at a speed (m/s) with standstills (s) at both; 1 m/s², 10 m/s³.
pub fn there_and_back(from: f64, to: f64, speed: f64, standstill: f64) -> Motion {
    let limits = |way: f64| [way, speed, 1.0, 10.0];
    Motion::from(from)
        .jerks(limits(to - from))
        .rest(standstill)
        .jerks(limits(from - to))
        .rest(standstill)
}

/// A stroke there and back: two places (m), speed (m/s), standstills (s).
pub type Stroke = [f64; 4];

/// Four hours of five duties and standstills: each a stroke (none at standstill) and how often five minutes of it.
pub const HOURS_TO_FIT: [(Option<Stroke>, u32); 7] = [
    (Some([0.45, 0.95, 0.2, 1.0]), 10),
    (None, 5),
    (Some([0.1, 1.4, 0.25, 0.5]), 9),
    (Some([0.9, 1.4, 0.12, 2.0]), 7),
    (None, 4),
    (Some([0.1, 0.5, 0.2, 0.5]), 7),
    (Some([0.3, 1.1, 0.08, 1.0]), 6),
];

/// Three hours of others.
pub const HOURS_TO_CHECK: [(Option<Stroke>, u32); 5] = [
    (Some([0.6, 1.2, 0.18, 0.7]), 9),
    (Some([0.2, 0.8, 0.22, 1.5]), 8),
    (None, 4),
    (Some([0.15, 1.35, 0.15, 0.5]), 8),
    (Some([0.7, 1.3, 0.25, 1.0]), 7),
];

/// Hours of duties: each with its motion (none at standstill) and how often five minutes of it.
#[derive(Clone, Debug)]
pub struct HeatHours {
    /// In their order.
    pub duties: Vec<(Option<Motion>, u32)>,
    /// Temperature of the air (°C) over the time (s).
    pub air: fn(f64) -> f64,
}

impl HeatHours {
    fn of(hours: &[(Option<Stroke>, u32)], air: fn(f64) -> f64) -> Self {
        let motion = |[from, to, speed, rest]: Stroke| there_and_back(from, to, speed, rest);
        let duties = hours
            .iter()
            .map(|(stroke, count)| (stroke.map(motion), *count));
        Self {
            duties: duties.collect(),
            air,
        }
    }

    /// [`HOURS_TO_FIT`], in air that drifts by 0.8 K and 0.25 K an hour.
    pub fn to_fit() -> Self {
        Self::of(&HOURS_TO_FIT, |t| {
            20.0 + 0.25 * t / 3600.0 + 0.8 * (t / 1900.0).sin()
        })
    }

    /// [`HOURS_TO_CHECK`], begun 1.8 K warmer.
    pub fn to_check() -> Self {
        Self::of(&HOURS_TO_CHECK, |t| {
            21.8 - 0.3 * t / 3600.0 + 0.5 * ((t / 2300.0 + 1.0).sin() - 1.0_f64.sin())
        })
    }
}
