//! One test program: reading, importing and writing logs, and what is told of their quality.

mod channel_quality;
mod csv;
mod dialect;
mod import;
mod intake;
mod log;
#[cfg(all(feature = "parquet", feature = "mat"))]
mod machines;
#[path = "../../../tests/needs.rs"]
mod needs;
#[cfg(all(feature = "parquet", feature = "mat"))]
mod parquet_file;
mod quality;
#[cfg(all(feature = "parquet", feature = "mat"))]
mod read_binary;
mod read_log;
mod reading;
mod uneven;
#[cfg(all(feature = "parquet", feature = "mat"))]
mod write;
