//! The least of a function of a few numbers, without derivatives.

/// Nelder and Mead's simplex (Computer Journal 7 (1965) 308–313, doi:10.1093/comjnl/7.4.308), from a
/// point with edges of `size`, until its values differ by less than `close` or `most` evaluations are
/// made: the best point and its value.
pub(crate) fn least(
    of: &mut dyn FnMut(&[f64]) -> f64,
    from: &[f64],
    size: f64,
    close: f64,
    most: usize,
) -> (Vec<f64>, f64) {
    let n = from.len();
    let mut count = 0;
    let mut value = |x: &[f64]| {
        count += 1;
        let found = of(x);
        (if found.is_nan() { f64::INFINITY } else { found }, count)
    };
    let mut simplex: Vec<(Vec<f64>, f64)> = Vec::with_capacity(n + 1);
    for i in 0..=n {
        let mut x = from.to_vec();
        if i > 0 {
            x[i - 1] += size;
        }
        let height = value(&x).0;
        simplex.push((x, height));
    }
    loop {
        simplex.sort_by(|a, b| a.1.total_cmp(&b.1));
        let (low, high) = (simplex[0].1, simplex[n].1);
        let edge = (0..n)
            .map(|j| (simplex[n].0[j] - simplex[0].0[j]).abs())
            .fold(0.0, f64::max);
        let centre: Vec<f64> = (0..n)
            .map(|j| simplex[..n].iter().map(|(x, _)| x[j]).sum::<f64>() / n as f64)
            .collect();
        let along = |t: f64, worst: &[f64]| -> Vec<f64> {
            centre
                .iter()
                .zip(worst)
                .map(|(c, w)| c + t * (w - c))
                .collect()
        };
        let worst = simplex[n].0.clone();
        let reflected = along(-1.0, &worst);
        let (at_reflected, used) = value(&reflected);
        if used >= most || (high - low < close && edge < close.sqrt()) {
            return simplex.swap_remove(0);
        }
        let second = simplex[n - 1].1;
        if at_reflected < low {
            let expanded = along(-2.0, &worst);
            let at_expanded = value(&expanded).0;
            simplex[n] = match at_expanded < at_reflected {
                true => (expanded, at_expanded),
                false => (reflected, at_reflected),
            };
        } else if at_reflected < second {
            simplex[n] = (reflected, at_reflected);
        } else {
            let outside = at_reflected < high;
            let contracted = along(if outside { -0.5 } else { 0.5 }, &worst);
            let at_contracted = value(&contracted).0;
            if at_contracted < at_reflected.min(high) {
                simplex[n] = (contracted, at_contracted);
            } else {
                let best = simplex[0].0.clone();
                for (x, height) in &mut simplex[1..] {
                    for (x, best) in x.iter_mut().zip(&best) {
                        *x = best + 0.5 * (*x - best);
                    }
                    *height = value(x).0;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::least;

    /// Rosenbrock's valley, whose least is 0 at (1, 1).
    #[test]
    fn it_follows_a_valley() {
        let mut valley = |x: &[f64]| {
            let [a, b] = [x[0], x[1]];
            (1.0 - a).powi(2) + 100.0 * (b - a * a).powi(2)
        };
        let (x, height) = least(&mut valley, &[-1.2, 1.0], 0.5, 1e-14, 1000);
        assert!(height < 1e-10, "{height:e}");
        assert!(
            (x[0] - 1.0).abs() < 1e-4 && (x[1] - 1.0).abs() < 1e-4,
            "{x:?}"
        );
    }
}
