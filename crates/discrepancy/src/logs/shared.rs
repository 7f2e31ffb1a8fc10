//! Whether one log holds samples of another.

use std::collections::HashMap;
use std::ops::Range;

use axis_log::{Channel, Log};

/// Steps that are looked for at once.
const WINDOW: usize = 16;
/// Of these as many that are not 0: a standstill is like any other.
const MOVING: usize = 8;
/// Moving samples that both must have one after another: noise and quantisation of two runs do
/// not repeat so long, in no channel.
const LEAST: usize = 64;
/// Share of the second log's moving samples that must be shared besides: two simulations without
/// noise may begin alike.
const SHARE: f64 = 0.05;
/// Steps are alike to this share of a channel's range: what a zero or a turn that was added leaves
/// of their digits.
const FINE: f64 = 1e-9;

/// The longest run of samples in the second log that the first has too, in every channel that is
/// in both and moves; zeros may differ. `None` if fewer than [`LEAST`] samples in which the
/// first of these channels moves are shared, or too small a part of the second log's.
pub(super) fn shared(first: &Log, second: &Log) -> Option<Range<usize>> {
    let pairs = pairs(first, second);
    let steps: Vec<[Vec<i64>; 2]> = pairs.iter().map(|[a, b]| steps(a, b)).collect();
    let [of_first, of_second] = steps.first()?;
    let places = windows(of_first);
    let least = LEAST.max((SHARE * moving(of_second) as f64) as usize);
    let (mut best, mut tried) = (None, HashMap::new());
    let mut at = 0;
    while at + WINDOW <= of_second.len() {
        let window = &of_second[at..at + WINDOW];
        let mut next = at + 1;
        for &place in places.get(window).into_iter().flatten() {
            // A run is found once, from its first window on.
            let lag = place as i64 - at as i64;
            if tried.get(&lag).is_some_and(|end| at < *end) {
                continue;
            }
            let run = run(&steps, place, at);
            tried.insert(lag, run.end);
            let moves = moving(&of_second[run.clone()]);
            let longest = best.as_ref().map_or(0, Range::len);
            if moves >= least && run.len() + 1 > longest {
                // A step is between two samples.
                best = Some(run.start..run.end + 1);
                next = run.end;
            }
        }
        at = next;
    }
    best
}

fn moving(steps: &[i64]) -> usize {
    steps.iter().filter(|step| **step != 0).count()
}

/// Channels that both logs have, by their names, without those that stand; those with most
/// different steps first.
fn pairs<'a>(first: &'a Log, second: &'a Log) -> Vec<[&'a Channel; 2]> {
    let moves = |c: &Channel| c.samples.windows(2).any(|w| w[0] != w[1]);
    let both = |a: &'a Channel| {
        let mut others = second.channels()[1..].iter();
        let b = others.find(|b| b.name == a.name)?;
        (moves(a) && moves(b)).then_some([a, b])
    };
    let mut all: Vec<[&Channel; 2]> = first.channels()[1..].iter().filter_map(both).collect();
    let kinds = |c: &Channel| {
        let steps = c.samples.windows(2).map(|w| (w[1] - w[0]).to_bits());
        steps
            .take(1 << 14)
            .collect::<std::collections::HashSet<_>>()
            .len()
    };
    all.sort_by_key(|[a, _]| std::cmp::Reverse(kinds(a)));
    all
}

/// Steps of both in shares of their common range.
fn steps(first: &Channel, second: &Channel) -> [Vec<i64>; 2] {
    let all = || first.samples.iter().chain(&second.samples);
    let low = all().copied().fold(f64::MAX, f64::min);
    let high = all().copied().fold(f64::MIN, f64::max);
    let fine = FINE * (high - low);
    [first, second].map(|c| {
        let step = |w: &[f64]| ((w[1] - w[0]) / fine).round() as i64;
        c.samples.windows(2).map(step).collect()
    })
}

/// Where each window of steps that moves stands.
fn windows(steps: &[i64]) -> HashMap<&[i64], Vec<usize>> {
    let mut places: HashMap<&[i64], Vec<usize>> = HashMap::new();
    let moves = |w: &&[i64]| moving(w) >= MOVING;
    for (place, window) in steps.windows(WINDOW).enumerate().filter(|(_, w)| moves(w)) {
        let known = places.entry(window).or_default();
        // Of what repeats all the time, a few places tell.
        if known.len() < WINDOW {
            known.push(place);
        }
    }
    places
}

/// The steps of the second around `at` that are those of the first around `place`, in all channels.
fn run(steps: &[[Vec<i64>; 2]], place: usize, at: usize) -> Range<usize> {
    // Two roundings of a step may differ by one.
    let same = |(place, at): (usize, usize)| {
        steps.iter().all(|[a, b]| match (a.get(place), b.get(at)) {
            (Some(a), Some(b)) => a.abs_diff(*b) <= 1,
            _ => false,
        })
    };
    let on = (0..).take_while(|&k| same((place + k, at + k))).count();
    let back = (0..place)
        .rev()
        .zip((0..at).rev())
        .take_while(|&pair| same(pair));
    at - back.count()..at + on
}
