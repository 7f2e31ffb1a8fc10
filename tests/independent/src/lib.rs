//! A second simulator of the ball-screw axis of Liu, Guo, Liu and Niu, Machines
//! 2025, 13(5), 433, doi:10.3390/machines13050433.
//!
//! It makes logs on which the search for a missing effect is proved, and so shares no
//! code with the rest of the project. What differs on purpose:
//!
//! | | here | in the library |
//! |---|---|---|
//! | mesh of the screw | 40 elements in torsion | 10 Timoshenko elements |
//! | mechanics in time | implicit midpoint, steps of 10 µs | modes with an exact propagator, or Newmark |
//! | bristle in time | implicit midpoint | exponential step |
//! | currents in time | Runge–Kutta of order 4, split by halves (Strang) | implicit midpoint |
//! | onset of hidden dry friction | tanh(v / 80 µm/s) | bristle |
//! | contact with backlash | damping comes up over 50 nm | jumps to its value |
//! | random numbers | xorshift64*, Box–Muller | ChaCha8, ziggurat |
//!
//! The equations are those of the paper, with its lost signs: for the rotating chain
//! `q` (motor, torque sensor, nodes of the screw) and the table `y`,
//!
//! ```text
//! M q'' + βK q' + K q = T e_motor − r F n(y)          m y'' = F − friction − loads
//! F = k δ + βk δ',   δ = r n(y)ᵀ q + errors of the lead − y,   r = lead / 2π
//! ```
//!
//! [`HeatedScrew`] is the same axis' heat by brute force, hour by hour.
//!
//! [`slide_log`] is another machine, a slide on a linear motor whose drive has more in it than its axis file
//! says. [`bench_log`] is a motor on a bench that never rests, [`spun_log`] a small one that is spun slowly,
//! [`joint_log`] a robot joint under gravity. [`run_carriage`] is a carriage on a rack, a belt or a linear motor under a
//! drive that may be pushed and late.
//!
//! [`cases`] holds the table of what is hidden; [`write_case`] writes one as two logs to
//! fit, two to check, the axis file and the truth.

mod bench;
mod carriage;
mod carriage_drive;
pub mod cases;
mod chain;
mod drive;
mod error;
mod friction;
mod heat;
mod heat_cases;
mod heat_logs;
mod hidden;
mod joint;
mod logger;
mod machine;
mod motion;
mod motor;
mod output;
mod parameters;
mod random;
mod run;
mod slide;
mod spin;
mod truth;

pub use bench::{BenchFriction, bench_log};
pub use carriage::{Carriage, CarriageSample, Transmission, run_carriage};
pub use carriage_drive::{CarriageControl, CarriageMotor};
pub use drive::{Command, Drive, Reading};
pub use error::IndependentError;
pub use heat::{HeatLaws, HeatNumbers, HeatedScrew, Viscosity};
pub use heat_cases::{HOURS_TO_CHECK, HOURS_TO_FIT, HeatHours, Stroke, there_and_back};
pub use heat_logs::write_heat;
pub use hidden::{Bump, Cogging, Friction, Hidden, Periodic, Thermal};
pub use joint::{Joint, joint_log};
pub use logger::{Columns, Logger, Table};
pub use machine::Machine;
pub use motion::{Chirp, Motion, Setpoint, SmoothMove, exercises, s_curve};
pub use output::{Rough, log, write_case, write_slide};
pub use parameters::Parameters;
pub use random::Random;
pub use run::{LoopNoise, Push, Sample, run, run_pushed};
pub use slide::{SLIDE_CASES, SlideDrive, SlideHidden, slide_log, slide_motions};
pub use spin::{SpunBy, SpunMotor, spun_log};
pub use truth::{TrueEffect, Truth, Wanted};
