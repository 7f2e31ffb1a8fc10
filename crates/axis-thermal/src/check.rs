//! Which numbers make a thermal model.

use crate::error::{ThermalError, check};
use crate::parameters::{
    FrictionShares, HeatShares, ThermalBodies, ThermalBody, ThermalLinks, ThermalParameters,
};
use crate::screw::ThermalScrew;

impl ThermalParameters {
    /// Checks all numbers.
    ///
    /// # Errors
    /// [`ThermalError::Invalid`] names the first that is out of its range.
    pub fn validate(&self) -> Result<(), ThermalError> {
        for (name, body) in self.bodies.named() {
            let ThermalBody { capacity, to_air } = body;
            let inside = (1e-3..=1e9).contains(&capacity);
            check(
                inside,
                name,
                capacity,
                "J/K",
                "a capacity from 0.001 to 1e9",
            )?;
            let inside = (0.0..=1e6).contains(&to_air);
            check(inside, name, to_air, "W/K", "a conductance from 0 to 1e6")?;
        }
        for (name, conductance) in self.links.named() {
            let inside = (0.0..=1e6).contains(&conductance);
            check(inside, name, conductance, "W/K", "from 0 to 1e6")?;
        }
        self.shares.validate()?;
        self.friction.validate()?;
        let loss = self.winding.per_torque_squared;
        let inside = (0.0..=1e9).contains(&loss);
        check(
            inside,
            "per_torque_squared",
            loss,
            "W/(N·m)²",
            "from 0 to 1e9",
        )?;
        let rise = self.winding.resistance_per_kelvin;
        let inside = (0.0..=0.1).contains(&rise);
        check(
            inside,
            "resistance_per_kelvin",
            rise,
            "1/K",
            "from 0 to 0.1",
        )?;
        for (name, value) in [
            ("expansion of the scale", self.expansion.scale),
            ("expansion of the bed", self.expansion.bed),
        ] {
            check(
                (-1e-4..=1e-4).contains(&value),
                name,
                value,
                "1/K",
                "from -1e-4 to 1e-4",
            )?;
        }
        let place = self.expansion.scale_fixed_at;
        check(
            place.is_finite(),
            "scale_fixed_at",
            place,
            "m",
            "a finite place",
        )?;
        let zero = self.reference_temperature;
        let inside = (-100.0..=200.0).contains(&zero);
        check(
            inside,
            "reference_temperature",
            zero,
            "°C",
            "from -100 to 200",
        )?;
        self.screw.as_ref().map_or(Ok(()), ThermalScrew::validate)
    }
}

impl ThermalBodies {
    fn named(&self) -> [(&'static str, ThermalBody); 8] {
        [
            ("winding", self.winding),
            ("housing", self.housing),
            ("front_bearing", self.front_bearing),
            ("rear_bearing", self.rear_bearing),
            ("nut", self.nut),
            ("table", self.table),
            ("bed", self.bed),
            ("scale", self.scale),
        ]
    }
}

impl ThermalLinks {
    fn named(&self) -> [(&'static str, f64); 12] {
        [
            ("winding_to_housing", self.winding_to_housing),
            ("housing_to_front_bearing", self.housing_to_front_bearing),
            ("housing_to_table", self.housing_to_table),
            ("housing_to_bed", self.housing_to_bed),
            ("front_bearing_to_bed", self.front_bearing_to_bed),
            ("rear_bearing_to_bed", self.rear_bearing_to_bed),
            ("front_bearing_to_screw", self.front_bearing_to_screw),
            ("rear_bearing_to_screw", self.rear_bearing_to_screw),
            ("nut_to_screw", self.nut_to_screw),
            ("nut_to_table", self.nut_to_table),
            ("table_to_bed", self.table_to_bed),
            ("scale_to_bed", self.scale_to_bed),
        ]
    }
}

impl HeatShares {
    /// What the guides take.
    pub fn guide(&self) -> FrictionShares {
        FrictionShares {
            dry: 1.0 - self.nut.dry - self.bearings.dry,
            viscous: 1.0 - self.nut.viscous - self.bearings.viscous,
        }
    }

    fn validate(&self) -> Result<(), ThermalError> {
        let guide = self.guide();
        for (name, share) in [
            ("nut's share of dry friction", self.nut.dry),
            ("nut's share of viscous friction", self.nut.viscous),
            ("bearings' share of dry friction", self.bearings.dry),
            ("bearings' share of viscous friction", self.bearings.viscous),
            ("front_of_bearings", self.front_of_bearings),
            ("nut_into_screw", self.nut_into_screw),
            ("guide_into_table", self.guide_into_table),
        ] {
            check((0.0..=1.0).contains(&share), name, share, "", "from 0 to 1")?;
        }
        for (name, left) in [
            ("guides' share of dry friction", guide.dry),
            ("guides' share of viscous friction", guide.viscous),
        ] {
            // 1 less two shares that make 1 may fall short by its rounding.
            let valid = "shares of nut and bearings that are at most 1 together";
            check(left >= -1e-12, name, left, "", valid)?;
        }
        Ok(())
    }
}
