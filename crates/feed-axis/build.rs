//! Names the program by its sources and its compiler, for results that many processes make.

use std::path::{Path, PathBuf};
use std::process::Command;

/// What the program is made of, from the workspace's root. Tests and pages are no part of it.
const SOURCES: [&str; 5] = [
    "Cargo.lock",
    "Cargo.toml",
    "crates",
    "xtask",
    "tests/independent",
];

/// The same of a package, which has no workspace around it: the lock file names the other crates and their hashes.
const PACKAGED: [&str; 4] = ["Cargo.lock", "Cargo.toml", "src", "templates"];

fn main() {
    // As it is now, not as it was when this script was compiled: checkouts may share a target folder.
    let own = std::env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR");
    let own = Path::new(&own);
    let workspace = own.join("../..");
    let (root, sources) = if workspace.join("xtask").is_dir() {
        (workspace, &SOURCES[..])
    } else {
        (own.to_owned(), &PACKAGED[..])
    };
    let mut files = Vec::new();
    for source in sources {
        collect(&root.join(source), &mut files);
    }
    files.sort();
    let mut hasher = blake3::Hasher::new();
    for file in &files {
        // Not the folders: those hold tests too, and a new file is named in an old one.
        println!("cargo:rerun-if-changed={}", file.display());
        let name = file.strip_prefix(&root).unwrap_or(file).to_string_lossy();
        let content = std::fs::read(file).unwrap_or_default();
        for part in [name.as_bytes(), &content] {
            hasher.update(&(part.len() as u64).to_le_bytes());
            hasher.update(part);
        }
    }
    let hash = hasher.finalize().to_hex();
    println!("cargo:rustc-env=PROGRAM_SOURCES={}", &hash.as_str()[..32]);
    println!("cargo:rustc-env=PROGRAM_COMPILER={}", compiler());
}

/// The files below a path; of folders those from which the program is built.
fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    const NO_PART: [&str; 4] = ["tests", "benches", "examples", "README.md"];
    let Ok(entries) = std::fs::read_dir(path) else {
        return files.push(path.to_owned());
    };
    for entry in entries.flatten() {
        let name = entry.file_name();
        if !NO_PART.iter().any(|other| name == *other) {
            collect(&entry.path(), files);
        }
    }
}

/// Compiler, target, instruction set and optimisation: code for another may round otherwise.
fn compiler() -> String {
    let variable = |name: &str| std::env::var(name).unwrap_or_default();
    let version = Command::new(variable("RUSTC")).arg("--version").output();
    let version = version.map(|output| output.stdout).unwrap_or_default();
    let version = String::from_utf8_lossy(&version).trim().to_owned();
    format!(
        "{version}, {} {}, opt-level {}",
        variable("TARGET"),
        variable("CARGO_CFG_TARGET_FEATURE"),
        variable("OPT_LEVEL")
    )
}
