//! An axis file in another folder.

use std::path::Path;

use miette::{IntoDiagnostic, Result, WrapErr};
use toml_edit::{DocumentMut, Item, Value};

/// The text of the axis file `from` as it must be in `folder`: it names files relative
/// to its own.
pub(super) fn moved(text: &str, from: &Path, folder: &Path) -> Result<String> {
    let whole = |path: &Path| {
        path.canonicalize()
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot find {}", path.display()))
    };
    let mut document: DocumentMut = text.parse().into_diagnostic()?;
    let Some(experiment) = document
        .get_mut("experiment")
        .and_then(Item::as_table_like_mut)
    else {
        return Ok(text.to_owned());
    };
    let from = whole(&from.with_file_name("."))?;
    let folder = whole(folder)?;
    for key in ["machine", "paper_tables"] {
        let Some(value) = experiment.get_mut(key).and_then(Item::as_value_mut) else {
            continue;
        };
        let Some(named) = value.as_str().map(Path::new).filter(|p| p.is_relative()) else {
            continue;
        };
        let file = from.join(named);
        let file = file.canonicalize().unwrap_or(file);
        if let Some(path) = pathdiff::diff_paths(file, &folder) {
            let decor = value.decor().clone();
            *value = Value::from(path.display().to_string());
            *value.decor_mut() = decor;
        }
    }
    Ok(document.to_string())
}
