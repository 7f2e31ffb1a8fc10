//! One test program: exports against the Rust code.

mod equality;
mod linuxcnc;
mod onnx;
mod plan;
mod support;
