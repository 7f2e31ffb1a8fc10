//! The committed JSON Schemas, where editors find them.

use std::path::Path;

use serde_json::Value;

/// A schema as it is committed.
pub fn committed(name: &str) -> Value {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/schemas");
    let text = std::fs::read_to_string(folder.join(format!("{name}.json"))).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Holds a file against its schema.
pub fn assert_validates(name: &str, file: &Value) {
    let validator = jsonschema::draft202012::new(&committed(name)).unwrap();
    let errors: Vec<String> = validator
        .iter_errors(file)
        .map(|e| format!("{}: {e}", e.instance_path()))
        .collect();
    assert!(errors.is_empty(), "{name}: {errors:#?}");
}
