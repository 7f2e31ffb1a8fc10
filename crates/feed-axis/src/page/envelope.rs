//! A signal over time in bounded memory: every figure of it exact, and the points that a picture needs.

/// Most points in time that are kept, each with the least and the greatest value since the one before: far
/// more than a page has columns to draw them in.
const MOST: usize = 1 << 15;

/// A signal, sample by sample.
///
/// Up to [`MOST`] samples are kept as they are. Beyond that each bin stands for two, four, eight ... of
/// them, with the least and the greatest and when they were: no peak is lost, however long the signal is.
#[derive(Clone, Debug)]
pub struct Envelope {
    bins: Vec<Bin>,
    /// Samples in each bin but the last.
    stride: usize,
    /// Samples in the last bin.
    filled: usize,
    /// The first and the last sample.
    ends: Option<[[f64; 2]; 2]>,
    sizes: Sizes,
}

/// What is exact over all samples.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sizes {
    count: u64,
    /// Greatest magnitude.
    pub peak: f64,
    /// When it was first reached, s.
    pub peak_at: f64,
    /// The last sample.
    pub last: f64,
    sum: f64,
    squares: f64,
}

/// The extremes of neighbouring samples, each with its time.
#[derive(Clone, Copy, Debug)]
struct Bin {
    low: [f64; 2],
    high: [f64; 2],
}

impl Sizes {
    /// Root of the mean square.
    pub fn rms(&self) -> f64 {
        (self.squares / self.counted()).sqrt()
    }

    /// Mean of the magnitudes.
    pub fn mean(&self) -> f64 {
        self.sum / self.counted()
    }

    fn counted(&self) -> f64 {
        self.count.max(1) as f64
    }

    fn push(&mut self, [time, value]: [f64; 2]) {
        if value.abs() > self.peak || self.count == 0 {
            (self.peak, self.peak_at) = (value.abs(), time);
        }
        self.count += 1;
        self.last = value;
        self.sum += value.abs();
        self.squares += value * value;
    }
}

impl Bin {
    fn join(&mut self, other: &Self) {
        if other.low[1] < self.low[1] {
            self.low = other.low;
        }
        if other.high[1] > self.high[1] {
            self.high = other.high;
        }
    }
}

impl Default for Envelope {
    fn default() -> Self {
        Self {
            bins: Vec::new(),
            stride: 1,
            filled: 0,
            ends: None,
            sizes: Sizes::default(),
        }
    }
}

impl Envelope {
    /// Adds a sample, later than those before.
    pub fn push(&mut self, time: f64, value: f64) {
        let point = [time, value];
        self.sizes.push(point);
        self.ends = Some([self.ends.map_or(point, |[first, _]| first), point]);
        let bin = Bin {
            low: point,
            high: point,
        };
        match self.bins.last_mut() {
            Some(last) if self.filled < self.stride => last.join(&bin),
            _ => {
                self.make_room();
                self.bins.push(bin);
                self.filled = 0;
            }
        }
        self.filled += 1;
    }

    /// Joins neighbours where all bins are taken.
    fn make_room(&mut self) {
        if self.bins.len() < MOST {
            return;
        }
        for k in 0..MOST / 2 {
            let [mut bin, next] = [self.bins[2 * k], self.bins[2 * k + 1]];
            bin.join(&next);
            self.bins[k] = bin;
        }
        self.bins.truncate(MOST / 2);
        self.stride *= 2;
    }

    /// The figures of all samples.
    pub fn sizes(&self) -> &Sizes {
        &self.sizes
    }

    /// Samples of which each pair of points holds the least and the greatest; with 2, all are there.
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// Times and values of the points, in the order of time.
    pub fn points(&self) -> (Vec<f64>, Vec<f64>) {
        let ordered = |bin: &Bin| match bin.low[0].total_cmp(&bin.high[0]) {
            std::cmp::Ordering::Less => [Some(bin.low), Some(bin.high)],
            std::cmp::Ordering::Equal => [Some(bin.low), None],
            std::cmp::Ordering::Greater => [Some(bin.high), Some(bin.low)],
        };
        let mut points: Vec<[f64; 2]> = self.bins.iter().flat_map(ordered).flatten().collect();
        // A line begins and ends where the signal does.
        if let (Some([first, last]), Some([begin, end])) = (self.ends, ends(&points)) {
            if end[0] < last[0] {
                points.push(last);
            }
            if begin[0] > first[0] {
                points.insert(0, first);
            }
        }
        points
            .into_iter()
            .map(|[time, value]| (time, value))
            .unzip()
    }
}

fn ends(points: &[[f64; 2]]) -> Option<[[f64; 2]; 2]> {
    Some([*points.first()?, *points.last()?])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slow wave with a spike each way, one sample long.
    fn samples(count: usize) -> impl Iterator<Item = [f64; 2]> {
        let spikes = [count / 3, count / 3 * 2 + 1];
        (0..count).map(move |k| {
            let value = match spikes.iter().position(|&at| at == k) {
                Some(0) => 7.5,
                Some(_) => -9.25,
                None => (1e-3 * k as f64).sin(),
            };
            [1e-4 * k as f64, value]
        })
    }

    fn of(count: usize) -> Envelope {
        let mut envelope = Envelope::default();
        samples(count).for_each(|[time, value]| envelope.push(time, value));
        envelope
    }

    #[test]
    fn a_short_signal_is_kept_as_it_is() {
        for count in [1, 2, MOST - 1, MOST, 2 * MOST] {
            let (times, values) = of(count).points();
            let (t, v): (Vec<f64>, Vec<f64>) = samples(count).map(|[t, v]| (t, v)).unzip();
            assert!(times == t && values == v, "{count}");
        }
    }

    /// An hour at 4 kHz: as many points as a minute, and no peak less.
    #[test]
    fn what_is_kept_does_not_grow_with_the_signal() {
        for count in [5 * MOST / 2, 10 * MOST + 7, 14_400_000] {
            let envelope = of(count);
            let (times, values) = envelope.points();
            assert!(
                times.len() <= 2 * MOST + 2 && times.len() >= MOST / 2,
                "{}",
                times.len()
            );
            assert!(envelope.bins.capacity() <= 2 * MOST);
            assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
            assert_eq!(
                [times[0], times[times.len() - 1]],
                [0.0, 1e-4 * (count - 1) as f64]
            );
            let place = |sought: f64| values.iter().position(|v| *v == sought).unwrap();
            let [up, down] = [place(7.5), place(-9.25)];
            assert_eq!(times[up], 1e-4 * (count / 3) as f64);
            assert_eq!(times[down], 1e-4 * (count / 3 * 2 + 1) as f64);
        }
    }

    #[test]
    fn figures_are_those_of_all_samples() {
        let count = 3 * MOST + 11;
        let values: Vec<f64> = samples(count).map(|[_, v]| v).collect();
        let envelope = of(count);
        let sizes = envelope.sizes();
        let n = count as f64;
        assert_eq!((sizes.peak, sizes.last), (9.25, values[count - 1]));
        assert_eq!(sizes.peak_at, 1e-4 * (count / 3 * 2 + 1) as f64);
        let rms = (values.iter().map(|v| v * v).sum::<f64>() / n).sqrt();
        let mean = values.iter().map(|v| v.abs()).sum::<f64>() / n;
        assert!((sizes.rms() - rms).abs() < 1e-12 && (sizes.mean() - mean).abs() < 1e-12);
    }
}
