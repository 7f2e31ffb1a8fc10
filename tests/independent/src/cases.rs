//! The table of hidden cases.

use crate::error::IndependentError;
use crate::hidden::{Bump, Cogging, Friction, Hidden, Periodic, Thermal};
use crate::truth::{TrueEffect, Wanted};

/// Where a log's noise comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Noise {
    /// From sensors that the controllers read too.
    Loop,
    /// From the logger alone.
    Logger,
}

/// What is hidden: its name in cases, the machine's terms, and the library's words.
#[derive(Clone, Debug)]
pub struct Secret {
    /// The machine's terms.
    pub hidden: Hidden,
    /// The verdict that is right.
    pub verdict: Wanted,
    /// What is hidden, as the library calls it.
    pub effect: Option<TrueEffect>,
    /// What else is right.
    pub also_right: Vec<TrueEffect>,
    /// Variable and law of what is not in the library.
    pub outside: Option<[&'static str; 2]>,
}

/// A row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Name.
    pub name: &'static str,
    /// In words.
    pub words: &'static str,
    /// What is hidden.
    pub secret: fn() -> Secret,
    /// Noise.
    pub noise: Noise,
    /// Percent by which parameters may be off.
    pub off_percent: f64,
    /// Whether only time, reference, position and q current are logged.
    pub few: bool,
    /// Told from other cases by its random numbers.
    pub stream: u64,
}

/// All cases.
#[rustfmt::skip]
pub const CASES: &[Case] = &[
    row(["loop-nothing", "nothing; noise in the loop"], nothing, Noise::Loop, 0.0, 1),
    row(["loop-viscous", "viscous friction; noise in the loop"], viscous, Noise::Loop, 0.0, 2),
    row(["loop-backlash", "backlash of 8 µm; noise in the loop"], backlash, Noise::Loop, 0.0, 3),
    row(["loop-lead", "periodic lead error; noise in the loop"], lead, Noise::Loop, 0.0, 4),
    row(["loop-cogging", "cogging; noise in the loop"], cogging, Noise::Loop, 0.0, 5),
    row(["loop-thermal", "thermal growth; noise in the loop"], thermal, Noise::Loop, 0.0, 6),
    row(["loop-delay", "late current reference; noise in the loop"], delay, Noise::Loop, 0.0, 7),
    row(["logger-nothing-1", "nothing; noise of the logger"], nothing, Noise::Logger, 0.0, 8),
    row(["logger-nothing-2", "nothing; noise of the logger"], nothing, Noise::Logger, 0.0, 9),
    row(["logger-nothing-3", "nothing; noise of the logger"], nothing, Noise::Logger, 0.0, 10),
    row(["logger-viscous", "viscous friction; noise of the logger"], viscous, Noise::Logger, 0.0, 11),
    row(["tanh-coulomb", "dry friction of 94 N, tanh onset"], coulomb, Noise::Loop, 0.0, 12),
    row(["tanh-bump", "dry friction over a stretch, tanh onset"], bump, Noise::Loop, 0.0, 13),
    row(["tanh-asymmetric", "dry friction by direction, tanh onset"], asymmetric, Noise::Loop, 0.0, 14),
    row(["current-gain", "8 % too much current read"], current_gain, Noise::Loop, 0.0, 15),
    row(["position-damping", "friction with (x − x0) v"], position_damping, Noise::Loop, 0.0, 16),
    row(["off5-nothing", "nothing; parameters off 5 %"], nothing, Noise::Loop, 5.0, 17),
    row(["off5-viscous", "viscous friction; parameters off 5 %"], viscous, Noise::Loop, 5.0, 18),
    row(["off5-backlash", "backlash of 8 µm; parameters off 5 %"], backlash, Noise::Loop, 5.0, 19),
    row(["off10-nothing", "nothing; parameters off 10 %"], nothing, Noise::Loop, 10.0, 20),
    row(["off10-bump", "dry friction over a stretch; parameters off 10 %"], bump, Noise::Loop, 10.0, 21),
    row(["off20-nothing", "nothing; parameters off 20 %"], nothing, Noise::Loop, 20.0, 22),
    row(["off20-viscous", "viscous friction; parameters off 20 %"], viscous, Noise::Loop, 20.0, 23),
    row(["off20-cogging", "cogging; parameters off 20 %"], cogging, Noise::Loop, 20.0, 24),
    few("few-nothing", "nothing; parameters off 5 %, few channels", nothing, 25),
    few("few-viscous", "viscous friction; parameters off 5 %, few channels", viscous, 26),
    few("few-load", "load of 300 N from the start on; parameters off 5 %, few channels", load, 27),
    few("few-load-held", "load of 300 N, held long before; parameters off 5 %, few channels", load_held, 28),
];

const fn row(
    [name, words]: [&'static str; 2],
    secret: fn() -> Secret,
    noise: Noise,
    off_percent: f64,
    stream: u64,
) -> Case {
    Case {
        name,
        words,
        secret,
        noise,
        off_percent,
        few: false,
        stream,
    }
}

const fn few(name: &'static str, words: &'static str, secret: fn() -> Secret, stream: u64) -> Case {
    Case {
        few: true,
        ..row([name, words], secret, Noise::Loop, 5.0, stream)
    }
}

/// The case of that name.
///
/// # Errors
/// [`IndependentError::Case`] with the names that exist.
pub fn named(name: &str) -> Result<&'static Case, IndependentError> {
    let found = CASES.iter().find(|case| case.name == name);
    found.ok_or_else(|| IndependentError::Case {
        name: name.to_owned(),
        valid: CASES.iter().map(|c| c.name).collect::<Vec<_>>().join(", "),
    })
}

fn nothing() -> Secret {
    Secret {
        hidden: Hidden::default(),
        verdict: Wanted::NothingMissing,
        effect: None,
        also_right: Vec::new(),
        outside: None,
    }
}

fn of(hidden: Hidden, name: &str, parameters: &[(&str, f64)]) -> Secret {
    Secret {
        hidden,
        verdict: Wanted::Explained,
        effect: Some(TrueEffect::new(name, parameters)),
        ..nothing()
    }
}

fn rubbing(friction: Friction, name: &str, parameters: &[(&str, f64)]) -> Secret {
    let hidden = Hidden {
        friction,
        ..Hidden::default()
    };
    of(hidden, name, parameters)
}

fn viscous() -> Secret {
    let viscous = 5000.0;
    let friction = Friction {
        viscous,
        ..Friction::default()
    };
    rubbing(friction, "viscous-friction", &[("coefficient", viscous)])
}

fn dry(forward: f64, backward: f64) -> Friction {
    Friction {
        forward,
        backward,
        ..Friction::default()
    }
}

fn coulomb() -> Secret {
    rubbing(dry(94.0, 94.0), "coulomb-friction", &[("force", 94.0)])
}

fn asymmetric() -> Secret {
    let sizes = [("forward", 90.0), ("backward", 35.0)];
    rubbing(dry(90.0, 35.0), "asymmetric-friction", &sizes)
}

fn bump() -> Secret {
    let b = Bump {
        peak: 120.0,
        centre: 0.7,
        width: 0.04,
    };
    let friction = Friction {
        bump: Some(b),
        ..Friction::default()
    };
    let sizes = [("peak", b.peak), ("centre", b.centre), ("width", b.width)];
    rubbing(friction, "position-dependent-friction", &sizes)
}

fn load() -> Secret {
    let friction = Friction {
        load: 300.0,
        ..Friction::default()
    };
    rubbing(friction, "constant-load", &[("force", 300.0)])
}

fn load_held() -> Secret {
    let mut secret = load();
    secret.hidden.friction.load_held = true;
    secret
}

fn backlash() -> Secret {
    let hidden = Hidden {
        backlash: 8e-6,
        ..Hidden::default()
    };
    of(hidden, "backlash", &[("gap", 8e-6)])
}

fn lead() -> Secret {
    let [amplitude, phase] = [3e-6, 0.7];
    let hidden = Hidden {
        lead: Some(Periodic { amplitude, phase }),
        ..Hidden::default()
    };
    let sizes = [("amplitude", amplitude), ("phase", phase)];
    of(hidden, "periodic-lead-error", &sizes)
}

fn cogging() -> Secret {
    let c = Cogging {
        amplitude: 0.08,
        order: 8.0,
        phase: 1.1,
    };
    let hidden = Hidden {
        cogging: Some(c),
        ..Hidden::default()
    };
    let sizes = [
        ("amplitude", c.amplitude),
        ("order", c.order),
        ("phase", c.phase),
    ];
    of(hidden, "cogging-torque", &sizes)
}

fn thermal() -> Secret {
    let [strain, time] = [6e-5, 4.0];
    let hidden = Hidden {
        thermal: Some(Thermal { strain, time }),
        ..Hidden::default()
    };
    let sizes = [("strain", strain), ("time_constant", time)];
    of(hidden, "thermal-expansion", &sizes)
}

fn delay() -> Secret {
    let hidden = Hidden {
        delay_cycles: 2,
        ..Hidden::default()
    };
    of(hidden, "control-delay", &[("time", 2e-4)])
}

/// By the current that is read, the torque is 8 % too small, and nothing is wrong with the
/// EMF. A library without the sensor's gain has the torque constant for it.
fn current_gain() -> Secret {
    let gain = 1.0 / 0.92 - 1.0;
    let hidden = Hidden {
        current_gain: gain,
        ..Hidden::default()
    };
    let mut secret = of(hidden, "current-sensor-gain", &[("relative_change", gain)]);
    let sizes = [("relative_change", -0.08)];
    secret.also_right = vec![TrueEffect::new("torque-constant", &sizes)];
    secret
}

fn position_damping() -> Secret {
    let friction = Friction {
        slope: 2e4,
        zero: 0.65,
        ..Friction::default()
    };
    Secret {
        hidden: Hidden {
            friction,
            ..Hidden::default()
        },
        verdict: Wanted::Unknown,
        outside: Some([
            "product of position and speed",
            "force = 2e4 N·s/m² · (x − 0.65 m) · v",
        ]),
        ..nothing()
    }
}
