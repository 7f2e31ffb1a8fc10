//! A file of any known format to a log.

use std::path::Path;

use crate::by_extension::{by_extension, whole};
use crate::channel::Channel;
use crate::import::stated_unit;
use crate::log::{Log, TIME_CHANNEL};
use crate::mapping::{ColumnMap, Mapping};
use crate::read_error::{ReadError, ReadProblem};
use crate::select::{Pick, other_unit, select};
use crate::table::{Head, Holes, Note, Table};

/// Reads a log from a table of text, a Parquet or a MAT file, by its extension (`.csv`,
/// `.tsv`, `.txt`, `.dat`, `.asc`; `.parquet`; `.mat`, in any case), renaming and scaling
/// columns as `mapping` says.
///
/// A column that the mapping names becomes `scale · value + offset` under the
/// channel's name. Any other column is taken as it stands if its name ends in a
/// known unit ([`unit_of`](crate::unit_of)) and no mapped column has taken that
/// name, and is skipped otherwise. A mapped column that the file does not have
/// is left out, unless its channel is `required`; so the mapping of a drive also
/// reads files that hold fewer channels, or already have these names. The time
/// `t_s` comes from its column, or from the mapping's sample rate; it stands
/// first, then the mapped channels, then the others in the file's order.
///
/// - **Text** as for [`read_csv`](crate::read_csv), except that columns without a
///   known unit are skipped, whatever they hold, and that fields may be separated by
///   semicolons, tabs or blanks, decimals by a comma, names stand behind a `#`, units in a line
///   of their own, and the text be UTF-16 or ISO 8859-1. Where the first row holds numbers only,
///   there are no names: columns are called `column 1`, `column 2`, ….
/// - **Parquet** (feature `parquet`), uncompressed or by Snappy, zstd, gzip, LZ4 or Brotli: flat
///   columns of float, double, int32 and int64; other columns are skipped. Time stamps and times of
///   day, as which a column may be typed, are in seconds where the mapping gives no scale (1), and
///   otherwise the integers that they are stored as.
/// - **MAT version 5** (feature `mat`; `-v6`, `-v7`), compressed or not: each real
///   numeric vector, n × 1 or 1 × n, is a column under its variable's name. So are the fields of a
///   struct, the columns of a matrix (its rows where these are longer) and the cells of an array of
///   cells, by their path: `data.q(2)` is the second column of field `q` of `data`. Skipped
///   are scalars and vectors of another length than the time, complex and
///   sparse arrays, and text. Version 7.3 is HDF5 and refused with that hint.
/// - **Rows that are there twice**, time and all, are taken once.
///
/// - **Files of other programs** that are recognised by their content, whatever their
///   extension: [`propose`](crate::propose) says which they are and what their mapping
///   could be.
///
/// A file is read whole, and numbers take 8 bytes each beside it. What a binary file
/// claims beyond nine times its own size and 64 MB is refused before memory is asked
/// for, as are more than 4096 columns.
///
/// # Errors
/// A [`ReadError`] with file, line (CSV) or row, and what would be valid: file
/// not readable, a mapping that makes no sense, a required channel or the time
/// missing (the columns that exist are listed), a wanted column doubled, of
/// another type or length, a value missing, not a number or not finite, a time
/// repeated or unsorted.
pub fn read_log(
    path: impl AsRef<Path>,
    mapping: &Mapping,
    required: &[&str],
) -> Result<Log, ReadError> {
    let path = path.as_ref();
    let whole = || {
        if let Some(late) = mapping.columns.iter().find(|c| c.delay != 0.0) {
            let channel = late.channel.clone();
            return Err(ReadProblem::Delay { channel });
        }
        let read = read(path, mapping, required, Holes::Refused)?;
        Ok(Log::new(read.channels)?)
    };
    whole().map_err(|problem| ReadError {
        file: path.display().to_string(),
        problem,
    })
}

/// What was read of a file.
pub(crate) struct Read {
    /// The channels, the time first; NaN in the others only where holes are kept.
    pub channels: Vec<Channel>,
    /// What is to be told of it.
    pub notes: Vec<Note>,
    /// How each channel was read.
    pub maps: Vec<ColumnMap>,
}

pub(crate) fn read(
    path: &Path,
    mapping: &Mapping,
    required: &[&str],
    holes: Holes,
) -> Result<Read, ReadProblem> {
    mapping.check()?;
    let bytes = match whole(path) {
        Ok(bytes) => bytes,
        // Of a file that could not be read anyway, that is said.
        Err(absent) => {
            return Err(by_extension(path, &[])
                .err()
                .filter(is_of_name)
                .unwrap_or(absent));
        }
    };
    channels(open(path, &bytes)?, mapping, required, holes)
}

/// Whether the file's name alone rules it out.
fn is_of_name(problem: &ReadProblem) -> bool {
    matches!(
        problem,
        ReadProblem::Extension { .. } | ReadProblem::LeftOut { .. }
    )
}

/// The file as a table: of another program by its content, of the others by its extension.
pub(crate) fn open<'a>(path: &Path, bytes: &'a [u8]) -> Result<Box<dyn Table + 'a>, ReadProblem> {
    crate::import::table(bytes).unwrap_or_else(|| by_extension(path, bytes))
}

fn channels(
    mut table: impl Table,
    mapping: &Mapping,
    required: &[&str],
    holes: Holes,
) -> Result<Read, ReadProblem> {
    let mut picks = select(&table, mapping, required)?;
    // The time goes first, the others keep their order.
    picks.sort_by_key(|p| p.map.channel != TIME_CHANNEL);
    let mut wanted: Vec<usize> = picks.iter().map(|p| p.column).collect();
    wanted.sort_unstable();
    wanted.dedup();
    let mut columns = table.read(&wanted, holes)?;
    let at = |pick: &Pick| wanted.partition_point(|&c| c < pick.column);
    let samples = length(&mut picks, |pick| &columns[at(pick)])?;
    let mut notes = table.notes();
    notes.extend(notes_of_mapping(table.heads(), mapping, &picks));
    let time = picks.first().filter(|p| p.map.channel == TIME_CHANNEL);
    let kept = match time.map(|pick| (at(pick), pick.map.clone())) {
        Some((time, map)) => {
            let (kept, first) = once(&mut table, &mut columns, time)?;
            let rows = samples - kept.len();
            notes.extend(first.map(|value| Note::Repeated {
                rows,
                first: map.apply(value),
            }));
            kept
        }
        None => Vec::from_iter(0..samples),
    };
    let samples = kept.len();
    let mut channels = Vec::with_capacity(picks.len() + 1);
    if picks.first().is_none_or(|p| p.map.channel != TIME_CHANNEL)
        && let Some(rate) = mapping.sample_rate_hz
    {
        let time = (0..samples).map(|k| k as f64 / rate).collect();
        channels.push(Channel::new(TIME_CHANNEL, time)?);
    }
    for (k, pick) in picks.iter().enumerate() {
        let again = picks[k + 1..].iter().any(|p| p.column == pick.column);
        let values = &mut columns[at(pick)];
        // The last channel of a column takes its numbers, so that they are there once.
        let values = if again {
            values.clone()
        } else {
            std::mem::take(values)
        };
        channels.push(channel(&table, pick, values, &kept, holes)?);
    }
    let maps = picks.into_iter().map(|pick| pick.map).collect();
    Ok(Read {
        channels,
        notes,
        maps,
    })
}

/// What is to be told of how a mapping fits a file.
fn notes_of_mapping<'a>(
    heads: &'a [Head],
    mapping: &'a Mapping,
    picks: &'a [Pick],
) -> impl Iterator<Item = Note> + 'a {
    let there = |name: &str| heads.iter().any(|head| head.name == name);
    let absent = mapping.columns.iter().filter(move |m| !there(&m.source));
    let absent = absent.map(|m| Note::NoColumn {
        column: m.source.clone(),
        there: heads.iter().map(|head| head.name.clone()).collect(),
    });
    let by_file = picks.iter().filter(|p| {
        let is_mapped = mapping.columns.iter().any(|m| m.channel == p.map.channel);
        is_mapped && !p.map.is_scale_stated && p.map.scale != 1.0
    });
    let by_file = by_file.map(|p| {
        let head = &heads[p.column];
        let unit = head.stored.or(head.unit.as_deref());
        Note::UnitOfFile {
            column: head.name.clone(),
            unit: unit
                .or_else(|| stated_unit(&head.name))
                .unwrap_or_default()
                .to_owned(),
        }
    });
    let other = picks.iter().filter_map(|p| {
        let other = other_unit(&p.map, &heads[p.column])?;
        Some(Note::OtherUnit(other))
    });
    absent.chain(by_file).chain(other)
}

/// Takes out of the columns what is in the table twice: rows with the time of the one before that
/// are the same in all else too. The rows that are kept, and the first time that was there twice.
fn once(
    table: &mut impl Table,
    columns: &mut [Vec<f64>],
    time: usize,
) -> Result<(Vec<usize>, Option<f64>), ReadProblem> {
    let times = &columns[time];
    let again: Vec<usize> = (1..times.len())
        .filter(|&k| times[k] == times[k - 1])
        .collect();
    let mut kept: Vec<usize> = (0..times.len()).collect();
    if again.is_empty() {
        return Ok((kept, None));
    }
    let same = table.repeats(&again)?;
    let again = again.into_iter().zip(same).filter(|(_, same)| *same);
    let twice: Vec<usize> = again.map(|(row, _)| row).collect();
    let first = twice.first().map(|&row| columns[time][row]);
    let is_kept = |row: usize| twice.binary_search(&row).is_err();
    for column in columns.iter_mut() {
        let mut row = 0..;
        column.retain(|_| row.next().is_some_and(is_kept));
    }
    kept.retain(|&row| is_kept(row));
    Ok((kept, first))
}

/// The number of samples, set by the first column that someone asked for (the
/// time, if it is a column). Others of another length are refused, or dropped if
/// nobody asked for them.
fn length<'a>(
    picks: &mut Vec<Pick>,
    values: impl Fn(&Pick) -> &'a [f64],
) -> Result<usize, ReadProblem> {
    let Some(first) = picks.iter().find(|p| p.asked).or(picks.first()) else {
        return Err(ReadProblem::NoRows);
    };
    let (expected, other) = (values(first).len(), first.map.source.clone());
    if expected == 0 {
        return Err(ReadProblem::NoRows);
    }
    for pick in picks.iter().filter(|p| p.asked) {
        let found = values(pick).len();
        if found != expected {
            let name = pick.map.source.clone();
            return Err(ReadProblem::Length {
                name,
                found,
                other,
                expected,
            });
        }
    }
    picks.retain(|p| values(p).len() == expected);
    Ok(expected)
}

/// Scales and checks one column.
fn channel(
    table: &impl Table,
    pick: &Pick,
    mut samples: Vec<f64>,
    kept: &[usize],
    holes: Holes,
) -> Result<Channel, ReadProblem> {
    for value in &mut samples {
        *value = pick.map.apply(*value);
    }
    let at = |row: usize| (table.place(kept[row], pick.column), pick.map.source.clone());
    let kept_holes = holes == Holes::Kept && pick.map.channel != TIME_CHANNEL;
    let refused = |v: &f64| !(v.is_finite() || kept_holes && v.is_nan());
    if let Some(row) = samples.iter().position(refused) {
        let ((place, name), value) = (at(row), samples[row]);
        return Err(ReadProblem::NotFinite { place, name, value });
    }
    if pick.map.channel == TIME_CHANNEL
        && let Some(row) = samples.windows(2).position(|w| w[1] <= w[0])
    {
        let ((place, name), previous, value) = (at(row + 1), samples[row], samples[row + 1]);
        return Err(if value == previous {
            ReadProblem::TimeRepeated { place, name, value }
        } else {
            ReadProblem::TimeUnsorted {
                place,
                name,
                previous,
                value,
            }
        });
    }
    Ok(Channel::new(&pick.map.channel, samples)?)
}
