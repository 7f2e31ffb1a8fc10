//! The memory of reading is bounded by the bytes given. Alone in its file, since
//! it looks at the memory of the whole process.
#![cfg(target_os = "linux")]

use cfnn::artifact::network_from_bytes;

/// Most memory that the process has had reserved, kB.
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|l| l.starts_with("VmPeak:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

/// An artifact, with a hash that fits, whose payload is the given words.
fn artifact(words: &[u64]) -> Vec<u8> {
    let mut bytes = b"CFNN\r\n\x1a\nNETW".to_vec();
    bytes.extend_from_slice(&1u32.to_le_bytes());
    bytes.extend_from_slice(&(8 * words.len() as u64).to_le_bytes());
    words
        .iter()
        .for_each(|w| bytes.extend_from_slice(&w.to_le_bytes()));
    let hash = blake3::hash(&bytes);
    bytes.extend_from_slice(hash.as_bytes());
    bytes
}

#[test]
fn a_length_that_is_not_there_takes_no_memory() {
    let huge = 1 << 29;
    // Provenance; inputs, hidden layers; outputs, input ranges.
    let payloads: [&[u64]; 4] = [
        &[huge],
        &[0, 1, huge],
        &[0, 1, 0, 1, huge],
        &[0, 1, 0, 1, 0, 0, huge],
    ];
    network_from_bytes(&artifact(&[0])).unwrap_err();
    let before = peak();
    for words in payloads {
        network_from_bytes(&artifact(words)).unwrap_err();
    }
    // 0 kB measured; half a gigabyte and more if a length were assumed.
    let taken = peak() - before;
    assert!(taken < 16 * 1024, "{taken} kB for less than 200 bytes");
}
