//! Fewer points for the same picture.

use std::collections::HashSet;

/// Indices of the points that a line needs, in order.
///
/// `points` are in pixels. Of each run of consecutive points in one pixel
/// column the lowest and the highest stay (the ends of the run where it is
/// flat), and the first and the last point of all. The points may go back and
/// forth: a hysteresis loop keeps its shape.
pub(crate) fn line(points: &[(f64, f64)]) -> Vec<usize> {
    let mut kept = Vec::new();
    let mut start = 0;
    while start < points.len() {
        let column = points[start].0.floor();
        let run = points[start..]
            .iter()
            .take_while(|p| p.0.floor() == column)
            .count();
        keep_extremes(points, start..start + run, &mut kept);
        start += run;
    }
    if let Some(last) = points.len().checked_sub(1) {
        if kept.first() != Some(&0) {
            kept.insert(0, 0);
        }
        if kept.last() != Some(&last) {
            kept.push(last);
        }
    }
    kept
}

fn keep_extremes(points: &[(f64, f64)], run: std::ops::Range<usize>, kept: &mut Vec<usize>) {
    let (mut low, mut high) = (run.start, run.start);
    for k in run.clone() {
        if points[k].1 < points[low].1 {
            low = k;
        }
        if points[k].1 > points[high].1 {
            high = k;
        }
    }
    if low == high {
        (low, high) = (run.start, run.end - 1);
    }
    kept.push(low.min(high));
    if low != high {
        kept.push(low.max(high));
    }
}

/// Indices of the dots that can be told apart, in order: the first one in each
/// pixel.
pub(crate) fn dots(points: &[(f64, f64)]) -> Vec<usize> {
    let mut seen = HashSet::new();
    let pixel = |p: &(f64, f64)| (p.0.floor() as i64, p.1.floor() as i64);
    (0..points.len())
        .filter(|&k| seen.insert(pixel(&points[k])))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_single_spike_survives() {
        let mut points: Vec<(f64, f64)> = (0..36_000)
            .map(|k| (f64::from(k) * 800.0 / 36_000.0, 0.0))
            .collect();
        points[17_321].1 = 9.0;
        points[17_330].1 = -7.0;
        let kept = line(&points);
        assert!(kept.contains(&17_321) && kept.contains(&17_330));
        // Two points in each of 800 columns.
        assert!(kept.len() <= 1600, "{}", kept.len());
    }

    #[test]
    fn few_points_all_stay() {
        let points = [(0.0, 1.0), (5.0, 2.0), (2.0, 0.0), (2.5, 3.0), (5.0, 2.0)];
        assert_eq!(line(&points), [0, 1, 2, 3, 4]);
        assert_eq!(line(&[(0.0, 0.0)]), [0]);
        assert!(line(&[]).is_empty());
    }

    #[test]
    fn dots_in_one_pixel_become_one() {
        let points = [(0.1, 0.1), (0.9, 0.2), (1.1, 0.2), (0.2, 0.2)];
        assert_eq!(dots(&points), [0, 2]);
    }

    proptest! {
        #[test]
        fn each_column_keeps_its_extremes(
            ys in prop::collection::vec(-100.0..100.0f64, 1..400), width in 1.0..50.0f64,
        ) {
            let n = ys.len() as f64;
            let points: Vec<(f64, f64)> =
                ys.iter().enumerate().map(|(k, &y)| (k as f64 / n * width, y)).collect();
            let kept = line(&points);
            prop_assert!(kept.windows(2).all(|w| w[0] < w[1]));
            prop_assert_eq!(kept.first(), Some(&0));
            prop_assert_eq!(kept.last(), Some(&(ys.len() - 1)));
            for column in 0..=width as i64 {
                let of = |k: &usize| points[*k].0.floor() as i64 == column;
                let span = |ks: Vec<usize>| ks.iter().fold((f64::MAX, f64::MIN), |(a, b), &k| {
                    (a.min(points[k].1), b.max(points[k].1))
                });
                prop_assert_eq!(
                    span((0..ys.len()).filter(of).collect()),
                    span(kept.iter().copied().filter(of).collect())
                );
            }
        }
    }
}
