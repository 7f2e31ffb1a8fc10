//! What crates.io asks of a crate (The Cargo Book, chapters "Publishing on crates.io" and "The
//! Manifest Format"), and this project besides.

use std::collections::BTreeMap;

use crate::packages::Package;

/// What a crate lacks, a line each; `versions` are those of the crates that come before it.
pub fn lacking(package: &Package, versions: &BTreeMap<&str, &str>) -> Vec<String> {
    let mut lacks = fields(package);
    lacks.extend(keywords(&package.keywords));
    lacks.extend(dependencies(package, versions));
    for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
        let own = std::fs::read(package.folder().join(licence)).ok();
        if own.is_none() || own != std::fs::read(crate::packages::root().join(licence)).ok() {
            lacks.push(format!(
                "no {licence} with the text of the project's: link it to ../../{licence}"
            ));
        }
    }
    lacks
}

fn fields(package: &Package) -> Vec<String> {
    let readme = package.readme.as_ref();
    let has_readme = readme.is_some_and(|file| package.folder().join(file).is_file());
    let asked = [
        (package.description.is_some(), "a `description`"),
        (package.license.is_some(), "a `license`"),
        (package.rust_version.is_some(), "a `rust-version`"),
        (!package.keywords.is_empty(), "`keywords`"),
        (!package.categories.is_empty(), "`categories`"),
        (has_readme, "a README.md that its `readme` names"),
    ];
    let missing = asked.into_iter().filter(|(there, _)| !there);
    let mut lacks: Vec<String> = missing.map(|(_, what)| format!("no {what}")).collect();
    if package.categories.len() > 5 {
        lacks.push("more than 5 categories".into());
    }
    lacks
}

/// At most five; letters, digits, `_`, `-` and `+`, with a letter or digit first, 20 at most.
fn keywords(keywords: &[String]) -> Vec<String> {
    let valid = |word: &str| {
        word.len() <= 20
            && word.starts_with(|c: char| c.is_ascii_alphanumeric())
            && word
                .chars()
                .all(|c| c.is_ascii_alphanumeric() || "_-+".contains(c))
    };
    let wrong = keywords.iter().filter(|word| !valid(word));
    let mut lacks: Vec<String> = wrong
        .map(|word| format!("the keyword `{word}`: letters, digits, `_`, `-`, `+`, 20 at most"))
        .collect();
    if keywords.len() > 5 {
        lacks.push("more than 5 keywords".into());
    }
    lacks
}

/// A published crate is found by its version alone, and only where it was published before.
fn dependencies(package: &Package, versions: &BTreeMap<&str, &str>) -> Vec<String> {
    let within = package.dependencies.iter().filter(|d| d.path.is_some());
    within
        .filter_map(|dependency| {
            let name = &dependency.name;
            match versions.get(name.as_str()) {
                None => Some(format!("depends on {name}, which is not published before it")),
                Some(version) if dependency.req != format!("^{version}") => Some(format!(
                    "asks for {name} {}, which is {version}: `version = \"{version}\"` beside its path",
                    dependency.req
                )),
                Some(_) => None,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keywords_are_those_that_the_registry_takes() {
        let of =
            |words: &[&str]| keywords(&words.iter().map(|w| (*w).to_owned()).collect::<Vec<_>>());
        assert!(of(&["no-std", "f32", "c++"]).is_empty());
        for wrong in ["servo axis", "-std", "gewindetrieb-simulation", "µm"] {
            assert_eq!(of(&[wrong]).len(), 1, "{wrong}");
        }
        assert_eq!(
            of(&["a", "b", "c", "d", "e", "f"]),
            ["more than 5 keywords"]
        );
    }
}
