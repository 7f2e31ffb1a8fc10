//! The numbers of a machine file, by name: what another program may change.

use crate::base::BaseMode;
use crate::coupling::{MOST_CROSSTALK, MOST_SQUARENESS};
use crate::file::{AxisName, MachineFile, MachineText};
use crate::gantry::GantryBeam;

/// A number of a machine file.
#[derive(Clone, Debug, PartialEq)]
pub struct MachineNumber {
    /// Table, axes and key: `coupling.x_by_y.squareness_um_per_m`, `base.y.frequency_hz`, `gantry.y.stiffness_n_per_m`. The second
    /// table of the same axes has `_2` behind them.
    pub name: String,
    /// In the unit that ends its key.
    pub value: f64,
    /// That unit; empty of a plain number.
    pub unit: &'static str,
    /// Least and greatest value, in that unit; those of a beam hold for the masses of the axis files.
    pub limits: [f64; 2],
}

/// Micrometres in a metre.
const MICRO: f64 = 1e6;

/// Key, unit, limits, the number.
type Line<'a> = (&'static str, &'static str, [f64; 2], &'a mut f64);

impl MachineFile {
    /// Its numbers but for the tables of straightness, in the order of the file's kinds of tables. `period` (s) is that of the machine's
    /// drives in common ([`RunningMachine::period`](crate::RunningMachine::period)).
    pub fn numbers(&self, period: f64) -> Vec<MachineNumber> {
        let mut text = self.text.clone();
        let mut all: Vec<MachineNumber> = Vec::new();
        for (table, lines) in self.tables(&mut text, period) {
            let begins = |table: &str| all.iter().any(|n| n.name.starts_with(&format!("{table}.")));
            let later = (2..).map(|i| format!("{table}_{i}"));
            let mut names = std::iter::once(table.clone()).chain(later);
            let table = names.find(|name| !begins(name)).unwrap_or(table);
            all.extend(
                lines
                    .into_iter()
                    .map(|(key, unit, limits, value)| MachineNumber {
                        name: format!("{table}.{key}"),
                        value: *value,
                        unit,
                        limits,
                    }),
            );
        }
        all
    }

    /// The same machine with other numbers, in the order of [`MachineFile::numbers`]; those that are missing stay as they are.
    #[must_use]
    pub fn with_numbers(&self, values: &[f64]) -> Self {
        let mut changed = self.clone();
        let tables = self.tables(&mut changed.text, 1.0);
        let places = tables.into_iter().flat_map(|(_, lines)| lines);
        for ((.., place), value) in places.zip(values) {
            *place = *value;
        }
        changed
    }

    /// Each table with its numbers, of a text of this file.
    fn tables<'a>(&self, text: &'a mut MachineText, period: f64) -> Vec<(String, Vec<Line<'a>>)> {
        let around = |most: f64| [-most, most];
        let mut all = Vec::new();
        for pair in &mut text.coupling {
            let name = format!("coupling.{}_by_{}", pair.of.letter(), pair.by.letter());
            let (squareness, crosstalk) = (
                around(MICRO * MOST_SQUARENESS),
                around(MICRO * MOST_CROSSTALK),
            );
            all.push((
                name,
                vec![
                    (
                        "squareness_um_per_m",
                        "um_per_m",
                        squareness,
                        &mut pair.squareness_um_per_m,
                    ),
                    (
                        "crosstalk_um_per_m_per_s2",
                        "um_s2_per_m",
                        crosstalk,
                        &mut pair.crosstalk_um_per_m_per_s2,
                    ),
                ],
            ));
        }
        for base in &mut text.base {
            let name = format!("base.{}", base.axis.letter());
            all.push((
                name,
                vec![
                    (
                        "frequency_hz",
                        "hz",
                        BaseMode::FREQUENCY,
                        &mut base.frequency_hz,
                    ),
                    (
                        "damping_ratio",
                        "",
                        BaseMode::DAMPING,
                        &mut base.damping_ratio,
                    ),
                    ("mass_ratio", "", BaseMode::MASS_RATIO, &mut base.mass_ratio),
                    ("at_tool", "", BaseMode::AT_TOOL, &mut base.at_tool),
                ],
            ));
        }
        for (gantry, second) in text.gantry.iter_mut().zip(&self.seconds) {
            let first = self.axes.get(gantry.axis as usize).unwrap_or(second);
            let masses = [first, second].map(|axis| axis.mechanism.load_inertia());
            let [stiffness, damping] = GantryBeam::most(masses, period);
            let name = format!("gantry.{}", gantry.axis.letter());
            all.push((
                name,
                vec![
                    (
                        "stiffness_n_per_m",
                        "n_per_m",
                        [0.0, stiffness],
                        &mut gantry.stiffness_n_per_m,
                    ),
                    (
                        "damping_n_s_per_m",
                        "n_s_per_m",
                        [0.0, damping],
                        &mut gantry.damping_n_s_per_m,
                    ),
                    ("tool", "", [0.0, 1.0], &mut gantry.tool),
                ],
            ));
        }
        all
    }
}

impl AxisName {
    /// As the file spells it.
    pub fn letter(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        }
    }
}
