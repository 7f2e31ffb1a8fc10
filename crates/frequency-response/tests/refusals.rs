use frequency_response::{
    Averaging, ChirpExcitation, Complex, Estimator, Excitation, FitSettings, FrequencyResponse,
    LoopLine, LoopMargins, ModalFit, Multisine, Prbs, Record,
};
use proptest::prelude::*;

fn anything() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(f64::NAN),
        Just(f64::INFINITY),
        Just(0.0),
        Just(1e308),
        Just(-1.0),
        any::<f64>(),
        -10.0..10.0,
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_number_panics(
        values in prop::collection::vec(anything(), 0..80),
        other in prop::collection::vec(anything(), 0..80),
        period in anything(),
        segment in 0usize..40,
        skip in 0usize..4,
        differenced in any::<bool>(),
    ) {
        let n = values.len().min(other.len());
        for (u, y) in [(&values[..], &other[..]), (&values[..n], &other[..n])] {
            for averaging in [Averaging::Welch { segment }, Averaging::Periods { period: segment, skip }] {
                for by in [Estimator::ThreeSignals, Estimator::H1, Estimator::H2] {
                    let record = Record { period_s: period, excitation: Some(y), input: u, output: y, differenced };
                    if let Ok(found) = FrequencyResponse::of(&record, by, averaging) {
                        let _ = ModalFit::of(&found, &FitSettings { most_poles: 2, coherence: 0.0, ..FitSettings::default() });
                    }
                }
            }
        }
        let lines: Vec<LoopLine> = values.iter().zip(&other).map(|(a, b)| LoopLine {
            frequency_hz: *a, value: Complex::new(*b, *a), deviation: *b,
        }).collect();
        let _ = LoopMargins::of(&lines);
    }

    #[test]
    fn no_excitation_panics(a in anything(), b in anything(), c in anything(), r in anything(), n in 0usize..200, register in 0u32..40) {
        for excitation in [
            Excitation::Prbs(Prbs { amplitude: a, register, clock: n, seed: u64::MAX }),
            Excitation::Chirp(ChirpExcitation { amplitude: a, from_hz: b, to_hz: c, ..ChirpExcitation::default() }),
            Excitation::Multisine(Multisine { amplitude: a, period: n, from_hz: b, to_hz: c, ratio: r, seed: 1 }),
        ] {
            let _ = excitation.period();
            if let Ok(samples) = excitation.samples(r, n) {
                prop_assert!(samples.len() == n && samples.iter().all(|x| x.abs() <= a * (1.0 + 1e-12)));
            }
        }
    }
}

#[test]
fn refusals_say_what_and_where() {
    let (u, y) = (vec![1.0, -1.0, 1.0], vec![1.0, f64::NAN, 2.0]);
    let record = |u, y| Record {
        period_s: 1e-3,
        excitation: None,
        input: u,
        output: y,
        differenced: false,
    };
    let of =
        |record| FrequencyResponse::of(&record, Estimator::H1, Averaging::Welch { segment: 64 });
    let said = |record| of(record).unwrap_err().to_string();
    assert!(said(record(&u, &y)).contains("output has NaN at sample 1"));
    assert!(said(record(&u, &y[..2])).contains("output has 2 samples and the input 3"));
    assert!(said(record(&u, &u)).contains("96 are needed"));
    assert!(said(record(&[0.0; 200], &[0.0; 200])).contains("input is constant"));
    assert!(
        said(Record {
            period_s: 0.0,
            ..record(&u, &u)
        })
        .contains("sampling period is 0")
    );
}
