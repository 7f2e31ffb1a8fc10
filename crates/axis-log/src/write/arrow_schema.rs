//! The Arrow schema of a Parquet file, which carries the unit of each field.
//!
//! Parquet has no metadata of a field. Arrow's readers and writers keep them in the file's
//! key-value metadata `ARROW:schema`: the schema message of the
//! [Arrow IPC format](https://arrow.apache.org/docs/format/Columnar.html#schema-message), a
//! FlatBuffer, in base64. Slots are those of Arrow's `Schema.fbs` and `Message.fbs`.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flatbuffers::{FlatBufferBuilder, TableFinishedWIPOffset, WIPOffset};

/// Metadata key of the file.
pub(super) const KEY: &str = "ARROW:schema";
/// Metadata key of a field.
const UNIT: &str = "unit";

type Table = WIPOffset<TableFinishedWIPOffset>;

/// Place of a field of a table in its vtable.
const fn slot(index: u16) -> u16 {
    4 + 2 * index
}

/// The schema of doubles without nulls, of these names and units.
pub(super) fn encoded<'a>(fields: impl Iterator<Item = (&'a str, &'a str)>) -> String {
    /// `MetadataVersion.V5`, `MessageHeader.Schema`.
    const V5: i16 = 4;
    const SCHEMA: u8 = 1;
    let mut to = FlatBufferBuilder::new();
    let fields: Vec<Table> = fields
        .map(|(name, unit)| field(&mut to, name, unit))
        .collect();
    let fields = to.create_vector(&fields);
    let table = to.start_table();
    to.push_slot_always(slot(1), fields);
    let schema = to.end_table(table);
    let table = to.start_table();
    to.push_slot_always(slot(0), V5);
    to.push_slot_always(slot(1), SCHEMA);
    to.push_slot_always(slot(2), schema);
    let message = to.end_table(table);
    to.finish_minimal(message);
    framed(to.finished_data())
}

fn field(to: &mut FlatBufferBuilder<'_>, name: &str, unit: &str) -> Table {
    /// `Type.FloatingPoint`, `Precision.DOUBLE`.
    const FLOATING_POINT: u8 = 3;
    const DOUBLE: i16 = 2;
    let (name, key, unit) = (
        to.create_string(name),
        to.create_string(UNIT),
        to.create_string(unit),
    );
    let table = to.start_table();
    to.push_slot_always(slot(0), key);
    to.push_slot_always(slot(1), unit);
    let unit = to.end_table(table);
    let metadata = to.create_vector(&[unit]);
    let children = to.create_vector::<Table>(&[]);
    let table = to.start_table();
    to.push_slot_always(slot(0), DOUBLE);
    let double = to.end_table(table);
    let table = to.start_table();
    to.push_slot_always(slot(0), name);
    to.push_slot_always(slot(2), FLOATING_POINT);
    to.push_slot_always(slot(3), double);
    to.push_slot_always(slot(5), children);
    to.push_slot_always(slot(6), metadata);
    to.end_table(table)
}

/// An encapsulated message: the mark of a continuation, the length, the message to 8 bytes.
fn framed(message: &[u8]) -> String {
    let padded = message.len().next_multiple_of(8);
    let mut bytes = vec![0xff; 4];
    // A schema is far below 4 GB.
    bytes.extend_from_slice(&(padded as u32).to_le_bytes());
    bytes.extend_from_slice(message);
    bytes.resize(8 + padded, 0);
    STANDARD.encode(bytes)
}
