//! Designs through serde.

use lhs::{Design, LatinHypercube, OrthogonalArray, Placement};

#[test]
fn a_design_comes_back_bit_for_bit() {
    let design = LatinHypercube::new(50, 3, 8).unwrap().design().unwrap();
    let text = serde_json::to_string(&design).unwrap();
    assert!(text.starts_with(r#"{"dims":3,"values":[0."#), "{text}");
    assert_eq!(serde_json::from_str::<Design>(&text).unwrap(), design);
}

#[test]
fn what_is_no_design_is_refused() {
    for (text, part) in [
        (r#"{"dims":2,"values":[0.1,0.2,0.3]}"#, "multiple of dims"),
        (r#"{"dims":0,"values":[0.1]}"#, "between 1 and 1024"),
        (r#"{"dims":1,"values":[]}"#, "positive multiple"),
        (r#"{"dims":1,"values":[0.1],"n":1}"#, "unknown field"),
    ] {
        let message = serde_json::from_str::<Design>(text)
            .unwrap_err()
            .to_string();
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn recipes_are_stored_too() {
    let recipe = OrthogonalArray {
        prime: 5,
        dims: 3,
        placement: Placement::Centred,
        seed: 4,
    };
    let text = serde_json::to_string(&recipe).unwrap();
    assert_eq!(
        text,
        r#"{"prime":5,"dims":3,"placement":"Centred","seed":4}"#
    );
    assert_eq!(
        serde_json::from_str::<OrthogonalArray>(&text).unwrap(),
        recipe
    );
}
