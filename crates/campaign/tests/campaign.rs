//! The laws of shards: any number of them, however often they are killed, gives the bits of
//! one process.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use campaign::{
    CampaignError, Column, Failure, IfOther, Inputs, Job, Merged, Row, Shard, Value, run_shard,
    shards_in,
};
use proptest::prelude::*;

/// A job whose rows are strange numbers and texts, that can be stopped.
struct Strange {
    out: PathBuf,
    cases: usize,
    block: usize,
    seed: u64,
    /// Cases that may still be made.
    left: AtomicUsize,
    result: Mutex<Vec<Row>>,
}

const COLUMNS: &[Column] = &[Column::number("value"), Column::text("words")];

impl Strange {
    fn new(out: &Path, cases: usize, block: usize) -> Self {
        Self {
            out: out.to_owned(),
            cases,
            block,
            seed: 1,
            left: AtomicUsize::new(usize::MAX),
            result: Mutex::default(),
        }
    }

    /// A row of case `i`: any bits at all but NaN, which is not equal to itself.
    fn row(&self, i: usize) -> Row {
        let mix = (i as u64 + self.seed).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let value = f64::from_bits(mix);
        let value = if value.is_nan() { -0.0 } else { value };
        let words = "ü\n\"".repeat(i % 7);
        vec![Value::Number(value), Value::Text(words)]
    }
}

impl Job for Strange {
    fn name(&self) -> &'static str {
        "strange"
    }
    fn inputs(&self) -> Inputs {
        Inputs::default().with("seed", self.seed)
    }
    fn folder(&self) -> &Path {
        &self.out
    }
    fn columns(&self) -> &'static [Column] {
        COLUMNS
    }
    fn cases(&self) -> usize {
        self.cases
    }
    fn block(&self) -> usize {
        self.block
    }
    fn rows(&self, cases: Range<usize>) -> Result<Vec<Row>, Failure> {
        let take = |left: usize| left.checked_sub(1);
        let taken = (self.left).fetch_update(Ordering::Relaxed, Ordering::Relaxed, take);
        taken.map_err(|_| "stopped")?;
        Ok(cases.map(|i| self.row(i)).collect())
    }
    fn finish(&self, rows: &Merged) -> Result<(), Failure> {
        let rows = rows.rows().collect::<Result<_, _>>()?;
        *self.result.lock().unwrap() = rows;
        Ok(())
    }
}

fn make(job: &Strange, shard: Shard) -> Result<PathBuf, CampaignError> {
    run_shard(job, shard, IfOther::Refuse, &|_| ())
}

fn bits(rows: &[Row]) -> Vec<(u64, String)> {
    let pair = |row: &Row| {
        let value = row[0].number().unwrap().to_bits();
        (value, row[1].text().unwrap().to_owned())
    };
    rows.iter().map(pair).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn any_number_of_shards_gives_every_row_once_in_order(
        cases in 1usize..300, shards in 1usize..20, block in 1usize..50,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let job = Strange::new(folder.path(), cases, block);
        let shards = shards.min(cases);
        // The last first: they know nothing of each other.
        for shard in Shard::all(shards).collect::<Vec<_>>().into_iter().rev() {
            make(&job, shard).unwrap();
        }
        prop_assert_eq!(shards_in(&folder.path().join("shards"), "strange"), vec![shards]);
        let merged = Merged::open(&job, shards, false).unwrap();
        job.finish(&merged).unwrap();
        let wanted: Vec<Row> = (0..cases).map(|i| job.row(i)).collect();
        prop_assert_eq!(bits(&job.result.lock().unwrap()), bits(&wanted));
        let middle = cases / 3..cases - cases / 4;
        let part: Vec<Row> = merged.range(middle.clone()).collect::<Result<_, _>>().unwrap();
        prop_assert_eq!(bits(&part), bits(&wanted[middle]));
    }

    #[test]
    fn a_shard_that_was_stopped_goes_on_and_its_file_is_the_same(
        stops in prop::collection::vec(0usize..12, 1..6), cut in 0usize..40,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let other = tempfile::tempdir().unwrap();
        let [job, whole] = [&folder, &other].map(|f| Strange::new(f.path(), 60, 2));
        let shard = "2/3".parse().unwrap();
        let mut made = 0;
        for stop in stops {
            job.left.store(stop, Ordering::Relaxed);
            let is_done = make(&job, shard).is_ok();
            made += stop;
            prop_assert_eq!(is_done, made >= 10, "what is made is not made again");
            if is_done {
                made = usize::MAX / 2;
            }
        }
        // A node that dies takes the end of the journal with it.
        let journal = folder.path().join("shards/strange-2-of-3.journal");
        if let Ok(bytes) = std::fs::read(&journal) {
            std::fs::write(&journal, &bytes[..bytes.len().saturating_sub(cut)]).unwrap();
        }
        job.left.store(usize::MAX, Ordering::Relaxed);
        let path = make(&job, shard).unwrap();
        prop_assert!(!journal.exists());
        let alone = make(&whole, shard).unwrap();
        prop_assert_eq!(std::fs::read(path).unwrap(), std::fs::read(alone).unwrap());
    }
}

#[test]
fn more_rows_than_a_row_group_holds_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let job = Strange::new(folder.path(), 200_001, 1000);
    for shard in Shard::all(2) {
        make(&job, shard).unwrap();
    }
    let merged = Merged::open(&job, 2, false).unwrap();
    let mut count = 0;
    for (i, row) in merged.rows().enumerate() {
        assert_eq!(bits(&[row.unwrap()]), bits(&[job.row(i)]));
        count += 1;
    }
    assert_eq!(count, 200_001);
}

#[test]
fn missing_shards_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let job = Strange::new(folder.path(), 30, 1);
    make(&job, "2/3".parse().unwrap()).unwrap();
    let error = Merged::open(&job, 3, false).err().unwrap().to_string();
    assert!(
        error.contains("2 of 3 shards") && error.contains("1/3, 3/3"),
        "{error}"
    );
    let error = make(&job, "1/31".parse().unwrap()).unwrap_err().to_string();
    assert!(error.contains("30 cases"), "{error}");
}

#[test]
fn shards_of_other_inputs_are_refused_and_the_difference_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let mut job = Strange::new(folder.path(), 30, 1);
    make(&job, Shard::WHOLE).unwrap();
    // Left alone where the inputs are the same: it could not be made again.
    job.left.store(0, Ordering::Relaxed);
    make(&job, Shard::WHOLE).unwrap();
    job.seed = 2;
    for error in [
        make(&job, Shard::WHOLE).unwrap_err(),
        Merged::open(&job, 1, false).err().unwrap(),
    ] {
        let error = error.to_string();
        assert!(
            error.contains("seed is 1, not 2") && error.contains("remove it"),
            "{error}"
        );
    }
    job.left.store(usize::MAX, Ordering::Relaxed);
    run_shard(&job, Shard::WHOLE, IfOther::Replace, &|_| ()).unwrap();
    Merged::open(&job, 1, false).unwrap();
}

#[test]
fn a_file_of_another_shard_or_damaged_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let job = Strange::new(folder.path(), 30, 1);
    let [first, second] = ["1/2", "2/2"].map(|s| make(&job, s.parse().unwrap()).unwrap());
    let whole = std::fs::read(&second).unwrap();
    std::fs::copy(&first, &second).unwrap();
    let error = Merged::open(&job, 2, false).err().unwrap().to_string();
    assert!(error.contains("it is shard 1/2"), "{error}");
    // Any one bit, and any length.
    for at in 0..whole.len() {
        let mut changed = whole.clone();
        changed[at] ^= 1 << (at % 8);
        std::fs::write(&second, &changed).unwrap();
        assert!(Merged::open(&job, 2, false).is_err(), "{at}");
        std::fs::write(&second, &whole[..at]).unwrap();
        assert!(Merged::open(&job, 2, false).is_err(), "{at}");
    }
    std::fs::write(&second, &whole).unwrap();
    Merged::open(&job, 2, false).unwrap();
}

#[test]
fn two_processes_do_not_make_the_same_shard() {
    let folder = tempfile::tempdir().unwrap();
    let job = Strange::new(folder.path(), 30, 1);
    let shards = folder.path().join("shards");
    std::fs::create_dir_all(&shards).unwrap();
    let lock = campaign::try_lock(&shards.join("strange-1-of-1.journal")).unwrap();
    let error = make(&job, Shard::WHOLE).unwrap_err().to_string();
    assert!(error.contains("another process"), "{error}");
    drop(lock);
    make(&job, Shard::WHOLE).unwrap();
}
