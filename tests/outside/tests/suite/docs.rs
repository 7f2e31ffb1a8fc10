//! The code in docs/extending.md is this crate's.

const PAGE: &str = include_str!("../../../../docs/extending.md");

const SOURCES: [&str; 7] = [
    include_str!("../../src/lib.rs"),
    include_str!("../../src/chain_hoist.rs"),
    include_str!("../../src/quadratic_drag.rs"),
    include_str!("../../src/motor_power.rs"),
    include_str!("../../src/acceleration_feedforward.rs"),
    include_str!("own_time.rs"),
    include_str!("strategy.rs"),
];

/// Every line of it stands in a file, but for the dots of what is left out.
#[test]
fn every_line_of_code_on_the_page_is_compiled() {
    let blocks = PAGE.split("```rust\n").skip(1);
    let lines = blocks.flat_map(|block| block.split("```").next().unwrap_or("").lines());
    let shown: Vec<&str> = lines.map(str::trim).filter(|l| !l.contains('…')).collect();
    assert!(shown.len() > 70, "{}", shown.len());
    for line in shown {
        let mut all = SOURCES.iter().flat_map(|source| source.lines());
        assert!(all.any(|of| of.trim() == line), "docs/extending.md: {line}");
    }
}
