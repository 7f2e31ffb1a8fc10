//! Parquet as a table.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

use bytes::Bytes;
use parquet::basic::{ConvertedType, Repetition, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::ParquetError;
use parquet::file::metadata::ColumnChunkMetaData;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

use crate::csv_text::MAX_COLUMNS;
use crate::parquet_pages::pages;
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
            unit: None,
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
                let found = self.claim(group.columns().get(index));
                let found = found.map_err(|what| ReadProblem::Parquet {
                    reason: format!("column \"{}\": {what}", self.heads[index].name),
                })?;
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

    fn claim(
        &self,
        chunk: Option<&ColumnChunkMetaData>,
    ) -> Result<crate::parquet_pages::Pages, String> {
        let chunk = chunk.ok_or("it is missing in a row group")?;
        let start = chunk.dictionary_page_offset();
        let start = start.unwrap_or(chunk.data_page_offset());
        let at = |n: i64| usize::try_from(n).ok();
        let range = at(start)
            .zip(at(chunk.compressed_size()))
            .and_then(|(start, length)| Some(start..start.checked_add(length)?));
        let bytes = range.and_then(|range| self.bytes.get(range));
        let bytes = bytes.ok_or("its place is not in the file")?;
        let width = match chunk.column_type() {
            Type::FLOAT | Type::INT32 => 4,
            _ => 8,
        };
        pages(bytes, width)
    }

    fn column(&self, index: usize, count: usize) -> Result<Vec<f64>, ReadProblem> {
        let mut values = Vec::with_capacity(count);
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

    fn read(&mut self, wanted: &[usize], _: Holes) -> Result<Vec<Vec<f64>>, ReadProblem> {
        let counts = self.claims(wanted)?;
        let all = wanted.iter().zip(counts);
        let named = |index: usize, problem| match problem {
            ReadProblem::Parquet { reason } => ReadProblem::Parquet {
                reason: format!("column \"{}\": {reason}", self.heads[index].name),
            },
            other => other,
        };
        all.map(|(&index, count)| {
            guarded(|| self.column(index, count)).map_err(|problem| named(index, problem))
        })
        .collect()
    }

    fn place(&self, row: usize, _: usize) -> Place {
        Place::Row { row: row + 1 }
    }
}

/// The decoder may panic on a damaged page (an index beyond the dictionary), which
/// cannot be seen without decoding it. Nothing that it was working on is used
/// afterwards, and what the process does with its other panics stays as it is.
fn guarded<T>(read: impl FnOnce() -> Result<T, ReadProblem>) -> Result<T, ReadProblem> {
    thread_local!(static QUIET: Cell<bool> = const { Cell::new(false) });
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let others = take_hook();
        set_hook(Box::new(move |panic| {
            if !QUIET.get() {
                others(panic);
            }
        }));
    });
    QUIET.set(true);
    let result = catch_unwind(AssertUnwindSafe(read));
    QUIET.set(false);
    result.unwrap_or_else(|_| {
        Err(ReadProblem::Parquet {
            reason: "it is damaged".to_owned(),
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
