//! The ONNX file holds the network: decoded and evaluated operator by operator.

use crate::support::onnx::evaluate;
use crate::support::{Outcome, laws, samples};
use controller_export::onnx::{self, OPSET, proto};
use prost::Message;

#[test]
fn the_graph_is_the_network() -> Outcome<()> {
    let axis = samples::axis()?;
    let predictors = laws::predictors(&axis)?;
    let bytes = onnx::one_cycle(&predictors)?;
    let model = proto::Model::decode(&*bytes)?;
    assert_eq!(model.opset_import[0].version, Some(OPSET));
    let (x, expected) = laws::network_cases(&axis, &laws::network(&axis)?, 500)?;
    let (columns, y) = evaluate(model.graph.as_ref().ok_or("no graph")?, (4, x));
    assert_eq!((columns, y.len()), (1, expected.len()));
    let most = expected.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
    for (y, expected) in y.iter().zip(&expected) {
        assert!((y - expected).abs() <= 1e-12 * most, "{y} {expected}");
    }
    Ok(())
}

/// Names and units of the columns come along.
#[test]
fn metadata_tell_the_columns() -> Outcome<()> {
    let predictors = laws::predictors(&samples::axis()?)?;
    let model = proto::Model::decode(&*onnx::one_cycle(&predictors)?)?;
    let of = |key: &str| {
        let entry = model.metadata_props.iter().find(|entry| entry.key() == key);
        entry.map(|entry| entry.value().to_owned())
    };
    let inputs = "position m, velocity m/s, acceleration m/s^2, command A";
    assert_eq!(of("inputs").as_deref(), Some(inputs));
    assert_eq!(of("outputs").as_deref(), Some("increment m"));
    assert_eq!(
        of("axis_fingerprint"),
        Some(predictors.axis.fingerprint.clone())
    );
    Ok(())
}

/// A description of other columns is refused.
#[test]
fn another_number_of_columns_is_refused() -> Outcome<()> {
    let network = laws::network(&samples::axis()?)?;
    let refused = onnx::export(&network, &onnx::Description::default());
    let message = refused.expect_err("no columns described").to_string();
    assert!(message.contains("described inputs"), "{message}");
    Ok(())
}
