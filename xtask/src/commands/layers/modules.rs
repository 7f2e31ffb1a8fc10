//! The modules of a crate, and which file takes which names from which.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use feed_axis::context::read_text;
use miette::{Result, miette};
use proc_macro2::TokenStream;

use super::tokens::{Content, Import, content};

/// Names that a file takes, by the file that takes and the file that defines them.
pub type Takes = BTreeMap<(PathBuf, PathBuf), BTreeSet<String>>;

/// More re-exports than that lead from a name to its definition only in a circle.
const MOST_HOPS: usize = 32;

/// What the files of a crate take from one another, from the file of its root on.
///
/// `mod` is no import, nor is the face of a module: a `pub use` of what lies below it, unless the module itself needs it.
/// A name that was re-exported is taken from the file that defines it and from the one that shows it. A module is a part
/// of the one around it, the root apart, so that what it takes from there counts as that one's own.
pub fn takes(root: &Path) -> Result<Takes> {
    let folder = root.parent().unwrap_or(Path::new("."));
    let mut tree = Tree::default();
    tree.add(None, root, folder, read(root)?)?;
    let mut takes = Takes::new();
    for (at, module) in tree.modules.iter().enumerate() {
        for path in module.needs() {
            let Some(name) = path.last() else { continue };
            for taken in tree.taken(at, path) {
                let from = &tree.modules[taken].file;
                if !tree.is_within(at, from) {
                    let key = (module.file.clone(), from.clone());
                    takes.entry(key).or_default().insert(name.clone());
                }
            }
        }
    }
    Ok(takes)
}

#[derive(Default)]
struct Tree {
    modules: Vec<Module>,
}

struct Module {
    file: PathBuf,
    parent: Option<usize>,
    children: BTreeMap<String, usize>,
    items: BTreeSet<String>,
    imports: Vec<Import>,
    paths: BTreeSet<Vec<String>>,
}

/// Where a name of a module leads.
enum Found {
    Module(usize),
    /// Defined in that module.
    Item(usize),
}

impl Tree {
    /// Adds a module and all below it; the files of those lie in `folder`.
    fn add(
        &mut self,
        parent: Option<usize>,
        file: &Path,
        folder: &Path,
        content: Content,
    ) -> Result<usize> {
        let at = self.modules.len();
        self.modules.push(Module {
            file: file.to_owned(),
            parent,
            children: BTreeMap::new(),
            items: content.items,
            imports: content.imports,
            paths: content.paths,
        });
        for (name, inner) in content.inline {
            let child = self.add(Some(at), file, &folder.join(&name), inner)?;
            self.modules[at].children.insert(name, child);
        }
        for name in content.files {
            let below = folder.join(&name);
            let (beside, within) = (folder.join(format!("{name}.rs")), below.join("mod.rs"));
            let own = if beside.exists() { beside } else { within };
            let child = self.add(Some(at), &own, &below, read(&own)?)?;
            self.modules[at].children.insert(name, child);
        }
        Ok(at)
    }

    /// Whether a module stands in this file, or in a module of it.
    fn is_within(&self, at: usize, file: &Path) -> bool {
        let parent = |module: &usize| self.modules[*module].parent.filter(|parent| *parent != 0);
        std::iter::successors(Some(at), parent).any(|module| self.modules[module].file == file)
    }

    /// The modules that a path takes a name from: the one that defines it, and the one that it is asked of, which shows it.
    /// Of a whole module, that. None for other crates.
    fn taken(&self, at: usize, path: &[String]) -> impl Iterator<Item = usize> {
        let place = &path[..path.len().saturating_sub(1)];
        let asked = || {
            self.find(at, place, MOST_HOPS)
                .filter(|_| !place.is_empty())
        };
        let (defines, asked) = match self.find(at, path, MOST_HOPS) {
            Some(Found::Item(module)) => (Some(module), asked()),
            Some(Found::Module(module)) => (Some(module), None),
            None => (None, None),
        };
        let shows = match asked {
            Some(Found::Module(module)) => Some(module),
            Some(Found::Item(_)) | None => None,
        };
        defines.into_iter().chain(shows)
    }

    fn find(&self, at: usize, path: &[String], hops: usize) -> Option<Found> {
        let mut here = at;
        for (place, name) in path.iter().enumerate() {
            let last = place + 1 == path.len();
            here = match name.as_str() {
                "crate" => 0,
                "self" => here,
                "super" => self.modules[here].parent?,
                _ => match self.name(here, name, last, hops)? {
                    Found::Module(module) => module,
                    item @ Found::Item(_) => return Some(item),
                },
            };
        }
        Some(Found::Module(here))
    }

    /// What a name means in a module: before more of a path, a module stands before a function of the same name.
    fn name(&self, at: usize, name: &str, last: bool, hops: usize) -> Option<Found> {
        let hops = hops.checked_sub(1)?;
        let module = &self.modules[at];
        let child = module.children.get(name).map(|child| Found::Module(*child));
        if !last && child.is_some() {
            return child;
        }
        if module.items.contains(name) {
            return Some(Found::Item(at));
        }
        let mut faces = module.imports.iter();
        let named = faces.find_map(|import| {
            let own = import.name.as_deref() == Some(name);
            own.then(|| self.find(at, &import.path, hops)).flatten()
        });
        let all = || {
            let mut globs = module.imports.iter().filter(|import| import.name.is_none());
            globs.find_map(|glob| match self.find(at, &glob.path, hops)? {
                Found::Module(other) if other != at => self.name(other, name, last, hops),
                _ => None,
            })
        };
        named.or(child).or_else(all)
    }
}

impl Module {
    /// What the module's own lines need: imports, and paths in its bodies.
    fn needs(&self) -> impl Iterator<Item = &[String]> {
        let private = self.imports.iter().filter(|import| !self.is_face(import));
        let imported = private.map(|import| import.path.as_slice());
        let own = self.paths.iter().map(Vec::as_slice);
        imported.chain(own)
    }

    /// A `pub use` of what lies below.
    fn is_face(&self, import: &Import) -> bool {
        let mut names = import.path.iter().filter(|name| *name != "self");
        import.public
            && names
                .next()
                .is_some_and(|first| self.children.contains_key(first))
    }
}

fn read(file: &Path) -> Result<Content> {
    let text = read_text(file)?;
    let wrong = |error: String| miette!("{} is not Rust: {error}", file.display());
    let tokens: TokenStream = text
        .parse()
        .map_err(|e: proc_macro2::LexError| wrong(e.to_string()))?;
    content(tokens).map_err(|e| wrong(e.to_string()))
}
