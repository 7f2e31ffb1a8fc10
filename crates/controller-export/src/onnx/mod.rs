//! A cascade-forward network as ONNX, its scaling inside.
//!
//! ```text
//! x ─ Sub ─ Mul ─ Sub ─┬─ MatMul ─ Add ─ Tanh ─┐
//!                      └──────── Concat ───────┴─ … ─ MatMul ─ Add ─ Add ─ Mul ─ Add ─ y
//! ```
//!
//! Inputs and outputs are in SI units, one sample a row, in `f64`. Opset 17. What its columns
//! are stands in the metadata and in the documentation of input and output.

mod graph;
pub mod proto;

use axis_pipeline::PipelineError;
use axis_pipeline::strategies::{Need, Predictors};
use cfnn::Network;
use prost::Message;

use crate::{ExportError, Units};
use graph::Builder;
use proto::{Model, OperatorSet, StringEntry};

/// The version of ONNX' operators that is used.
pub const OPSET: i64 = 17;
/// The version of the format that belongs to it.
const IR_VERSION: i64 = 8;

/// A column of the input or of the output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NetworkSignal {
    /// Its name: a word.
    pub name: String,
    /// Its SI unit.
    pub unit: String,
}

/// What a network is, for those who get its file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Description {
    /// What it computes, in a line.
    pub summary: String,
    /// Its inputs, in their order.
    pub inputs: Vec<NetworkSignal>,
    /// Its outputs.
    pub outputs: Vec<NetworkSignal>,
    /// More names and values for the metadata.
    pub metadata: Vec<(String, String)>,
}

/// The one-cycle network of the predictors, with its description.
///
/// # Errors
/// [`ExportError::Pipeline`] if there is none.
pub fn one_cycle(predictors: &Predictors) -> Result<Vec<u8>, ExportError> {
    let network = predictors.network.as_ref().ok_or(PipelineError::Missing {
        need: Need::Network,
        by: "an export as ONNX".to_owned(),
    })?;
    let (axis, units) = (&predictors.axis, Units::of(&predictors.axis));
    let column = |name: &str, unit: String| NetworkSignal {
        name: name.to_owned(),
        unit,
    };
    let load = &units.load;
    let summary = format!(
        "one control cycle of the axis {}: how far its load moves",
        axis.name
    );
    let description = Description {
        summary,
        inputs: vec![
            column("position", load.clone()),
            column("velocity", format!("{load}/s")),
            column("acceleration", format!("{load}/s^2")),
            column("command", units.effort.clone()),
        ],
        outputs: vec![column("increment", load.clone())],
        metadata: vec![
            ("axis".to_owned(), axis.name.clone()),
            ("axis_fingerprint".to_owned(), axis.fingerprint.clone()),
            ("control_period_s".to_owned(), format!("{:?}", axis.period)),
        ],
    };
    export(network, &description)
}

/// A network as the bytes of an ONNX file.
///
/// # Errors
/// [`ExportError::Network`] if the description has another number of inputs or outputs, or a layer is not
/// tansig.
pub fn export(network: &Network, description: &Description) -> Result<Vec<u8>, ExportError> {
    network.architecture().require_tansig()?;
    let shape = network.shape();
    let counts = [
        ("described inputs", description.inputs.len(), shape.inputs),
        (
            "described outputs",
            description.outputs.len(),
            shape.outputs,
        ),
    ];
    for (what, found, expected) in counts {
        if found != expected {
            let length = cfnn::Error::Length {
                what,
                found,
                expected,
            };
            return Err(length.into());
        }
    }
    let list = |columns: &[NetworkSignal]| {
        let each = columns
            .iter()
            .map(|c| format!("{} {}", c.name, c.unit).trim_end().to_owned());
        each.collect::<Vec<_>>().join(", ")
    };
    let (inputs, outputs) = (list(&description.inputs), list(&description.outputs));
    let graph = Builder::new(network).finish(&inputs, &outputs);
    let own = [("inputs", inputs), ("outputs", outputs)];
    let own = own.map(|(key, value)| (key.to_owned(), value));
    let all = own.into_iter().chain(description.metadata.iter().cloned());
    let model = Model {
        ir_version: Some(IR_VERSION),
        producer_name: Some(env!("CARGO_PKG_NAME").to_owned()),
        producer_version: Some(env!("CARGO_PKG_VERSION").to_owned()),
        doc_string: Some(description.summary.clone()),
        graph: Some(graph),
        opset_import: vec![OperatorSet {
            domain: Some(String::new()),
            version: Some(OPSET),
        }],
        metadata_props: all
            .map(|(key, value)| StringEntry {
                key: Some(key),
                value: Some(value),
            })
            .collect(),
    };
    Ok(model.encode_to_vec())
}
