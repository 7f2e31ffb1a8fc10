//! The course of a power over a duty, in memory that does not grow with it.

/// Stretches beyond which neighbours are joined.
const MOST: usize = 1 << 14;

/// Power over time in stretches of constant power. Neighbours of a long duty are joined, two by two; energy and
/// duration stay exact.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PowerCourse {
    /// Duration (s) and energy (J).
    stretches: Vec<[f64; 2]>,
    /// How many pushes make one stretch; 0 before the first.
    together: u64,
    /// How many are in the last one.
    in_last: u64,
}

impl PowerCourse {
    /// Adds a stretch.
    pub fn push(&mut self, duration_s: f64, power_w: f64) {
        let energy = duration_s * power_w;
        let together = self.together.max(1);
        match self.stretches.last_mut() {
            Some([duration, sum]) if self.in_last < together => {
                *duration += duration_s;
                *sum += energy;
                self.in_last += 1;
            }
            _ => {
                self.stretches.push([duration_s, energy]);
                self.in_last = 1;
            }
        }
        self.together = together;
        if self.stretches.len() >= 2 * MOST && self.in_last == together {
            self.join();
        }
    }

    fn join(&mut self) {
        let joined = self.stretches.chunks(2).map(|pair| {
            let sum = |i: usize| pair.iter().map(|stretch| stretch[i]).sum();
            [sum(0), sum(1)]
        });
        self.stretches = joined.collect();
        self.together *= 2;
        self.in_last = self.together;
    }

    /// Duration, s.
    pub fn duration_s(&self) -> f64 {
        self.stretches.iter().map(|[duration, _]| duration).sum()
    }

    /// Mean power, W; 0 before anything was added.
    pub fn mean_w(&self) -> f64 {
        let (duration, energy) = (
            self.duration_s(),
            self.stretches.iter().map(|[_, e]| e).sum::<f64>(),
        );
        match duration > 0.0 {
            true => energy / duration,
            false => 0.0,
        }
    }

    /// Its stretches: duration, s, and power, W.
    pub fn stretches(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        let some = self
            .stretches
            .iter()
            .filter(|[duration, _]| *duration > 0.0);
        some.map(|[duration, energy]| [*duration, energy / duration])
    }
}
