//! One test program: what the search may be asked, and what it may not conclude.

mod controller;
mod determined;
mod fit;
mod foresight;
mod logs;
mod settings;
mod starts;
