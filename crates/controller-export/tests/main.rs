//! One test program: exports against the Rust code.

mod equality;
mod firmware;
mod linuxcnc;
#[path = "../../../tests/needs.rs"]
mod needs;
mod onnx;
mod plan;
mod support;
