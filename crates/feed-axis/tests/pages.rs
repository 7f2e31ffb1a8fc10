//! What pages say of the library's effects, against the code.

use crate::common::root;
use axis_sim::effects::EFFECTS;
use discrepancy::Remedy;

/// A law, what to look for in a log, look-alikes, and the remedy that `discover` prints.
#[test]
fn the_catalogue_has_an_entry_for_every_effect() {
    let page = std::fs::read_to_string(root().join("docs/effects.md")).unwrap();
    let (catalogue, _) = page.split_once("<!-- effects:").unwrap();
    for effect in EFFECTS {
        let rows: Vec<Vec<&str>> = catalogue
            .lines()
            .filter(|line| line.starts_with(&format!("| `{}` |", effect.name)))
            .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
            .collect();
        assert_eq!(rows.len(), 1, "rows of docs/effects.md: {}", effect.name);
        let [_, law, log, look_alikes, remedy] = rows[0][..] else {
            panic!("five cells a row: {:?}", rows[0]);
        };
        assert!(![law, log, look_alikes].contains(&""), "{}", effect.name);
        let of = Remedy::of(effect.name).unwrap();
        assert_eq!(remedy, format!("{}: {}", of.function.words(), of.parameter));
        let others = look_alikes.split('`').skip(1).step_by(2);
        for other in others.filter(|word| word.contains('-')) {
            assert!(EFFECTS.iter().any(|e| e.name == other), "{other}");
        }
    }
}
