//! Assumed values of the numbers that an axis file does not state.

use crate::friction::FrictionLaws;
use crate::parameters::{
    Expansions, FrictionShares, HeatShares, ThermalBodies, ThermalBody, ThermalLinks,
    ThermalParameters, WindingLoss,
};
use crate::screw::ThermalScrew;

const fn body(capacity: f64, to_air: f64) -> ThermalBody {
    ThermalBody { capacity, to_air }
}

impl Default for ThermalBodies {
    /// Assumed: masses of such an axis times 460 J/(kg·K), surfaces times 6 to 10 W/(m²·K).
    fn default() -> Self {
        Self {
            winding: body(2500.0, 0.0),
            housing: body(7000.0, 2.5),
            front_bearing: body(5000.0, 0.0),
            rear_bearing: body(3000.0, 0.0),
            nut: body(3000.0, 0.6),
            table: body(120e3, 8.0),
            bed: body(900e3, 25.0),
            scale: body(1500.0, 0.15),
        }
    }
}

impl Default for ThermalLinks {
    /// Of an axis with a screw; assumed.
    fn default() -> Self {
        Self {
            winding_to_housing: 4.0,
            housing_to_front_bearing: 0.8,
            housing_to_table: 0.0,
            housing_to_bed: 0.0,
            front_bearing_to_bed: 6.0,
            rear_bearing_to_bed: 4.0,
            front_bearing_to_screw: 6.0,
            rear_bearing_to_screw: 5.0,
            nut_to_screw: 15.0,
            nut_to_table: 10.0,
            table_to_bed: 0.0,
            scale_to_bed: 1.0,
        }
    }
}

impl Default for HeatShares {
    /// Of an axis with a screw; assumed.
    fn default() -> Self {
        Self {
            nut: FrictionShares {
                dry: 0.45,
                viscous: 0.55,
            },
            bearings: FrictionShares {
                dry: 0.30,
                viscous: 0.30,
            },
            front_of_bearings: 0.6,
            nut_into_screw: 0.5,
            guide_into_table: 0.5,
        }
    }
}

impl Default for WindingLoss {
    /// No loss; copper's resistance rises by 0.393 % of that at 20 °C for each kelvin (IEC 60028).
    fn default() -> Self {
        Self {
            per_torque_squared: 0.0,
            resistance_per_kelvin: 0.00393,
        }
    }
}

impl Default for Expansions {
    /// A steel scale (10 µm/(m·K)) fixed at 0, a cast iron bed (10.5 µm/(m·K)); assumed.
    fn default() -> Self {
        Self {
            scale: 10e-6,
            scale_fixed_at: 0.0,
            bed: 10.5e-6,
        }
    }
}

impl Default for ThermalParameters {
    /// An axis with a screw.
    fn default() -> Self {
        Self {
            screw: Some(ThermalScrew::default()),
            bodies: ThermalBodies::default(),
            links: ThermalLinks::default(),
            shares: HeatShares::default(),
            friction: FrictionLaws::default(),
            winding: WindingLoss::default(),
            expansion: Expansions::default(),
            reference_temperature: 20.0,
        }
    }
}

impl ThermalParameters {
    /// An axis without a screw whose motor stands on the bed (rack, belt, gear): the winding heats
    /// motor and bed, friction heats the guides.
    pub fn without_screw() -> Self {
        let links = ThermalLinks {
            housing_to_front_bearing: 0.0,
            housing_to_bed: 0.8,
            ..ThermalLinks::default()
        };
        let none = FrictionShares {
            dry: 0.0,
            viscous: 0.0,
        };
        let shares = HeatShares::default();
        Self {
            screw: None,
            links,
            shares: HeatShares {
                nut: none,
                bearings: none,
                ..shares
            },
            ..Self::default()
        }
    }

    /// An axis whose motor is carried by its table (linear motor).
    pub fn linear_motor() -> Self {
        let mut axis = Self::without_screw();
        axis.links.housing_to_table = 10.0;
        axis.links.housing_to_bed = 0.0;
        axis
    }
}
