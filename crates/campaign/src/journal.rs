//! What a shard has made so far: blocks of rows, each with its checksum, added at the end
//! of one file.
//!
//! ```text
//! magic "CMPJRNL1" | key [u8; 64]
//! block u64 | length u64 | rows | blake3 of these three
//! ```
//!
//! A process or a node that dies leaves at most a torn last record, whose checksum does
//! not match: it is cut off, and made again.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, ErrorKind, Read, Result, Seek, SeekFrom, Write};

const MAGIC: &[u8; 8] = b"CMPJRNL1";
const HEADER: u64 = 8 + 64;
const HEAD: usize = 16;
const HASH: usize = blake3::OUT_LEN;

/// Where a block's rows are.
struct Place {
    start: u64,
    length: usize,
}

pub(crate) struct Journal {
    file: File,
    end: u64,
    blocks: BTreeMap<u64, Place>,
}

impl Journal {
    /// Opens the journal in a file that this process has locked. What another key or no
    /// journal at all left there is removed where `replace` says so.
    /// `None` if it does not.
    pub(crate) fn open(mut file: File, key: &str, replace: bool) -> Result<Option<Self>> {
        let length = file.metadata()?.len();
        let mut header = Vec::from(*MAGIC);
        header.extend(key.as_bytes());
        let mut found = Vec::new();
        file.seek(SeekFrom::Start(0))?;
        (&file).take(HEADER).read_to_end(&mut found)?;
        // A header that was cut short had no blocks behind it.
        let is_new = length < HEADER;
        if !is_new && found != header && !replace {
            return Ok(None);
        }
        if is_new || found != header {
            file.set_len(0)?;
            file.seek(SeekFrom::Start(0))?;
            file.write_all(&header)?;
        }
        let mut journal = Self {
            file,
            end: HEADER,
            blocks: BTreeMap::new(),
        };
        journal.scan()?;
        Ok(Some(journal))
    }

    /// Finds the whole blocks and cuts off what is behind them.
    fn scan(&mut self) -> Result<()> {
        let length = self.file.metadata()?.len();
        let mut from = BufReader::new(&self.file);
        from.seek(SeekFrom::Start(HEADER))?;
        while let Some((block, size)) = record(&mut from, length - self.end)? {
            let start = self.end + HEAD as u64;
            let place = Place {
                start,
                length: size,
            };
            self.blocks.insert(block, place);
            self.end = start + (size + HASH) as u64;
        }
        self.file.set_len(self.end)
    }

    pub(crate) fn has(&self, block: usize) -> bool {
        self.blocks.contains_key(&(block as u64))
    }

    /// Adds a block.
    pub(crate) fn put(&mut self, block: usize, rows: &[u8]) -> Result<()> {
        let mut record = Vec::with_capacity(HEAD + rows.len() + HASH);
        record.extend((block as u64).to_le_bytes());
        record.extend((rows.len() as u64).to_le_bytes());
        record.extend(rows);
        record.extend(blake3::hash(&record).as_bytes());
        self.file.seek(SeekFrom::Start(self.end))?;
        self.file.write_all(&record)?;
        let place = Place {
            start: self.end + HEAD as u64,
            length: rows.len(),
        };
        self.blocks.insert(block as u64, place);
        self.end += record.len() as u64;
        Ok(())
    }

    /// The rows of a block.
    pub(crate) fn block(&mut self, block: usize) -> Result<Vec<u8>> {
        let place = self
            .blocks
            .get(&(block as u64))
            .ok_or(ErrorKind::NotFound)?;
        let mut rows = vec![0; place.length];
        self.file.seek(SeekFrom::Start(place.start))?;
        self.file.read_exact(&mut rows)?;
        Ok(rows)
    }
}

/// Reads a record of at most `left` bytes: its block, and how long its rows are. `None`
/// if there is no whole one.
fn record(from: &mut impl Read, left: u64) -> Result<Option<(u64, usize)>> {
    if left < (HEAD + HASH) as u64 {
        return Ok(None);
    }
    let mut record = vec![0; HEAD];
    from.read_exact(&mut record)?;
    let word = |at: usize| u64::from_le_bytes(std::array::from_fn(|i| record[at + i]));
    let (block, size) = (word(0), word(8));
    if size > left - (HEAD + HASH) as u64 {
        return Ok(None);
    }
    // Not more than the file has.
    let size = size as usize;
    record.resize(HEAD + size, 0);
    from.read_exact(&mut record[HEAD..])?;
    let mut hash = [0; HASH];
    from.read_exact(&mut hash)?;
    Ok((blake3::hash(&record) == hash).then_some((block, size)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn open(path: &std::path::Path, key: char, replace: bool) -> Option<Journal> {
        // Not locked: a process that another test begins would hold the lock for a moment.
        let mut options = File::options();
        let options = options.read(true).write(true).create(true).truncate(false);
        let file = options.open(path).unwrap();
        let key: String = std::iter::repeat_n(key, 64).collect();
        Journal::open(file, &key, replace).unwrap()
    }

    #[test]
    fn wherever_a_journal_is_cut_its_whole_blocks_stay() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("journal");
        let mut journal = open(&path, 'a', false).unwrap();
        journal.put(4, b"four").unwrap();
        let first = journal.end;
        journal.put(2, b"zwei").unwrap();
        drop(journal);
        let whole = std::fs::read(&path).unwrap();
        for cut in 0..whole.len() {
            std::fs::write(&path, &whole[..cut]).unwrap();
            let mut journal = open(&path, 'a', false).unwrap();
            assert_eq!(journal.has(4), cut as u64 >= first);
            assert!(!journal.has(2));
            journal.put(2, b"two").unwrap();
            assert_eq!(journal.block(2).unwrap(), b"two");
            drop(journal);
            assert!(open(&path, 'a', false).unwrap().has(2));
        }
    }

    #[test]
    fn a_changed_byte_takes_away_its_block_and_those_behind() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("journal");
        open(&path, 'a', false).unwrap().put(0, b"rows").unwrap();
        let whole = std::fs::read(&path).unwrap();
        for at in HEADER as usize..whole.len() {
            let mut changed = whole.clone();
            changed[at] ^= 1;
            std::fs::write(&path, &changed).unwrap();
            assert!(!open(&path, 'a', false).unwrap().has(0), "{at}");
        }
    }

    #[test]
    fn the_journal_of_another_key_is_only_replaced_where_that_was_asked() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("journal");
        open(&path, 'a', false).unwrap().put(0, b"rows").unwrap();
        assert!(open(&path, 'b', false).is_none());
        assert!(open(&path, 'a', false).unwrap().has(0));
        assert!(!open(&path, 'b', true).unwrap().has(0));
    }
}
