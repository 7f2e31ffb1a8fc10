//! The file of a machine: which axis files, and what lies between them.

use std::path::{Path, PathBuf};

use axis_sim::{Axis, AxisFileError, toml_message};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::base::BaseMode;
use crate::coupling::{AxisCoupling, Coupling};
use crate::error::MachineError;
use crate::gantry::GantryBeam;
use crate::machine::CoupledMachine;
use crate::straightness::Straightness;

/// Why a machine file was refused.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MachineFileError {
    /// It cannot be read.
    #[error("{file}: cannot be read: {source}; valid: a machine file (TOML)")]
    Unread {
        /// Its name.
        file: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A key is missing, unknown or of another type; line and keys are in the message.
    #[error("{file}: {what}")]
    Text {
        /// Name of the file.
        file: PathBuf,
        /// What is wrong, where.
        what: String,
    },
    /// An axis file was refused.
    #[error(transparent)]
    Axis(#[from] Box<AxisFileError>),
    /// A value that does not fit the machine.
    #[error("{file}: {source}")]
    Machine {
        /// Name of the file.
        file: PathBuf,
        /// What is wrong.
        source: Box<MachineError>,
    },
    /// Something else does not fit.
    #[error("{file}: {what}; valid: {valid}")]
    Value {
        /// Name of the file.
        file: PathBuf,
        /// What is wrong.
        what: String,
        /// What would be valid.
        valid: &'static str,
    },
}

/// A machine file as it stands there. Lengths are in mm and µm, as its keys say.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
#[schemars(title = "Machine file", deny_unknown_fields)]
pub struct MachineText {
    /// Version of the format: 1.
    pub schema: u32,
    /// Short name.
    pub name: String,
    /// One line for people.
    #[serde(default)]
    pub description: String,
    /// The axis files, relative to this file.
    pub axes: MachineAxes,
    /// What one axis does to the tool's position along another.
    #[serde(default)]
    pub coupling: Vec<CouplingText>,
    /// Bases that move.
    #[serde(default)]
    pub base: Vec<BaseText>,
    /// Second drives of beams.
    #[serde(default)]
    pub gantry: Vec<GantryText>,
}

/// Axis files of the coordinates, relative to the machine file.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub struct MachineAxes {
    /// Of X.
    pub x: PathBuf,
    /// Of Y.
    pub y: PathBuf,
    /// Of Z, of a machine with three axes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub z: Option<PathBuf>,
}

/// Name of an axis of a machine.
#[derive(Clone, Copy, Debug, Deserialize, Eq, JsonSchema, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum AxisName {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

/// What axis `by` does to the tool's position along axis `of`.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub struct CouplingText {
    /// Along which axis the tool is moved.
    pub of: AxisName,
    /// By the motion of which.
    pub by: AxisName,
    /// Squareness error: so many µm along `of` per m of `by`.
    #[serde(default)]
    pub squareness_um_per_m: f64,
    /// Cross-talk: so many µm along `of` per m/s² of `by`.
    #[serde(default)]
    pub crosstalk_um_per_m_per_s2: f64,
    /// Straightness of `by` in the direction of `of`: position of `by` (mm, of its axis file) and deviation (µm).
    #[serde(default)]
    pub straightness_mm_um: Vec<[f64; 2]>,
}

/// A base that moves along an axis.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub struct BaseText {
    /// Along which axis.
    pub axis: AxisName,
    /// Natural frequency of base and load together.
    pub frequency_hz: f64,
    /// Damping ratio.
    #[serde(default)]
    pub damping_ratio: f64,
    /// Mass of the load to that of base and load.
    pub mass_ratio: f64,
    /// Share of its displacement by which the tool moves against the workpiece.
    #[serde(default = "whole")]
    pub at_tool: f64,
}

/// The second drive of a beam.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub struct GantryText {
    /// Which axis it moves, beside the drive of `[axes]`.
    pub axis: AxisName,
    /// Axis file of the second drive, relative to this file.
    pub second: PathBuf,
    /// Stiffness against the difference of the ends.
    pub stiffness_n_per_m: f64,
    /// Damping against its rate.
    #[serde(default)]
    pub damping_n_s_per_m: f64,
    /// Where the tool is: 0 at the first drive, 1 at the second.
    #[serde(default = "middle")]
    pub tool: f64,
}

fn whole() -> f64 {
    1.0
}

fn middle() -> f64 {
    0.5
}

/// A machine file and the axis files that it names.
#[derive(Clone, Debug)]
pub struct MachineFile {
    /// The file.
    pub text: MachineText,
    /// Its name.
    pub path: PathBuf,
    /// Axes of its coordinates: two or three.
    pub axes: Vec<Axis>,
    /// Second drives, as the file lists its gantries.
    pub seconds: Vec<Axis>,
}

/// A drive that a machine file names.
#[derive(Clone, Debug)]
pub struct FileDrive<'a> {
    /// Coordinate that it moves, from 0.
    pub axis: usize,
    /// Its axis file.
    pub file: PathBuf,
    /// The axis as that file has it.
    pub nominal: &'a Axis,
}

impl MachineAxes {
    /// The files of the coordinates, in their order.
    pub fn files(&self) -> Vec<&PathBuf> {
        [Some(&self.x), Some(&self.y), self.z.as_ref()]
            .into_iter()
            .flatten()
            .collect()
    }
}

impl MachineText {
    /// Reads the text of a machine file; `file` stands for it in messages.
    ///
    /// # Errors
    /// [`MachineFileError::Text`] and [`MachineFileError::Value`]: key, and what would be valid.
    pub fn parse(file: &Path, content: &str) -> Result<Self, MachineFileError> {
        let refuse = |what, valid| {
            Err(MachineFileError::Value {
                file: file.to_owned(),
                what,
                valid,
            })
        };
        let text: Self = toml::from_str(content).map_err(|error| MachineFileError::Text {
            file: file.to_owned(),
            what: toml_message(content, &error),
        })?;
        if text.schema != 1 {
            return refuse(format!("schema is {}", text.schema), "1");
        }
        let count = text.axes.files().len();
        let pairs = text.coupling.iter().flat_map(|c| [c.of, c.by]);
        let bases = text.base.iter().map(|b| b.axis);
        let others = bases.chain(text.gantry.iter().map(|g| g.axis));
        if pairs.chain(others).any(|name| name as usize >= count) {
            let what = "z is named, but [axes] has no z".to_owned();
            return refuse(what, "names of [axes]");
        }
        Ok(text)
    }
}

impl MachineFile {
    /// Reads a machine file and its axis files.
    ///
    /// # Errors
    /// [`MachineFileError`]: file, place and what would be valid.
    pub fn read(path: &Path) -> Result<Self, MachineFileError> {
        let file = path.to_owned();
        let content =
            axis_log::read_text(path, None).map_err(|source| MachineFileError::Unread {
                file: file.clone(),
                source,
            })?;
        let text = MachineText::parse(path, &content)?;
        let folder = path.parent().unwrap_or(Path::new("."));
        let read = |name: &PathBuf| Axis::read(&folder.join(name)).map_err(Box::new);
        let axes = text.axes.files().into_iter().map(read);
        let axes = axes.collect::<Result<Vec<_>, _>>()?;
        let seconds = text.gantry.iter().map(|gantry| read(&gantry.second));
        let seconds = seconds.collect::<Result<_, _>>()?;
        Self::of_parts(text, file, axes, seconds)
    }

    /// Of the text of a file, its name, the axes that it names and the second drives of its gantries, each in the text's order.
    ///
    /// # Errors
    /// [`MachineFileError::Value`] if there are not as many as the text names.
    pub fn of_parts(
        text: MachineText,
        path: PathBuf,
        axes: Vec<Axis>,
        seconds: Vec<Axis>,
    ) -> Result<Self, MachineFileError> {
        let named = (text.axes.files().len(), text.gantry.len());
        if (axes.len(), seconds.len()) != named {
            return Err(MachineFileError::Value {
                file: path,
                what: format!(
                    "{} axes and {} gantries are named, but {} and {} axes are there for them",
                    named.0,
                    named.1,
                    axes.len(),
                    seconds.len()
                ),
                valid: "one axis for each",
            });
        }
        Ok(Self {
            text,
            path,
            axes,
            seconds,
        })
    }

    /// Two axes with nothing between them, as if a file named them.
    pub fn of_axes(x: Axis, y: Axis) -> Self {
        let names = [&x, &y].map(|axis| axis.name.clone());
        let [first, second] = names.each_ref().map(PathBuf::from);
        Self {
            text: MachineText {
                schema: 1,
                name: format!("X {}, Y {}", names[0], names[1]),
                description: String::new(),
                axes: MachineAxes {
                    x: first,
                    y: second,
                    z: None,
                },
                coupling: Vec::new(),
                base: Vec::new(),
                gantry: Vec::new(),
            },
            path: PathBuf::from(names.join(", ")),
            axes: vec![x, y],
            seconds: Vec::new(),
        }
    }

    /// How many coordinates it has: 2 or 3.
    pub fn dimensions(&self) -> usize {
        self.axes.len()
    }

    /// Its drives in the order of [`CoupledMachine::drives`](crate::CoupledMachine::drives): of each coordinate that of `[axes]`, then
    /// the second of its gantry.
    pub fn drives(&self) -> Vec<FileDrive<'_>> {
        let firsts = self.text.axes.files();
        let mut drives = Vec::new();
        for (axis, nominal) in self.axes.iter().enumerate() {
            let second = self.text.gantry.iter().zip(&self.seconds);
            // Of two gantries of one axis the later one holds.
            let second = second.rev().find(|(g, _)| g.axis as usize == axis);
            drives.push((axis, firsts.get(axis).copied(), nominal));
            drives.extend(second.map(|(g, nominal)| (axis, Some(&g.second), nominal)));
        }
        let folder = self.path.parent().unwrap_or(Path::new("."));
        let drive = |(axis, file, nominal): (usize, Option<&PathBuf>, _)| FileDrive {
            axis,
            file: file.map_or_else(PathBuf::new, |file| folder.join(file)),
            nominal,
        };
        drives.into_iter().map(drive).collect()
    }

    /// What lies between its axes, SI units.
    ///
    /// # Errors
    /// [`MachineFileError::Machine`] for a value out of its range.
    pub fn coupling(&self) -> Result<Coupling, MachineFileError> {
        let pair = |text: &CouplingText| -> Result<AxisCoupling, MachineError> {
            let (of, by) = (text.of as usize, text.by as usize);
            let points = text.straightness_mm_um.iter();
            let points: Vec<_> = points.map(|[at, bow]| [1e-3 * at, 1e-6 * bow]).collect();
            Ok(AxisCoupling {
                of,
                by,
                squareness: 1e-6 * text.squareness_um_per_m,
                crosstalk: 1e-6 * text.crosstalk_um_per_m_per_s2,
                straightness: match points.is_empty() {
                    true => None,
                    false => Some(Straightness::new(by, points)?),
                },
            })
        };
        let pairs = self
            .text
            .coupling
            .iter()
            .map(pair)
            .collect::<Result<_, _>>();
        pairs.and_then(Coupling::new).map_err(|e| self.refused(e))
    }

    /// The machine. Of a file with more axes than `D` the first; `None` if it has fewer.
    ///
    /// # Errors
    /// [`MachineFileError::Machine`] for axes that do not go together, and values out of their ranges.
    pub fn machine<const D: usize>(&self) -> Result<Option<CoupledMachine<D>>, MachineFileError> {
        if self.axes.len() < D {
            return Ok(None);
        }
        let coupling = self.coupling()?;
        let made = CoupledMachine::new(std::array::from_fn(|axis| &self.axes[axis]));
        let mut machine = made.map_err(|e| self.refused(e))?.with_coupling(coupling);
        for base in &self.text.base {
            let mode = BaseMode {
                frequency: base.frequency_hz,
                damping: base.damping_ratio,
                mass_ratio: base.mass_ratio,
                at_tool: base.at_tool,
            };
            machine = machine
                .with_base(base.axis as usize, mode)
                .map_err(|e| self.refused(e))?;
        }
        for (gantry, second) in self.text.gantry.iter().zip(&self.seconds) {
            let beam = GantryBeam {
                stiffness: gantry.stiffness_n_per_m,
                damping: gantry.damping_n_s_per_m,
                tool: gantry.tool,
            };
            let made = machine.with_gantry(gantry.axis as usize, second, beam);
            machine = made.map_err(|e| self.refused(e))?;
        }
        Ok(Some(machine))
    }

    fn refused(&self, source: MachineError) -> MachineFileError {
        MachineFileError::Machine {
            file: self.path.clone(),
            source: Box::new(source),
        }
    }
}
