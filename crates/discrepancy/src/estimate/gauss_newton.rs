//! Gauss–Newton: linearise, step towards the linearised minimum, shorten the step
//! until it helps, and begin again.

/// How long a descent goes on.
#[derive(Clone, Copy, Debug)]
pub struct Descent {
    /// Rounds at most.
    pub rounds: usize,
    /// Lengths of a step that are tried in a round, the whole one first.
    pub lengths: usize,
    /// Ratio of one length to the one before.
    pub shorter: f64,
}

impl Descent {
    /// Goes downhill from `start`. `step` solves the linearised problem, `None` if
    /// nothing is to be gained; `better` is the point a share of the step on, where that
    /// is lower; `goes_on` compares a point with the one before.
    pub fn from<P, S>(
        self,
        start: P,
        step: impl Fn(&P) -> Option<S>,
        better: impl Fn(&P, &S, f64) -> Option<P>,
        goes_on: impl Fn(&P, &P) -> bool,
    ) -> P {
        let mut at = start;
        for _ in 0..self.rounds {
            let Some(step) = step(&at) else { break };
            let mut length = 1.0;
            let mut next = None;
            for _ in 0..self.lengths {
                next = better(&at, &step, length);
                if next.is_some() {
                    break;
                }
                length *= self.shorter;
            }
            let Some(next) = next else { break };
            let more = goes_on(&at, &next);
            at = next;
            if !more {
                break;
            }
        }
        at
    }
}

#[cfg(test)]
mod tests {
    use super::Descent;

    /// From 3 on Newton's step for atan(x) = 0 leaps to −9.5 and on, so whole steps never
    /// come back.
    #[test]
    fn a_step_is_shortened_until_it_helps() {
        let descent = |lengths| Descent {
            rounds: 30,
            lengths,
            shorter: 0.5,
        };
        let find = |lengths| {
            let step = |x: &f64| Some(-x.atan() * (1.0 + x * x));
            let better = |x: &f64, s: &f64, length: f64| {
                let next = x + length * s;
                (next.atan().abs() < x.atan().abs()).then_some(next)
            };
            descent(lengths).from(3.0, step, better, |x, next| (x - next).abs() > 1e-14)
        };
        assert!(find(8).abs() < 1e-14, "{}", find(8));
        assert_eq!(find(1), 3.0);
    }
}
