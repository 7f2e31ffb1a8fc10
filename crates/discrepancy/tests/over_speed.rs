//! A friction that changes over all speeds is neither dry friction of another onset nor Stribeck friction.

use discrepancy::Verdict;

use crate::bench::{beside, discover};

/// A drag that saturates at a quarter of the greatest speed, 12.6 rad/s, as no effect of the library does.
#[test]
fn a_drag_that_saturates_is_a_law_over_speed() {
    for noise in [1e-3, 2e-2] {
        let saturates = beside(|_, _, speed| 0.7 * speed / speed.hypot(3.0), noise);
        let found = discover([saturates; 2]);
        assert_eq!(found.verdict, Verdict::Unknown);
        assert!(found.effects.is_empty(), "{:?}", found.effects);
        let unknown = found.unknown.unwrap();
        assert_eq!(unknown.depends_on, "speed");
        for (speed, value) in unknown.curve.at.iter().zip(&unknown.curve.value) {
            let drag = 0.7 * speed / speed.hypot(3.0);
            assert!((value - drag).abs() < 0.05, "{value} at {speed}: {drag}");
        }
    }
}
