//! The file of a shard: rows in Parquet, with what they were made from.

use std::fs::File;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::basic::Compression;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use serde::{Deserialize, Serialize};

use crate::column_io::{read_cases, read_column, schema, write_group};
use crate::{CampaignError, Column, Inputs, Row, Shard, hashed_file};

/// Key of the metadata that hold the label.
const LABEL: &str = "campaign";

/// What a file says of itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Label {
    pub(crate) job: String,
    pub(crate) inputs: Inputs,
    pub(crate) shard: Shard,
    /// Cases of the whole job.
    pub(crate) cases: usize,
    /// Instruction set of the processor that made it.
    pub(crate) processor: String,
}

/// Writes a shard to `path`, whole or not at all: the rows that `groups` gives, a row group
/// each, to the file `aside` in the same folder, which is then renamed. Only who has locked
/// the shard's journal may do so.
pub(crate) fn write(
    [path, aside]: [&Path; 2],
    label: &Label,
    columns: &[Column],
    mut groups: impl FnMut() -> Result<Option<Vec<Row>>, CampaignError>,
) -> Result<(), CampaignError> {
    let io = |action| CampaignError::io(action, aside);
    let mut options = File::options();
    let options = options.read(true).write(true).create(true).truncate(true);
    let mut file = options.open(aside).map_err(io("create"))?;
    let written = |e: ParquetError| CampaignError::io("write", aside)(std::io::Error::other(e));
    let mut writer = SerializedFileWriter::new(
        &mut file,
        Arc::new(parse_message_type(&schema(columns)).map_err(written)?),
        Arc::new(properties(label)?),
    )
    .map_err(written)?;
    let mut first = label.shard.range(label.cases).start;
    while let Some(rows) = groups()? {
        write_group(&mut writer, columns, first, &rows).map_err(written)?;
        first += rows.len();
    }
    writer.close().map_err(written)?;
    hashed_file::seal(&mut file).map_err(io("write"))?;
    file.sync_all().map_err(io("write"))?;
    std::fs::rename(aside, path).map_err(CampaignError::io("put in place", path))?;
    // The name too is to outlive a loss of power, where folders can be flushed.
    let _ = path.parent().map(|folder| File::open(folder)?.sync_all());
    Ok(())
}

fn properties(label: &Label) -> Result<WriterProperties, CampaignError> {
    let json =
        serde_json::to_string(label).map_err(|e| CampaignError::refused(Path::new(""), e))?;
    let pair = |key: &str, value| KeyValue::new(key.to_owned(), Some(value));
    let metadata = vec![
        pair(LABEL, json),
        pair(hashed_file::KEY, hashed_file::blank()),
    ];
    Ok(WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_dictionary_enabled(false)
        .set_statistics_enabled(EnabledStatistics::None)
        .set_key_value_metadata(Some(metadata))
        .build())
}

/// A shard that was found whole.
pub(crate) struct ShardFile {
    path: PathBuf,
    reader: SerializedFileReader<File>,
    pub(crate) label: Label,
}

impl ShardFile {
    /// Opens a file after its hash was checked; `None` if there is none.
    pub(crate) fn open_checked(path: &Path) -> Result<Option<Self>, CampaignError> {
        let mut file = match File::open(path) {
            Ok(file) => file,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(e) => return Err(CampaignError::io("read", path)(e)),
        };
        let whole = hashed_file::is_whole(&mut file).map_err(CampaignError::io("read", path))?;
        if !whole {
            let what = "its checksum does not match (truncated or changed)";
            return Err(CampaignError::refused(path, what));
        }
        Self::open(path).map(Some)
    }

    /// Opens a file whose hash was checked before.
    pub(crate) fn open(path: &Path) -> Result<Self, CampaignError> {
        let file = File::open(path).map_err(CampaignError::io("read", path))?;
        let refused = |what: &dyn ToString| CampaignError::refused(path, what.to_string());
        let reader = SerializedFileReader::new(file).map_err(|e| refused(&e))?;
        let metadata = reader.metadata().file_metadata().key_value_metadata();
        let label = metadata.into_iter().flatten().find(|m| m.key == LABEL);
        let json = label.and_then(|m| m.value.as_deref());
        let json = json.ok_or_else(|| refused(&"it does not say what made it"))?;
        let label = serde_json::from_str(json).map_err(|e| refused(&e))?;
        Ok(Self {
            path: path.to_owned(),
            reader,
            label,
        })
    }

    /// Number of row groups.
    pub(crate) fn groups(&self) -> usize {
        self.reader.num_row_groups()
    }

    /// Checks columns, number of rows and numbers of cases, for a shard of these cases.
    pub(crate) fn check(
        &self,
        columns: &[Column],
        cases: Range<usize>,
    ) -> Result<(), CampaignError> {
        let refused = |what: String| Err(CampaignError::refused(&self.path, what));
        let found = self.reader.metadata().file_metadata().schema_descr();
        let wanted = parse_message_type(&schema(columns));
        if wanted.is_ok_and(|wanted| *found.root_schema() != wanted) {
            return refused("it has other columns than the job".to_owned());
        }
        let rows: i64 = self
            .reader
            .metadata()
            .row_groups()
            .iter()
            .map(|g| g.num_rows())
            .sum();
        if rows != cases.len() as i64 {
            return refused(format!("it has {rows} rows, not {}", cases.len()));
        }
        let mut next = cases.start as i64;
        for group in 0..self.groups() {
            let found = self
                .cases(group)
                .map_err(|e| CampaignError::refused(&self.path, e))?;
            for case in found {
                if case != next {
                    return refused(format!("case {case} stands where case {next} should"));
                }
                next += 1;
            }
        }
        Ok(())
    }

    fn cases(&self, group: usize) -> Result<Vec<i64>, ParquetError> {
        let group = self.reader.get_row_group(group)?;
        read_cases(
            group.get_column_reader(0)?,
            group.metadata().num_rows() as usize,
        )
    }

    /// Number of rows of a row group.
    pub(crate) fn len(&self, group: usize) -> usize {
        self.reader.metadata().row_group(group).num_rows() as usize
    }

    /// The rows of a row group.
    pub(crate) fn rows(&self, group: usize, columns: usize) -> Result<Vec<Row>, CampaignError> {
        let read = || -> Result<Vec<Row>, ParquetError> {
            let reader = self.reader.get_row_group(group)?;
            let mut rows = vec![Row::with_capacity(columns); self.len(group)];
            for index in 0..columns {
                let values = read_column(reader.get_column_reader(index + 1)?, rows.len())?;
                for (row, value) in rows.iter_mut().zip(values) {
                    row.push(value);
                }
            }
            Ok(rows)
        };
        read().map_err(|e| CampaignError::refused(&self.path, e))
    }
}
