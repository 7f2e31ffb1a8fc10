//! A file as a table, by its extension.

use std::path::Path;

use crate::csv_table::CsvTable;
#[cfg(feature = "mat")]
use crate::mat_table::MatTable;
#[cfg(feature = "parquet")]
use crate::parquet_table::ParquetTable;
use crate::read_error::ReadProblem;
use crate::table::Table;
pub(crate) fn by_extension<'a>(
    path: &Path,
    bytes: &'a [u8],
) -> Result<Box<dyn Table + 'a>, ReadProblem> {
    let found = path.extension().unwrap_or_default().to_string_lossy();
    match found.to_ascii_lowercase().as_str() {
        "csv" | "tsv" | "txt" | "dat" | "asc" => Ok(Box::new(CsvTable::open(bytes)?)),
        #[cfg(feature = "parquet")]
        "parquet" => Ok(Box::new(ParquetTable::open(bytes.to_vec())?)),
        #[cfg(not(feature = "parquet"))]
        "parquet" => Err(ReadProblem::LeftOut {
            format: "Parquet",
            feature: "parquet",
        }),
        #[cfg(feature = "mat")]
        "mat" => Ok(Box::new(MatTable::open(bytes)?)),
        #[cfg(not(feature = "mat"))]
        "mat" => Err(ReadProblem::LeftOut {
            format: "MAT",
            feature: "mat",
        }),
        _ => Err(ReadProblem::Extension {
            found: found.into_owned(),
        }),
    }
}

/// What is in a file, a text as UTF-8.
pub(crate) fn whole(path: &Path) -> Result<Vec<u8>, ReadProblem> {
    let bytes = std::fs::read(path).map_err(|source| ReadProblem::Io {
        action: "read it",
        source,
    })?;
    Ok(crate::encoding::plain(bytes)?)
}
