//! Parquet as a table.

use std::panic::{AssertUnwindSafe, catch_unwind};

use bytes::Bytes;
use parquet::basic::{ConvertedType, LogicalType, Repetition, TimeUnit, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl, get_column_reader};
use parquet::data_type::DataType;
use parquet::errors::ParquetError;
use parquet::file::metadata::ColumnChunkMetaData;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

use crate::csv_text::MAX_COLUMNS;
use crate::parquet_pages::Pages;
use crate::read_error::{Place, ReadProblem};
use crate::table::{Budget, Fault, Head, Holes, Table};

const VALID: &str = "a flat column of float, double, int32 or int64";
/// Rows asked for at a time.
const BATCH: usize = 1 << 16;

pub(crate) struct ParquetTable {
    bytes: Bytes,
    reader: SerializedFileReader<Bytes>,
    heads: Vec<Head>,
}

impl ParquetTable {
    pub(crate) fn open(bytes: Vec<u8>) -> Result<Self, ReadProblem> {
        let bytes = Bytes::from(bytes);
        let reader = guarded(|| SerializedFileReader::new(bytes.clone()).map_err(refused))?;
        let schema = reader.metadata().file_metadata().schema_descr_ptr();
        if schema.num_columns() > MAX_COLUMNS {
            let found = schema.num_columns();
            let reason = format!("it has {found} columns, at most {MAX_COLUMNS} are read");
            return Err(ReadProblem::Parquet { reason });
        }
        let head = |column: &ColumnDescriptor| Head {
            name: column.path().string(),
            fault: fault(column),
            address: None,
            unit: time_unit(column).map(str::to_owned),
            stored: time_unit(column),
        };
        let heads = schema.columns().iter().map(|c| head(c)).collect();
        Ok(Self {
            bytes,
            reader,
            heads,
        })
    }

    /// Checks what the wanted columns claim to hold; their numbers of values.
    fn claims(&self, wanted: &[usize]) -> Result<Vec<usize>, ReadProblem> {
        let mut budget = Budget::of(self.bytes.len());
        let mut counts = Vec::with_capacity(wanted.len());
        for &index in wanted {
            let mut count = 0;
            for group in self.reader.metadata().row_groups() {
                let found = self.pages(group.columns().get(index));
                let found = found.and_then(Pages::claims);
                let found = found.map_err(|what| self.refused(index, &what))?;
                count += found.values;
                budget.aside(found.largest);
            }
            budget.keep(count);
            budget.check()?;
            // Within the budget, so it fits.
            counts.push(count as usize);
        }
        Ok(counts)
    }

    fn refused(&self, index: usize, what: &str) -> ReadProblem {
        ReadProblem::Parquet {
            reason: format!("column \"{}\": {what}", self.heads[index].name),
        }
    }

    /// The pages of a column in a row group.
    fn pages(&self, chunk: Option<&ColumnChunkMetaData>) -> Result<Pages, String> {
        let chunk = chunk.ok_or("it is missing in a row group")?;
        let start = chunk.dictionary_page_offset();
        let start = start.unwrap_or(chunk.data_page_offset());
        let at = |n: i64| usize::try_from(n).ok();
        let range = at(start)
            .zip(at(chunk.compressed_size()))
            .and_then(|(start, length)| Some(start..start.checked_add(length)?));
        let range = range.filter(|range| range.end <= self.bytes.len());
        let range = range.ok_or("its place is not in the file")?;
        let width = match chunk.column_type() {
            Type::FLOAT | Type::INT32 => 4,
            _ => 8,
        };
        let optional = chunk.column_descr().max_def_level() > 0;
        let bytes = self.bytes.slice(range);
        Ok(Pages::of(bytes, chunk.compression(), width, optional))
    }

    fn column(&self, index: usize, count: usize, holes: Holes) -> Result<Vec<f64>, ReadProblem> {
        let mut values = Vec::with_capacity(count);
        let descriptor = self
            .reader
            .metadata()
            .file_metadata()
            .schema_descr()
            .column(index);
        let unsigned = matches!(
            descriptor.converted_type(),
            ConvertedType::UINT_32 | ConvertedType::UINT_64
        );
        for group in self.reader.metadata().row_groups() {
            let pages = self.pages(group.columns().get(index));
            let pages = pages.map_err(|what| self.refused(index, &what))?;
            let first_null = match get_column_reader(descriptor.clone(), Box::new(pages)) {
                ColumnReader::DoubleColumnReader(r) => drain(r, &mut values, |v| v),
                ColumnReader::FloatColumnReader(r) => drain(r, &mut values, f64::from),
                ColumnReader::Int32ColumnReader(r) => drain(r, &mut values, |v| match unsigned {
                    true => f64::from(v.cast_unsigned()),
                    false => f64::from(v),
                }),
                // Exact up to 2^53: 104 days of nanoseconds.
                ColumnReader::Int64ColumnReader(r) => drain(r, &mut values, |v| match unsigned {
                    true => v.cast_unsigned() as f64,
                    false => v as f64,
                }),
                _ => return Err(self.unreadable_column(index)),
            }?;
            if let Some(row) = first_null.filter(|_| holes == Holes::Refused) {
                return Err(ReadProblem::MissingValue {
                    place: self.place(row, index),
                    name: self.heads[index].name.clone(),
                });
            }
        }
        Ok(values)
    }

    fn unreadable_column(&self, index: usize) -> ReadProblem {
        ReadProblem::Unreadable {
            name: self.heads[index].name.clone(),
            found: "of another type".to_owned(),
            valid: VALID,
        }
    }
}

impl Table for ParquetTable {
    fn heads(&self) -> &[Head] {
        &self.heads
    }

    fn looks_like(&self) -> String {
        "Parquet".to_owned()
    }

    fn read(&mut self, wanted: &[usize], holes: Holes) -> Result<Vec<Vec<f64>>, ReadProblem> {
        let counts = self.claims(wanted)?;
        let all = wanted.iter().zip(counts);
        let named = |index: usize, problem| match problem {
            ReadProblem::Parquet { reason } => ReadProblem::Parquet {
                reason: format!("column \"{}\": {reason}", self.heads[index].name),
            },
            other => other,
        };
        all.map(|(&index, count)| {
            guarded(|| self.column(index, count, holes)).map_err(|problem| named(index, problem))
        })
        .collect()
    }

    fn place(&self, row: usize, _: usize) -> Place {
        Place::Row { row: row + 1 }
    }
}

/// Pages are checked before they are decoded ([`Pages`]); should the decoder panic on something
/// else that is damaged all the same, the file is refused. Nothing that it was working on is used
/// afterwards. The process's own panic hook is left alone, and may print that panic.
fn guarded<T>(read: impl FnOnce() -> Result<T, ReadProblem>) -> Result<T, ReadProblem> {
    catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|_| {
        Err(ReadProblem::Parquet {
            reason: "it is damaged".to_owned(),
        })
    })
}

/// Appends what is left in the reader, NaN for each null. Answers the row, from 0 over the whole
/// file, of the first null.
fn drain<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    values: &mut Vec<f64>,
    number: impl Fn(T::T) -> f64,
) -> Result<Option<usize>, ReadProblem> {
    let (mut levels, mut batch) = (Vec::new(), Vec::new());
    let mut first_null = None;
    loop {
        levels.clear();
        batch.clear();
        let (rows, present, _) = reader
            .read_records(BATCH, Some(&mut levels), None, &mut batch)
            .map_err(refused)?;
        if rows == 0 {
            return Ok(first_null);
        }
        let mut numbers = batch.drain(..).map(&number);
        if present == rows {
            values.extend(numbers);
            continue;
        }
        // In a flat column the level is 1 for a value and 0 for a null.
        for &level in &levels {
            let value = if level > 0 { numbers.next() } else { None };
            if value.is_none() {
                first_null.get_or_insert(values.len());
            }
            values.push(value.unwrap_or(f64::NAN));
        }
    }
}

/// The unit of a column that is typed as a time stamp or as a time of day.
fn time_unit(column: &ColumnDescriptor) -> Option<&'static str> {
    let unit = match column.logical_type_ref() {
        Some(LogicalType::Timestamp(stamp)) => Some(stamp.unit),
        Some(LogicalType::Time(time)) => Some(time.unit),
        _ => None,
    };
    match (unit, column.converted_type()) {
        (Some(TimeUnit::MILLIS), _)
        | (None, ConvertedType::TIMESTAMP_MILLIS | ConvertedType::TIME_MILLIS) => Some("ms"),
        (Some(TimeUnit::MICROS), _)
        | (None, ConvertedType::TIMESTAMP_MICROS | ConvertedType::TIME_MICROS) => Some("us"),
        (Some(TimeUnit::NANOS), _) => Some("ns"),
        _ => None,
    }
}

fn fault(column: &ColumnDescriptor) -> Option<Fault> {
    let flat = column.path().parts().len() == 1
        && column.self_type().get_basic_info().repetition() != Repetition::REPEATED;
    let number = matches!(
        column.physical_type(),
        Type::DOUBLE | Type::FLOAT | Type::INT32 | Type::INT64
    );
    // Their integers do not stand for themselves.
    let coded = column.converted_type() == ConvertedType::DECIMAL;
    let found = match (flat, number, coded) {
        (false, _, _) => "nested or repeated".to_owned(),
        (_, false, _) => format!("of type {}", column.physical_type()),
        (_, _, true) => format!("of type {}", column.converted_type()),
        _ => return None,
    };
    Some(Fault {
        found,
        valid: VALID,
    })
}

#[allow(clippy::needless_pass_by_value)] // as `map_err` wants it
fn refused(error: ParquetError) -> ReadProblem {
    ReadProblem::Parquet {
        reason: error.to_string(),
    }
}
