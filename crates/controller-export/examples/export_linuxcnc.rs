//! The LinuxCNC component of every strategy, with an example of its use.
//!
//! `cargo run -p controller-export --example export_linuxcnc -- FOLDER`

#[path = "../tests/support/mod.rs"]
mod support;

use std::path::PathBuf;

use controller_export::{Controller, EXPORTED, linuxcnc};
use support::{Outcome, laws, samples};

fn main() -> Outcome<()> {
    let folder = std::env::args().nth(1);
    let folder = PathBuf::from(folder.ok_or("usage: export_linuxcnc FOLDER")?);
    std::fs::create_dir_all(&folder)?;
    let predictors = laws::predictors(&samples::axis()?)?;
    for &name in EXPORTED {
        let controller = Controller::of(&predictors, name, laws::LIMITS)?;
        let made = linuxcnc::export(&controller)?;
        for text in [made.component, made.example] {
            std::fs::write(folder.join(&text.name), &text.text)?;
        }
    }
    Ok(())
}
