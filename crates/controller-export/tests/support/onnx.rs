//! An ONNX graph, evaluated operator by operator.

use std::collections::BTreeMap;

use controller_export::onnx::proto;

/// A table: columns, and numbers row by row.
pub type Table = (usize, Vec<f64>);

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

/// The output `y` of a graph for rows of its input.
pub fn evaluate(graph: &proto::Graph, x: Table) -> Table {
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
