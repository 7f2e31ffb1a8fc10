//! What is thought of an axis before its logs are seen.
//!
//! | constant | value | where it is from |
//! |---|---|---|
//! | nothing, effects, a law outside the library | 0.35, 0.50, 0.15 | the kinds of case of the matrix are as many |
//! | one, two, three effects | 0.80, 0.16, 0.04 | each one more is a fifth as probable |
//! | none, one, two effects beside a law | 0.70, 0.25, 0.05 | likewise |
//! | the friction's own form is the model's | 0.5 | nothing is known of it |

/// Most effects of one hypothesis, and beside a law outside the library.
pub const MOST_EFFECTS: usize = 3;
pub const MOST_BESIDE_LAW: usize = 2;

const NOTHING: f64 = 0.35;
const EFFECTS: f64 = 0.50;
const LAW: f64 = 0.15;
const SO_MANY: [f64; MOST_EFFECTS] = [0.80, 0.16, 0.04];
const BESIDE_LAW: [f64; MOST_BESIDE_LAW + 1] = [0.70, 0.25, 0.05];
const OWN_FORM: f64 = 0.5;

/// Odds of hypotheses about an axis that may have so many effects, where laws over so many
/// variables are tried.
#[derive(Clone, Copy, Debug)]
pub struct Odds {
    pub effects: usize,
    pub laws: usize,
}

impl Odds {
    /// ln of the probability of a set of so many effects, with a law outside the library or not.
    pub fn ln(self, effects: usize, with_law: bool) -> f64 {
        let sets = |k: usize| -> f64 {
            let each = (0..k).map(|i| (self.effects - i.min(self.effects)) as f64 / (i + 1) as f64);
            each.product::<f64>().max(1.0)
        };
        let share = match (effects, with_law) {
            (0, false) => NOTHING,
            (k, false) => EFFECTS * SO_MANY.get(k - 1).copied().unwrap_or(0.0),
            (k, true) => LAW * BESIDE_LAW.get(k).copied().unwrap_or(0.0) / self.laws.max(1) as f64,
        };
        (share / sets(effects)).ln()
    }

    /// ln of the probability of one of so many forms of the friction, which are there beside none.
    pub fn ln_form(forms: usize, is_none: bool) -> f64 {
        match (forms, is_none) {
            (0, _) => 0.0,
            (_, true) => OWN_FORM.ln(),
            (n, false) => ((1.0 - OWN_FORM) / n as f64).ln(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{MOST_EFFECTS, Odds};

    #[test]
    fn all_hypotheses_together_are_certain() {
        let odds = Odds {
            effects: 7,
            laws: 5,
        };
        let sets = [1.0, 7.0, 21.0, 35.0];
        let all = |with_law: bool, times: f64| -> f64 {
            let sets = sets.iter().enumerate();
            sets.map(|(k, n)| n * times * odds.ln(k, with_law).exp())
                .sum()
        };
        let sum = all(false, 1.0) + all(true, 5.0);
        assert!((sum - 1.0).abs() < 1e-12, "{sum}");
        assert_eq!(MOST_EFFECTS + 1, sets.len());
        let forms = Odds::ln_form(3, true).exp() + 3.0 * Odds::ln_form(3, false).exp();
        assert!((forms - 1.0).abs() < 1e-12);
    }
}
