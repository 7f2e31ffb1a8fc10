//! What a unit of a machine is made of: its file, and the axis files that it names.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use axis_machine::{CoupledMachine, MachineFile, MachineFileError, MachineNumber, MachineText};
use axis_sim::Axis;
use toml_edit::{DocumentMut, Item, TableLike, Value};

use crate::digest::digest;
use crate::error::UnitError;
use crate::given::Inputs;
use crate::kind::UnitKind;
use crate::machine_run::MachineRun;
use crate::outputs::Source;
use crate::parameters::{self, Changed, Place};
use crate::simulated::Simulated;
use crate::subject::{MACHINE_FILE, Resource, Subject};
use crate::variables::{DriveFile, Variables};

/// A machine file whose axis files lie beside it.
#[derive(Debug)]
pub(crate) struct Machine {
    /// The file, with the names that the axis files have among the resources.
    text: String,
    file: MachineFile,
    /// Of the axes, then of the second drives of gantries.
    files: Vec<AxisFile>,
    drives: Vec<Drive>,
    axes: Vec<Axis>,
    period: f64,
    numbers: Vec<MachineNumber>,
}

#[derive(Debug)]
struct AxisFile {
    /// Among the resources.
    resource: String,
    /// Stands for it in messages.
    name: String,
    text: String,
}

/// A drive of the machine.
#[derive(Debug)]
struct Drive {
    /// Its axis' letter and a dot; of a second one more word.
    prefix: String,
    /// Its axis file, from 0.
    file: usize,
    /// Whether it follows another one of its axis.
    is_second: bool,
    /// Which axis it moves, from 0.
    axis: usize,
}

/// The letters of axes.
const LETTERS: [&str; 3] = ["x", "y", "z"];

impl Machine {
    /// Reads a machine file and the axis files that it names.
    pub fn read(path: &Path) -> Result<Self, UnitError> {
        let content = text_of(path)?;
        let mut text = MachineText::parse(path, &content)?;
        let mut document =
            (content.parse::<DocumentMut>()).map_err(|error| UnitError::Text(error.to_string()))?;
        let folder = path.parent().unwrap_or(Path::new("."));
        let mut files = Vec::new();
        let mut take = |named: &mut PathBuf, resource: String| -> Result<Axis, UnitError> {
            let file = folder.join(&*named);
            let axis = Axis::read(&file)?;
            let text = text_of(&file)?;
            *named = PathBuf::from(&resource);
            let name = file.display().to_string();
            files.push(AxisFile {
                resource,
                name,
                text,
            });
            Ok(axis)
        };
        let (mut axes, mut seconds) = (Vec::new(), Vec::new());
        let named = [
            Some(&mut text.axes.x),
            Some(&mut text.axes.y),
            text.axes.z.as_mut(),
        ];
        for (named, letter) in named.into_iter().zip(LETTERS) {
            if let Some(named) = named {
                let resource = format!("{letter}.toml");
                rename(document.get_mut("axes"), letter, &resource);
                axes.push(take(named, resource)?);
            }
        }
        for (i, gantry) in text.gantry.iter_mut().enumerate() {
            let resource = format!("gantry-{}.toml", i + 1);
            rename_in_array(&mut document, i, &resource);
            seconds.push(take(&mut gantry.second, resource)?);
        }
        let text_of_file = document.to_string();
        let file = MachineFile::of_parts(text, path.to_owned(), axes, seconds)?;
        Self::of(file, text_of_file, files)
    }

    fn of(file: MachineFile, text: String, files: Vec<AxisFile>) -> Result<Self, UnitError> {
        let mut drives = Vec::new();
        for (axis, letter) in LETTERS.iter().enumerate().take(file.dimensions()) {
            drives.push(Drive {
                prefix: format!("{letter}."),
                file: axis,
                is_second: false,
                axis,
            });
            // Of two gantries of one axis the later one holds.
            let second = file
                .text
                .gantry
                .iter()
                .rposition(|g| g.axis as usize == axis);
            drives.extend(second.map(|i| Drive {
                prefix: format!("{letter}.second."),
                file: file.dimensions() + i,
                is_second: true,
                axis,
            }));
        }
        let axes = file.drives().iter().map(|d| d.nominal.clone()).collect();
        let period = match file.dimensions() {
            3 => made::<3>(&file)?.period(),
            _ => made::<2>(&file)?.period(),
        };
        Ok(Self {
            numbers: file.numbers(period),
            axes,
            drives,
            files,
            file,
            text,
            period,
        })
    }

    /// The machine with other numbers.
    fn changed(&self, changed: &[Changed<'_>]) -> Result<MachineFile, UnitError> {
        let mut numbers: Vec<f64> = self.numbers.iter().map(|number| number.value).collect();
        for (place, value) in changed {
            if let Place::Machine(i) = place
                && let Some(number) = numbers.get_mut(*i)
            {
                *number = *value;
            }
        }
        let mut file = self.file.with_numbers(&numbers);
        let dimensions = file.dimensions();
        for (d, drive) in self.drives.iter().enumerate() {
            let own: Vec<Changed<'_>> = changed
                .iter()
                .filter(|(place, _)| matches!(place, Place::Drive { drive, .. } if *drive == d))
                .copied()
                .collect();
            let AxisFile { name, text, .. } = &self.files[drive.file];
            let axis = match drive.is_second {
                false => &mut file.axes[drive.file],
                true => &mut file.seconds[drive.file - dimensions],
            };
            *axis = parameters::changed(axis, name, text, &own)?.into_owned();
        }
        Ok(file)
    }
}

impl Subject for Machine {
    fn name(&self) -> &str {
        &self.file.text.name
    }

    fn description(&self) -> String {
        format!(
            "{} ({})",
            self.file.text.description,
            UnitKind::Machine.words()
        )
    }

    fn fingerprint(&self) -> String {
        let texts: Vec<&str> = self.resources().into_iter().map(|(_, text)| text).collect();
        format!("{:016x}", digest(texts.join("\0").as_bytes()))
    }

    fn mark(&self) -> String {
        UnitKind::Machine.mark(0)
    }

    fn axes(&self) -> &[Axis] {
        &self.axes
    }

    fn period(&self) -> f64 {
        self.period
    }

    fn resources(&self) -> Vec<Resource<'_>> {
        let own = (MACHINE_FILE.to_owned(), &*self.text);
        let files = self.files.iter().map(|f| (f.resource.clone(), &*f.text));
        std::iter::once(own).chain(files).collect()
    }

    fn variables(&self) -> Result<Variables, UnitError> {
        let kind = UnitKind::Machine;
        let files: Vec<DriveFile<'_>> = (self.drives.iter().zip(&self.axes).enumerate())
            .map(|(d, (drive, axis))| DriveFile {
                prefix: &drive.prefix,
                drive: d,
                axis,
                name: &self.files[drive.file].name,
                text: &self.files[drive.file].text,
            })
            .collect();
        let mut all = Variables::begin();
        for (drive, file) in self.drives.iter().zip(&files) {
            if !drive.is_second {
                all.push_inputs(kind, &drive.prefix, drive.axis, file.axis);
            }
        }
        for file in &files {
            all.push_outputs(kind, file);
        }
        for (axis, letter) in LETTERS.iter().enumerate().take(self.file.dimensions()) {
            let (name, meaning) = (format!("tool.{letter}_m"), "position of the tool");
            all.push_output(&name, meaning, "m", (Source::Tool, axis));
        }
        for file in &files {
            all.push_parameters(kind, file)?;
        }
        for (place, number) in self.numbers.iter().enumerate() {
            all.push_number(place, number);
        }
        all.push_exact();
        Ok(all)
    }

    fn begin(
        &self,
        changed: &[Changed<'_>],
        given: &Inputs,
        _: bool,
    ) -> Result<Simulated, UnitError> {
        let file = self.changed(changed)?;
        Ok(match file.dimensions() {
            3 => Simulated(Box::new(MachineRun::begin(made::<3>(&file)?, given)?)),
            _ => Simulated(Box::new(MachineRun::begin(made::<2>(&file)?, given)?)),
        })
    }
}

/// The machine of a file of so many axes.
fn made<const D: usize>(file: &MachineFile) -> Result<Arc<CoupledMachine<D>>, UnitError> {
    let machine = file.machine::<D>()?;
    let few = || UnitError::Text(format!("it has {} axes; valid: {D}", file.dimensions()));
    machine.map(Arc::new).ok_or_else(few)
}

fn text_of(path: &Path) -> Result<String, UnitError> {
    axis_log::read_text(path, None).map_err(|source| {
        UnitError::MachineFile(Box::new(MachineFileError::Unread {
            file: path.to_owned(),
            source,
        }))
    })
}

/// Another file in a table of the document.
fn rename(table: Option<&mut Item>, key: &str, file: &str) {
    if let Some(table) = table.and_then(Item::as_table_like_mut) {
        set(table, key, file);
    }
}

/// Another second file in the `i`th table of `[[gantry]]`, however it is written.
fn rename_in_array(document: &mut DocumentMut, i: usize, file: &str) {
    match document.get_mut("gantry") {
        Some(Item::ArrayOfTables(tables)) => {
            if let Some(table) = tables.get_mut(i) {
                set(table, "second", file);
            }
        }
        Some(Item::Value(Value::Array(values))) => {
            let table = values.get_mut(i).and_then(Value::as_inline_table_mut);
            if let Some(table) = table {
                set(table, "second", file);
            }
        }
        _ => {}
    }
}

fn set(table: &mut dyn TableLike, key: &str, file: &str) {
    if let Some(item) = table.get_mut(key) {
        *item = Item::Value(Value::from(file));
    }
}
