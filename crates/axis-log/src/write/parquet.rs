//! Log to Parquet.

use std::io::{self, Write};
use std::sync::Arc;

use parquet::basic::{Compression, Repetition, Type as Physical};
use parquet::data_type::DoubleType;
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use super::columns::Columns;
use super::{LAYOUT, LogSink, arrow_schema, in_a_line, invalid};
use crate::log::Log;

/// Instants of a row group.
const GROUP: usize = 1 << 16;

/// A Parquet file that grows by row groups.
pub(super) struct ParquetSink<W: Write + Send> {
    state: State<W>,
    columns: Columns,
}

/// The schema is the first block's.
enum State<W: Write + Send> {
    Begun(Option<W>),
    Open(SerializedFileWriter<W>),
}

impl<W: Write + Send> ParquetSink<W> {
    pub(super) fn new(writer: W) -> Self {
        Self {
            state: State::Begun(Some(writer)),
            columns: Columns::default(),
        }
    }

    fn open(&mut self) -> Result<()> {
        if let State::Begun(writer) = &mut self.state
            && let Some(writer) = writer.take()
        {
            let (schema, properties) = (schema(&self.columns)?, properties(&self.columns));
            let open = SerializedFileWriter::new(writer, schema, properties)?;
            self.state = State::Open(open);
        }
        Ok(())
    }

    /// Writes the first `rows` that are held.
    fn group(&mut self, rows: usize) -> Result<()> {
        let State::Open(file) = &mut self.state else {
            return Err(ParquetError::General("nothing was begun".to_owned()));
        };
        let mut group = file.next_row_group()?;
        for (.., samples) in &mut self.columns.all {
            let mut column = group
                .next_column()?
                .ok_or_else(|| ParquetError::General("a column too many".to_owned()))?;
            let to = column.typed::<DoubleType>();
            to.write_batch(&samples[..rows], None, None)?;
            column.close()?;
            samples.drain(..rows);
        }
        group.close().map(drop)
    }

    fn end(mut self) -> Result<W> {
        if self.columns.len() > 0 {
            self.group(self.columns.len())?;
        }
        match self.state {
            State::Open(file) => file.into_inner(),
            State::Begun(_) => Err(ParquetError::General("nothing was begun".to_owned())),
        }
    }
}

impl<W: Write + Send> LogSink for ParquetSink<W> {
    type End = W;

    fn write(&mut self, block: &Log) -> io::Result<()> {
        if self.columns.push(block)? {
            self.open().map_err(failed)?;
        }
        while self.columns.len() >= GROUP {
            self.group(GROUP).map_err(failed)?;
        }
        Ok(())
    }

    fn note(&mut self, name: &str, text: &str) -> io::Result<()> {
        let State::Open(file) = &mut self.state else {
            return Err(invalid("no instants: a log has at least one"));
        };
        file.append_key_value_metadata(KeyValue::new(name.to_owned(), Some(in_a_line(text))));
        Ok(())
    }

    fn finish(self: Box<Self>) -> io::Result<W> {
        self.columns.check()?;
        self.end().map_err(failed)
    }
}

/// What the disk says is kept as it is.
fn failed(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(error) => match error.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    }
}

fn schema(columns: &Columns) -> Result<Arc<Type>> {
    let field = |(name, ..): &(String, String, Vec<f64>)| {
        let of = Type::primitive_type_builder(name, Physical::DOUBLE);
        of.with_repetition(Repetition::REQUIRED)
            .build()
            .map(Arc::new)
    };
    let fields = columns.all.iter().map(field).collect::<Result<Vec<_>>>()?;
    let log = Type::group_type_builder("log").with_fields(fields);
    log.build().map(Arc::new)
}

fn properties(columns: &Columns) -> Arc<WriterProperties> {
    let fields = columns.all.iter();
    let fields = fields.map(|(name, unit, _)| (name.as_str(), unit.as_str()));
    let pair = |key: &str, value| KeyValue::new(key.to_owned(), Some(value));
    let metadata = vec![
        pair("axis-log", LAYOUT.to_string()),
        pair(arrow_schema::KEY, arrow_schema::encoded(fields)),
    ];
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_dictionary_enabled(false)
        .set_key_value_metadata(Some(metadata));
    Arc::new(properties.build())
}
