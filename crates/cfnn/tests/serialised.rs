//! Networks and settings through JSON: the same again, or refused.

use cfnn::train::{Bayesian, EarlyStopping, Initialisation, TrainingSettings, starting_weights};
use cfnn::{Network, Scaling, Shape};
use proptest::prelude::*;
use serde_json::{Value, json};

use crate::support::architectures;

proptest! {
    #[test]
    fn networks_come_back(architecture in architectures(), seed in 0..100u64) {
        let shape = architecture.shape();
        let scaling = Scaling::from_ranges(
            &vec![(-0.1, 1.3); shape.inputs],
            &vec![(1e-9, 3e-9); shape.outputs],
        ).unwrap();
        let weights = starting_weights(&architecture, seed).unwrap();
        let network = Network::new(architecture, scaling, weights).unwrap();
        let text = serde_json::to_string(&network).unwrap();
        prop_assert_eq!(serde_json::from_str::<Network>(&text).unwrap(), network);
    }
}

#[test]
fn settings_come_back() {
    for settings in [
        TrainingSettings::default(),
        TrainingSettings {
            validation: Some(EarlyStopping {
                fraction: 0.2,
                patience: 6,
            }),
            initialisation: Initialisation::DataAdapted { axis_aligned: 0.5 },
            bayesian: Some(Bayesian {
                tolerance: 1e-5,
                ..Bayesian::default()
            }),
            caller_pool: true,
            ..TrainingSettings::default()
        },
    ] {
        let text = serde_json::to_string(&settings).unwrap();
        assert_eq!(
            serde_json::from_str::<TrainingSettings>(&text).unwrap(),
            settings
        );
    }
    let usual: TrainingSettings = serde_json::from_value(json!({})).unwrap();
    assert_eq!(usual, TrainingSettings::default());
}

#[test]
fn what_is_written_is_read_by_its_names() {
    let network: Network = serde_json::from_value(json!({
        "architecture": {
            "shape": { "inputs": 2, "hidden": [1], "outputs": 1 },
            "links": "feed_forward",
            "transfers": ["poslin"],
            "dropped_inputs": [1],
        },
        "scaling": { "input": [[0.0, 2.0], [0.0, 2.0]], "output": [[-1.0, 1.0]] },
        "weights": [0.0, 1.0, 0.0, 0.5, 0.0, 0.0, 2.0],
    }))
    .unwrap();
    // 0.5 + 2 max(0, x - 1).
    let mut scratch = network.scratch();
    assert_eq!(network.predict_one(&[1.5, 9.0], &mut scratch), Ok(1.5));
    assert_eq!(network.predict_one(&[0.5, 9.0], &mut scratch), Ok(0.5));
}

#[test]
fn what_is_not_valid_is_refused() {
    let network = || {
        json!({
            "architecture": { "shape": { "inputs": 1, "hidden": [1], "outputs": 1 } },
            "scaling": { "input": [[0.0, 2.0]], "output": [[-1.0, 1.0]] },
            "weights": [0.0, 1.0, 0.0, 0.5, 0.0],
        })
    };
    let read = |value: Value| serde_json::from_value::<Network>(value).map_err(|e| e.to_string());
    read(network()).unwrap();
    let changes: [(&str, Value, &str); 8] = [
        ("/architecture/shape/inputs", json!(0), "inputs[0] is 0"),
        ("/architecture/shape/inputs", json!(2), "must be"),
        (
            "/architecture/shape",
            json!({ "inputs": 1, "hidden": [1], "outputs": 1, "more": 1 }),
            "unknown field",
        ),
        ("/scaling/input/0/1", json!(0.0), "minimum must lie below"),
        ("/weights/1", json!(null), "invalid type"),
        ("/weights", json!([0.0]), "weights: found 1, must be 5"),
        (
            "/architecture",
            json!({ "shape": { "inputs": 1, "hidden": [1], "outputs": 1 }, "dropped_inputs": [0] }),
            "dropped inputs",
        ),
        (
            "/architecture",
            json!({ "shape": { "inputs": 1, "hidden": [1], "outputs": 1 }, "links": "feed_forward" }),
            "weights[3] is 0.5",
        ),
    ];
    for (place, value, said) in changes {
        let mut changed = network();
        *changed.pointer_mut(place).unwrap() = value;
        let refused = read(changed).unwrap_err();
        assert!(refused.contains(said), "{refused}, not {said}");
    }
    for wrong in [
        json!({ "goal": -1.0 }),
        json!({ "epoch": 3 }),
        json!({ "initialisation": "random" }),
    ] {
        serde_json::from_value::<TrainingSettings>(wrong).unwrap_err();
    }
    serde_json::from_value::<Shape>(json!({ "inputs": 1, "hidden": [0], "outputs": 1 }))
        .unwrap_err();
}
