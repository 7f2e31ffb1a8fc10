//! The graph of a network.

use cfnn::{Network, Range};

use super::proto::{
    Attribute, DOUBLE, Dimension, Graph, INTEGER, Node, Shape, Tensor, TensorType, Type, ValueInfo,
};

/// A graph that grows node by node.
pub(super) struct Builder {
    graph: Graph,
    inputs: usize,
    outputs: usize,
}

impl Builder {
    /// All nodes of a network, from `x` to `y`.
    pub fn new(network: &Network) -> Self {
        let shape = network.shape();
        let mut builder = Self {
            graph: Graph {
                name: Some("cascade_forward".to_owned()),
                ..Graph::default()
            },
            inputs: shape.inputs,
            outputs: shape.outputs,
        };
        builder.scale(network.scaling().input());
        let layers = shape.layers();
        let mut seen = "scaled".to_owned();
        for (number, layer) in layers.iter().enumerate() {
            let weights = &network.weights()[layer.first_parameter..][..layer.parameters()];
            let (bias, weights) = weights.split_at(layer.neurons);
            let sum = builder.affine(number, &seen, weights, bias);
            if number + 1 == layers.len() {
                builder.unscale(&sum, network.scaling().output());
            } else {
                seen = builder.cascade(number, &seen, &sum);
            }
        }
        builder
    }

    /// The graph, its input and its output documented.
    pub fn finish(mut self, inputs: &str, outputs: &str) -> Graph {
        self.graph.input = vec![value("x", self.inputs, inputs)];
        self.graph.output = vec![value("y", self.outputs, outputs)];
        self.graph
    }

    /// (x − minimum) gain − 1, as the network does it.
    fn scale(&mut self, ranges: &[Range<f64>]) {
        let least: Vec<f64> = ranges.iter().map(Range::minimum).collect();
        let gain: Vec<f64> = ranges.iter().map(Range::gain).collect();
        let width = ranges.len();
        self.constant("input_minimum", &[width], &least);
        self.constant("input_gain", &[width], &gain);
        self.constant("one", &[1], &[1.0]);
        self.node("Sub", &["x", "input_minimum"], "above_minimum");
        self.node("Mul", &["above_minimum", "input_gain"], "widths");
        self.node("Sub", &["widths", "one"], "scaled");
    }

    /// (ŷ + 1) half width + minimum.
    fn unscale(&mut self, sum: &str, ranges: &[Range<f64>]) {
        let least: Vec<f64> = ranges.iter().map(Range::minimum).collect();
        let half: Vec<f64> = ranges.iter().map(Range::half_width).collect();
        self.constant("output_minimum", &[least.len()], &least);
        self.constant("output_half_width", &[half.len()], &half);
        self.node("Add", &[sum, "one"], "above_least");
        self.node("Mul", &["above_least", "output_half_width"], "way");
        self.node("Add", &["way", "output_minimum"], "y");
    }

    /// The sums of a layer.
    fn affine(&mut self, layer: usize, seen: &str, weights: &[f64], bias: &[f64]) -> String {
        let [w, b, product, sum] =
            ["weights", "bias", "product", "sum"].map(|what| format!("{what}_{layer}"));
        self.constant(&w, &[weights.len() / bias.len(), bias.len()], weights);
        self.constant(&b, &[bias.len()], bias);
        self.node("MatMul", &[seen, &w], &product);
        self.node("Add", &[&product, &b], &sum);
        sum
    }

    /// tansig of a layer's sums beside what it saw.
    fn cascade(&mut self, layer: usize, seen: &str, sum: &str) -> String {
        let [hidden, both] = ["hidden", "seen"].map(|what| format!("{what}_{layer}"));
        self.node("Tanh", &[sum], &hidden);
        self.node("Concat", &[seen, &hidden], &both);
        let axis = Attribute {
            name: Some("axis".to_owned()),
            i: Some(1),
            r#type: Some(INTEGER),
        };
        if let Some(node) = self.graph.node.last_mut() {
            node.attribute.push(axis);
        }
        both
    }

    fn node(&mut self, operator: &str, inputs: &[&str], output: &str) {
        self.graph.node.push(Node {
            input: inputs.iter().map(|&name| name.to_owned()).collect(),
            output: vec![output.to_owned()],
            name: Some(format!("make_{output}")),
            op_type: Some(operator.to_owned()),
            attribute: Vec::new(),
        });
    }

    fn constant(&mut self, name: &str, dims: &[usize], values: &[f64]) {
        self.graph.initializer.push(Tensor {
            dims: dims.iter().map(|&length| length as i64).collect(),
            data_type: Some(DOUBLE),
            name: Some(name.to_owned()),
            raw_data: Some(values.iter().flat_map(|v| v.to_le_bytes()).collect()),
        });
    }
}

/// A table of any number of rows.
fn value(name: &str, columns: usize, meaning: &str) -> ValueInfo {
    let rows = Dimension {
        dim_value: None,
        dim_param: Some("samples".to_owned()),
    };
    let columns = Dimension {
        dim_value: Some(columns as i64),
        dim_param: None,
    };
    let tensor = TensorType {
        elem_type: Some(DOUBLE),
        shape: Some(Shape {
            dim: vec![rows, columns],
        }),
    };
    ValueInfo {
        name: Some(name.to_owned()),
        r#type: Some(Type {
            tensor_type: Some(tensor),
        }),
        doc_string: Some(meaning.to_owned()),
    }
}
