//! One column of a row group, in and out.

use std::fs::File;

use parquet::column::reader::ColumnReader;
use parquet::column::writer::ColumnWriter;
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::{ParquetError, Result};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};

use crate::{Column, Kind, Row, Value};

/// The column that stands before those of the job: number of the case, from 0.
pub(crate) const CASE: &str = "case";

/// The schema in Parquet's notation.
pub(crate) fn schema(columns: &[Column]) -> String {
    let field = |column: &Column| match column.kind {
        Kind::Number => format!("REQUIRED DOUBLE {};", column.name),
        Kind::Text => format!("REQUIRED BYTE_ARRAY {} (STRING);", column.name),
    };
    let fields: String = columns.iter().map(field).collect();
    format!("message rows {{ REQUIRED INT64 {CASE}; {fields} }}")
}

/// Writes rows as one row group; the first is of the case `first`.
pub(crate) fn write_group(
    to: &mut SerializedFileWriter<&mut File>,
    columns: &[Column],
    first: usize,
    rows: &[Row],
) -> Result<()> {
    let mut group = to.next_row_group()?;
    let cases: Vec<i64> = (first..first + rows.len()).map(|i| i as i64).collect();
    next(&mut group, |writer| {
        if let ColumnWriter::Int64ColumnWriter(writer) = writer {
            writer.write_batch(&cases, None, None)?;
        }
        Ok(())
    })?;
    for index in 0..columns.len() {
        next(&mut group, |writer| write_column(writer, index, rows))?;
    }
    group.close()?;
    Ok(())
}

fn next(
    group: &mut SerializedRowGroupWriter<'_, &mut File>,
    write: impl FnOnce(&mut ColumnWriter<'_>) -> Result<()>,
) -> Result<()> {
    let mut column = group
        .next_column()?
        .ok_or_else(|| ParquetError::General("a column too many".to_owned()))?;
    write(column.untyped())?;
    column.close()
}

fn write_column(writer: &mut ColumnWriter<'_>, index: usize, rows: &[Row]) -> Result<()> {
    let values = rows.iter().map(|row| &row[index]);
    match writer {
        ColumnWriter::DoubleColumnWriter(writer) => {
            let numbers = values.filter_map(|v| v.number().ok());
            let numbers: Vec<f64> = numbers.collect();
            writer.write_batch(&numbers, None, None)?;
        }
        ColumnWriter::ByteArrayColumnWriter(writer) => {
            let texts = values.filter_map(|v| v.text().ok());
            let texts: Vec<ByteArray> = texts.map(ByteArray::from).collect();
            writer.write_batch(&texts, None, None)?;
        }
        _ => return Err(ParquetError::General("a column of another type".to_owned())),
    }
    Ok(())
}

/// The values of a column of a row group of `rows` rows.
pub(crate) fn read_column(reader: ColumnReader, rows: usize) -> Result<Vec<Value>> {
    Ok(match reader {
        ColumnReader::DoubleColumnReader(reader) => {
            let numbers = drain::<DoubleType>(reader, rows)?;
            numbers.into_iter().map(Value::Number).collect()
        }
        ColumnReader::ByteArrayColumnReader(reader) => drain::<ByteArrayType>(reader, rows)?
            .iter()
            .map(|text| Ok(Value::Text(text.as_utf8()?.to_owned())))
            .collect::<Result<_>>()?,
        _ => return Err(ParquetError::General("a column of another type".to_owned())),
    })
}

/// The numbers of the cases of a row group of `rows` rows.
pub(crate) fn read_cases(reader: ColumnReader, rows: usize) -> Result<Vec<i64>> {
    match reader {
        ColumnReader::Int64ColumnReader(reader) => drain::<Int64Type>(reader, rows),
        _ => Err(ParquetError::General("no number of the case".to_owned())),
    }
}

fn drain<T: parquet::data_type::DataType>(
    mut reader: parquet::column::reader::ColumnReaderImpl<T>,
    rows: usize,
) -> Result<Vec<T::T>> {
    let mut values = Vec::new();
    while values.len() < rows {
        let (read, _, _) = reader.read_records(rows - values.len(), None, None, &mut values)?;
        if read == 0 {
            break;
        }
    }
    Ok(values)
}
