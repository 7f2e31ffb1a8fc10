//! One test program: what the search may be asked, and what it may not conclude.

mod controller;
mod determined;
mod fit;
mod foresight;
mod late;
mod logs;
#[path = "../../../tests/needs.rs"]
mod needs;
mod nothing_missing;
mod repeats;
mod settings;
mod starts;
