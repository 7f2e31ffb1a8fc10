//! Small Parquet files for the tests.

pub mod by_hand;

use std::fs::File;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::Compression;
use parquet::data_type::{BoolType, DoubleType, FloatType, Int32Type, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::parser::parse_message_type;

#[derive(Clone)]
pub struct Column {
    name: &'static str,
    values: Values,
}

#[derive(Clone)]
pub enum Values {
    Double(Vec<f64>),
    OptionalDouble(Vec<Option<f64>>),
    Float(Vec<f32>),
    Int32(Vec<i32>),
    Int64(Vec<i64>),
    Boolean(Vec<bool>),
}

impl Column {
    pub fn new(name: &'static str, values: Values) -> Self {
        Self { name, values }
    }

    fn len(&self) -> usize {
        match &self.values {
            Values::Double(v) => v.len(),
            Values::OptionalDouble(v) => v.len(),
            Values::Float(v) => v.len(),
            Values::Int32(v) => v.len(),
            Values::Int64(v) => v.len(),
            Values::Boolean(v) => v.len(),
        }
    }

    fn field(&self) -> String {
        let kind = match &self.values {
            Values::Double(_) => "REQUIRED DOUBLE",
            Values::OptionalDouble(_) => "OPTIONAL DOUBLE",
            Values::Float(_) => "REQUIRED FLOAT",
            Values::Int32(_) => "REQUIRED INT32",
            Values::Int64(_) => "REQUIRED INT64",
            Values::Boolean(_) => "REQUIRED BOOLEAN",
        };
        format!("{kind} {};", self.name)
    }

    fn write(&self, rows: std::ops::Range<usize>, to: &mut SerializedColumnWriter<'_>) {
        let written = match &self.values {
            Values::Double(v) => to.typed::<DoubleType>().write_batch(&v[rows], None, None),
            Values::Float(v) => to.typed::<FloatType>().write_batch(&v[rows], None, None),
            Values::Int32(v) => to.typed::<Int32Type>().write_batch(&v[rows], None, None),
            Values::Int64(v) => to.typed::<Int64Type>().write_batch(&v[rows], None, None),
            Values::Boolean(v) => to.typed::<BoolType>().write_batch(&v[rows], None, None),
            Values::OptionalDouble(v) => {
                let levels: Vec<i16> = v[rows.clone()].iter().map(|v| v.is_some().into()).collect();
                let present: Vec<f64> = v[rows].iter().flatten().copied().collect();
                to.typed::<DoubleType>()
                    .write_batch(&present, Some(&levels), None)
            }
        };
        written.unwrap();
    }
}

/// Writes the columns in that many row groups, compressed with Snappy.
pub fn write(path: &Path, columns: &[Column], groups: usize) {
    let fields: String = columns.iter().map(Column::field).collect();
    let schema = parse_message_type(&format!("message log {{ {fields} }}")).unwrap();
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .build();
    let file = File::create(path).unwrap();
    let mut writer = SerializedFileWriter::new(file, Arc::new(schema), properties.into()).unwrap();
    let rows = columns[0].len();
    let edge = |group: usize| group * rows / groups;
    for group in 0..groups {
        let mut to = writer.next_row_group().unwrap();
        for column in columns {
            let mut one = to.next_column().unwrap().unwrap();
            column.write(edge(group)..edge(group + 1), &mut one);
            one.close().unwrap();
        }
        to.close().unwrap();
    }
    writer.close().unwrap();
}
