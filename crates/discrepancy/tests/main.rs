//! One test program: what the search may be asked, and what it may not conclude.

mod controller;
mod fit;
mod foresight;
mod late;
mod logs;
mod nothing_missing;
mod repeats;
mod settings;
mod starts;
