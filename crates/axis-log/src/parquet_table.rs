//! Parquet as a table.

use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};

use parquet::basic::{ConvertedType, Repetition, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

use crate::read_error::{Place, ReadProblem};
use crate::table::{Fault, Head, Table};

const VALID: &str = "a flat column of float, double, int32 or int64";
/// Rows asked for at a time, so that a false row count allocates nothing large.
const BATCH: usize = 1 << 16;

pub(crate) struct ParquetTable {
    reader: SerializedFileReader<File>,
    heads: Vec<Head>,
}

impl ParquetTable {
    pub(crate) fn open(file: File) -> Result<Self, ReadProblem> {
        let reader = guarded(|| SerializedFileReader::new(file).map_err(refused))?;
        let schema = reader.metadata().file_metadata().schema_descr_ptr();
        let head = |column: &ColumnDescriptor| Head {
            name: column.path().string(),
            fault: fault(column),
        };
        let heads = schema.columns().iter().map(|c| head(c)).collect();
        Ok(Self { reader, heads })
    }

    fn column(&self, index: usize) -> Result<Vec<f64>, ReadProblem> {
        let mut values = Vec::new();
        for group in 0..self.reader.num_row_groups() {
            let group = self.reader.get_row_group(group).map_err(refused)?;
            let column = group.get_column_reader(index).map_err(refused)?;
            let first_null = match column {
                ColumnReader::DoubleColumnReader(r) => drain(r, &mut values, |v| v),
                ColumnReader::FloatColumnReader(r) => drain(r, &mut values, f64::from),
                ColumnReader::Int32ColumnReader(r) => drain(r, &mut values, f64::from),
                // Exact up to 2^53: 104 days of nanoseconds.
                ColumnReader::Int64ColumnReader(r) => drain(r, &mut values, |v| v as f64),
                _ => return Err(self.unreadable_column(index)),
            }?;
            if let Some(row) = first_null {
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

    fn read(&mut self, wanted: &[usize]) -> Result<Vec<Vec<f64>>, ReadProblem> {
        let all = wanted.iter();
        all.map(|&index| guarded(|| self.column(index))).collect()
    }

    fn place(&self, row: usize, _: usize) -> Place {
        Place::Row { row: row + 1 }
    }
}

/// The decoder may panic on a damaged page (of values by a dictionary that the
/// column does not have). Nothing that it was working on is used afterwards.
fn guarded<T>(read: impl FnOnce() -> Result<T, ReadProblem>) -> Result<T, ReadProblem> {
    catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|_| {
        Err(ReadProblem::Parquet {
            reason: "a page of it is damaged".to_owned(),
        })
    })
}

/// Appends what is left in the reader. Answers the row, from 0 over the whole
/// file, of the first null, and stops there.
fn drain<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    values: &mut Vec<f64>,
    number: impl Fn(T::T) -> f64,
) -> Result<Option<usize>, ReadProblem> {
    let (mut levels, mut batch) = (Vec::new(), Vec::new());
    loop {
        levels.clear();
        batch.clear();
        let (rows, present, _) = reader
            .read_records(BATCH, Some(&mut levels), None, &mut batch)
            .map_err(refused)?;
        if present < rows {
            // In a flat column the level is 1 for a value and 0 for a null.
            let null = levels.iter().position(|&level| level == 0);
            return Ok(Some(values.len() + null.unwrap_or(present)));
        }
        if rows == 0 {
            return Ok(None);
        }
        values.extend(batch.drain(..).map(&number));
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
    let coded = matches!(
        column.converted_type(),
        ConvertedType::DECIMAL | ConvertedType::UINT_32 | ConvertedType::UINT_64
    );
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
