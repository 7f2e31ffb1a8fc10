//! The ONNX file holds the network: decoded and evaluated operator by operator.

mod support;

use std::collections::BTreeMap;

use controller_export::onnx::{self, OPSET, proto};
use prost::Message;
use support::{Outcome, laws, samples};

/// A table: columns, and numbers row by row.
type Table = (usize, Vec<f64>);

/// What an operator makes of tables; a single row serves all rows.
fn apply(operator: &str, a: &Table, b: Option<&Table>) -> Table {
    let rows = a.1.len() / a.0;
    let each = |f: fn(f64, f64) -> f64| {
        let b = b.expect("two operands");
        let of = |(i, x): (usize, &f64)| f(*x, b.1[i % b.1.len()]);
        (a.0, a.1.iter().enumerate().map(of).collect())
    };
    match (operator, b) {
        ("Add", _) => each(|x, y| x + y),
        ("Sub", _) => each(|x, y| x - y),
        ("Mul", _) => each(|x, y| x * y),
        ("Tanh", _) => (a.0, a.1.iter().map(|x| x.tanh()).collect()),
        ("Concat", Some(b)) => {
            let both = |r: usize| [&a.1[r * a.0..][..a.0], &b.1[r * b.0..][..b.0]].concat();
            (a.0 + b.0, (0..rows).flat_map(both).collect())
        }
        ("MatMul", Some(b)) => {
            let cell =
                |r: usize, c: usize| (0..a.0).map(|k| a.1[r * a.0 + k] * b.1[k * b.0 + c]).sum();
            (
                b.0,
                (0..rows)
                    .flat_map(|r| (0..b.0).map(move |c| cell(r, c)))
                    .collect(),
            )
        }
        _ => panic!("operator {operator}"),
    }
}

fn evaluate(graph: &proto::Graph, x: Table) -> Table {
    let mut values: BTreeMap<String, Table> = BTreeMap::from([("x".to_owned(), x)]);
    for tensor in &graph.initializer {
        assert_eq!(tensor.data_type, Some(proto::DOUBLE));
        let bytes = tensor.raw_data().as_chunks::<8>().0;
        let numbers: Vec<f64> = bytes.iter().map(|b| f64::from_le_bytes(*b)).collect();
        assert_eq!(tensor.dims.iter().product::<i64>() as usize, numbers.len());
        let columns = *tensor.dims.last().expect("a length") as usize;
        values.insert(tensor.name().to_owned(), (columns, numbers));
    }
    for node in &graph.node {
        let b = node.input.get(1).map(|name| &values[name]);
        let made = apply(node.op_type(), &values[&node.input[0]], b);
        assert!(values.insert(node.output[0].clone(), made).is_none());
    }
    values.remove("y").expect("the output")
}

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
