//! Progress on standard error; silent where that is no terminal, or with `--quiet`.

use indicatif::{ProgressBar, ProgressStyle};

use crate::terminal::Terminal;

/// A bar over `length` units of work.
pub fn bar(what: &'static str, length: u64) -> ProgressBar {
    if Terminal::get().quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(length).with_message(what);
    // The template is a constant: where it does not parse, the default serves.
    if let Ok(style) =
        ProgressStyle::with_template("{msg:>12} [{bar:30}] {pos}/{len} {elapsed} (left {eta})")
    {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}

/// A sign of life of work whose length is not known.
pub fn spinner() -> ProgressBar {
    if Terminal::get().quiet {
        return ProgressBar::hidden();
    }
    let spinner = ProgressBar::new_spinner();
    spinner.enable_steady_tick(std::time::Duration::from_millis(120));
    spinner
}
