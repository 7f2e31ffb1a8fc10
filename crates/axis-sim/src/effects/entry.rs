//! Effects as an axis file has them.

use std::fmt::Write;

use super::{ActiveEffect, Scales};

impl ActiveEffect {
    /// The lines of an axis file that add this effect: a `[[effects]]` table, a unit behind
    /// each value. `number` writes a value (SI).
    pub fn entry(&self, scales: &Scales, number: fn(f64) -> String) -> String {
        let mut text = format!("\n[[effects]]\nname = \"{}\"\n", self.effect.name);
        for (parameter, value) in self.effect.parameters.iter().zip(&self.values) {
            let unit = match parameter.unit(scales) {
                "" => String::new(),
                unit => format!("    # {unit}"),
            };
            // Writing to a text does not fail.
            let _ = writeln!(text, "{} = {}{unit}", parameter.name, number(*value));
        }
        text
    }
}
