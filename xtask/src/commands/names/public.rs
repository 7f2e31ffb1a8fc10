//! The public types of a crate, from its sources.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use feed_axis::context::read_text;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use syn::{Ident, Item, UseTree, Visibility};

/// Name and public path of each, in the order of the sources.
pub fn types(package: &Path, crate_name: &str) -> Result<Vec<(String, String)>> {
    let file = package.join("src/lib.rs");
    let mut found = Found {
        package: package.to_owned(),
        types: BTreeSet::new(),
    };
    found.module(
        &items(&file)?,
        &package.join("src"),
        crate_name,
        &file.display().to_string(),
    )?;
    Ok(found.types.into_iter().collect())
}

struct Found {
    package: PathBuf,
    types: BTreeSet<(String, String)>,
}

impl Found {
    /// A public module: its types, what it re-exports and its public modules. Files of its modules are in `folder`.
    fn module(&mut self, items: &[Item], folder: &Path, path: &str, file: &str) -> Result<()> {
        let modules: Vec<&Ident> = items.iter().filter_map(module_name).collect();
        for item in items {
            match item {
                Item::Mod(module) if public(&module.vis) => {
                    self.inner(module, folder, path)?;
                }
                Item::Use(import) if public(&import.vis) => {
                    self.import(&import.tree, &modules, path, file)?;
                }
                other => {
                    if let Some(name) = type_name(other) {
                        self.add(name, path);
                    }
                }
            }
        }
        Ok(())
    }

    fn inner(&mut self, module: &syn::ItemMod, folder: &Path, path: &str) -> Result<()> {
        let name = module.ident.to_string();
        let (below, path) = (folder.join(&name), format!("{path}::{name}"));
        if let Some((_, items)) = &module.content {
            return self.module(items, &below, &path, &self.package.display().to_string());
        }
        let (beside, within) = (folder.join(format!("{name}.rs")), below.join("mod.rs"));
        let file = if beside.exists() { beside } else { within };
        self.module(&items(&file)?, &below, &path, &file.display().to_string())
    }

    /// `pub use`: types of this crate alone; what is another crate's has its name there.
    fn import(&mut self, tree: &UseTree, modules: &[&Ident], path: &str, file: &str) -> Result<()> {
        let UseTree::Path(first) = tree else {
            return Ok(());
        };
        let own = ["crate", "self", "super"]
            .iter()
            .any(|own| first.ident == own);
        if own || modules.contains(&&first.ident) {
            self.leaves(&first.tree, path, file)?;
        }
        Ok(())
    }

    fn leaves(&mut self, tree: &UseTree, path: &str, file: &str) -> Result<()> {
        match tree {
            UseTree::Path(inner) => self.leaves(&inner.tree, path, file)?,
            UseTree::Group(group) => {
                for tree in &group.items {
                    self.leaves(tree, path, file)?;
                }
            }
            UseTree::Name(leaf) => self.add(&leaf.ident, path),
            UseTree::Rename(leaf) => self.add(&leaf.rename, path),
            UseTree::Glob(_) => {
                return Err(miette!(
                    "{file}: `pub use …::*` hides what is public: name each"
                ));
            }
        }
        Ok(())
    }

    fn add(&mut self, name: &Ident, path: &str) {
        let name = name.to_string();
        // By Rust's naming, types alone begin with a capital and go on in small letters.
        let capital = name.starts_with(char::is_uppercase);
        if capital && (name.len() == 1 || name.contains(char::is_lowercase)) {
            let place = format!("{path}::{name}");
            self.types.insert((name, place));
        }
    }
}

fn items(file: &Path) -> Result<Vec<Item>> {
    let parsed = syn::parse_file(&read_text(file)?);
    let parsed = parsed
        .into_diagnostic()
        .wrap_err_with(|| format!("{} is not Rust", file.display()))?;
    Ok(parsed.items)
}

fn public(visibility: &Visibility) -> bool {
    matches!(visibility, Visibility::Public(_))
}

fn module_name(item: &Item) -> Option<&Ident> {
    match item {
        Item::Mod(module) => Some(&module.ident),
        _ => None,
    }
}

/// The name of a public type that is declared here.
fn type_name(item: &Item) -> Option<&Ident> {
    let (visibility, name) = match item {
        Item::Struct(item) => (&item.vis, &item.ident),
        Item::Enum(item) => (&item.vis, &item.ident),
        Item::Union(item) => (&item.vis, &item.ident),
        Item::Trait(item) => (&item.vis, &item.ident),
        Item::Type(item) => (&item.vis, &item.ident),
        _ => return None,
    };
    public(visibility).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(source: &str) -> Vec<String> {
        let package = tempfile::tempdir().unwrap();
        std::fs::create_dir(package.path().join("src")).unwrap();
        std::fs::write(package.path().join("src/lib.rs"), source).unwrap();
        let types = types(package.path(), "it").unwrap();
        types.into_iter().map(|(_, place)| place).collect()
    }

    #[test]
    fn public_are_declarations_and_re_exports_on_public_paths() {
        let inner = "mod inner { pub struct Seen; pub struct Unseen; } pub use inner::{Seen as Shown, LIMIT, run};";
        assert_eq!(of(inner), ["it::Shown"]);
        assert_eq!(
            of("pub mod a { pub enum Kind {} struct Own; }"),
            ["it::a::Kind"]
        );
        assert_eq!(
            of("pub(crate) struct Own; pub trait Law {} pub type Row = Vec<f64>;"),
            ["it::Law", "it::Row"]
        );
    }

    #[test]
    fn types_of_other_crates_are_not_counted() {
        assert!(of("pub use axis_scalar::Scalar; pub use std::ops::{Range};").is_empty());
    }
}
