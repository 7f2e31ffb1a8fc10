//! Two rolling contacts that are preloaded against each other: two nuts on a screw, two rows of a bearing.

use crate::error::{RatingError, finite, not_negative};
use crate::life::RollingElement;

/// Steps of Newton's method; the fifth still changes digits, the sixth does not.
const STEPS: u32 = 8;

/// Loads of the two contacts, N, under an axial load (of either sign; the first takes the positive) and a preload.
///
/// The contact of a ball gives way by δ = c F^(2/3) (Hertz 1882). Both contacts are mounted against each other and keep
/// the sum of their deflections, so as long as both are loaded
///
/// ```text
/// F_1^(2/3) + F_2^(2/3) = 2 F_pr^(2/3)       F_1 − F_2 = F
/// ```
///
/// From |F| = 2^(3/2) F_pr on the second is free and the first carries F alone (Steinmeyer, *Impact of preload*: "2.83 times
/// the preload"). Rollers are taken as linear springs: F_1 = F_pr + |F|/2 up to |F| = 2 F_pr. ISO 3408-5 counts preload in
/// this manner (source not read in the standard).
///
/// # Errors
/// [`RatingError::Invalid`] of a preload below 0 or a load that is not finite.
pub fn preloaded_n(
    load_n: f64,
    preload_n: f64,
    element: RollingElement,
) -> Result<[f64; 2], RatingError> {
    let preload = not_negative("preload_n", preload_n)?;
    let load = finite("load_n", load_n)?.abs();
    let lift = match element {
        RollingElement::Ball => 8.0_f64.sqrt(),
        RollingElement::Roller => 2.0,
    };
    let more = match element {
        _ if load >= lift * preload => load,
        RollingElement::Ball => preload * of_balls(load / preload),
        RollingElement::Roller => preload + 0.5 * load,
    };
    let less = (more - load).max(0.0);
    Ok(match load_n < 0.0 {
        true => [less, more],
        false => [more, less],
    })
}

/// F_1/F_pr of balls at |F|/F_pr below 2^(3/2): with x = (F_1/F_pr)^(2/3), x^(3/2) − (2 − x)^(3/2) = |F|/F_pr.
fn of_balls(load: f64) -> f64 {
    let mut x = 1.0 + load / 8.0_f64.sqrt();
    for _ in 0..STEPS {
        let (high, low) = (x.sqrt(), (2.0 - x).max(0.0).sqrt());
        let over = x * high - (2.0 - x) * low - load;
        x = (x - over / (1.5 * (high + low))).clamp(1.0, 2.0);
    }
    x * x.sqrt()
}
