//! Values of any kind, whatever they are: an error that says what is valid, or
//! a training that ends. Nothing here panics, hangs or fills the memory.

use cfnn::train::{
    Dataset, EarlyStopping, Initialisation, Trainer, TrainingOutcome, TrainingSettings,
    nguyen_widrow,
};
use cfnn::{
    Error, FixedNetwork, Layer, MAX_PARAMETERS, Network, Scaling, ScalingRange, Shape, pack,
    packed_len,
};
use proptest::prelude::*;

/// Small, and at the edges of what a word holds.
fn any_size() -> impl Strategy<Value = usize> {
    prop_oneof![
        0..9usize,
        any::<usize>(),
        Just(usize::MAX),
        Just(1 << 32),
        Just(MAX_PARAMETERS)
    ]
}

fn any_shape() -> impl Strategy<Value = Shape> {
    let hidden = prop::collection::vec(any_size(), 0..4);
    (any_size(), hidden, any_size()).prop_map(|(inputs, hidden, outputs)| Shape {
        inputs,
        hidden,
        outputs,
    })
}

/// All bit patterns: NaN, infinities, zeros and subnormal numbers among them.
fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>(),
        -2.0..2.0f64,
        Just(f64::NAN),
        Just(f64::INFINITY),
        Just(0.0),
        Just(5e-324)
    ]
}

fn any_finite() -> impl Strategy<Value = f64> {
    any_number().prop_filter("not finite", |v| v.is_finite())
}

fn any_settings() -> impl Strategy<Value = TrainingSettings> {
    let numbers = prop::array::uniform7(any_number());
    (numbers, any_size(), any_size(), any::<bool>()).prop_map(|(v, patience, threads, split)| {
        TrainingSettings {
            epochs: 2,
            initial_damping: v[0],
            damping_increase: v[1],
            damping_decrease: v[2],
            max_damping: v[3],
            goal: v[4],
            min_gradient: v[5],
            validation: split.then_some(EarlyStopping {
                fraction: v[6],
                patience,
            }),
            threads,
            ..TrainingSettings::default()
        }
    })
}

/// A data set of one input and one output.
fn data(x: &[f64], y: &[f64]) -> Dataset {
    Dataset::new(1, 1, x.to_vec(), y.to_vec()).unwrap()
}

fn shape(hidden: &[usize]) -> Shape {
    Shape {
        inputs: 1,
        hidden: hidden.to_vec(),
        outputs: 1,
    }
}

proptest! {
    #[test]
    fn any_shape_is_valid_or_refused(shape in any_shape(), seed: u64) {
        // In 128 bits nothing overflows: at most three layers of 2^64.
        let (mut seen, mut parameters) = (shape.inputs as u128 + 1, 0u128);
        for &n in shape.hidden.iter().chain([&shape.outputs]) {
            parameters = parameters.saturating_add(seen.saturating_mul(n as u128));
            seen += n as u128;
        }
        let exact = usize::try_from(parameters).unwrap_or(usize::MAX);
        prop_assert_eq!(shape.parameters(), exact);
        prop_assert_eq!(shape.layers().len(), shape.hidden.len() + 1);
        prop_assert!(shape.neurons() >= shape.outputs && shape.activations() >= shape.inputs);
        let sizes = [shape.inputs, shape.outputs];
        let valid = sizes.iter().chain(&shape.hidden).all(|&n| n > 0) && exact <= MAX_PARAMETERS;
        prop_assert_eq!(shape.validate().is_ok(), valid);
        prop_assert!(packed_len(shape.inputs, &shape.hidden, shape.outputs) >= exact);
        let weights = nguyen_widrow(&shape, seed);
        prop_assert_eq!(weights.is_ok(), valid);
        if let Ok(weights) = weights {
            prop_assert_eq!(weights.len(), exact);
            prop_assert!(weights.iter().all(|w| w.is_finite()));
        }
        let mut packed = [0.0; 8];
        let fits = exact == 4 && packed_len(shape.inputs, &shape.hidden, shape.outputs) == 8;
        let done = pack(shape.inputs, &shape.hidden, shape.outputs, &[0.5; 4], &mut packed);
        prop_assert_eq!(done.is_ok(), fits);
        let fixed = FixedNetwork::<f64, 1, 1, 4>::new(
            &shape.hidden, &packed, [ScalingRange::new("in", 0.0, 1.0).unwrap()],
            [ScalingRange::new("out", 0.0, 1.0).unwrap()],
        );
        if let Ok(fixed) = fixed {
            prop_assert!(fixed.evaluate(&[0.3])[0].is_finite());
        }
    }

    #[test]
    fn any_layer_counts_its_parameters(seen in any_size(), neurons in any_size()) {
        let layer = Layer { seen, neurons, first_parameter: 0, first_neuron: 0 };
        let exact = seen as u128 * neurons as u128;
        prop_assert_eq!(layer.parameters(), usize::try_from(exact).unwrap_or(usize::MAX));
    }

    #[test]
    fn any_table_is_whole_rows_or_refused(
        inputs in any_size(), outputs in any_size(),
        x in prop::collection::vec(prop_oneof![8 => any_finite(), 1 => any_number()], 0..9),
        y in prop::collection::vec(prop_oneof![8 => any_finite(), 1 => any_number()], 0..9),
    ) {
        let rows = x.len().checked_div(inputs).unwrap_or(0);
        let whole = rows > 0 && x.len() == rows * inputs
            && outputs > 0 && rows.checked_mul(outputs) == Some(y.len());
        let finite = x.iter().chain(&y).all(|v| v.is_finite());
        let made = Dataset::new(inputs, outputs, x.clone(), y.clone());
        prop_assert_eq!(made.is_ok(), whole && finite);
        let fitted = Scaling::fit(inputs, &x, outputs, &y);
        prop_assert!(fitted.is_err() || (whole && finite));
    }

    #[test]
    fn any_range_maps_its_ends_or_is_refused(low in any_number(), high in any_number()) {
        if let Ok(range) = ScalingRange::new("range", low, high) {
            prop_assert_eq!(range.to_unit(low), -1.0);
            // One rounding of the width, one of the gain.
            prop_assert!((range.to_unit(high) - 1.0).abs() <= 2.0 * f64::EPSILON);
            prop_assert!(range.from_unit(0.0).is_finite());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Whatever the settings and the samples: refused, or ended.
    #[test]
    fn any_training_ends(
        settings in any_settings(),
        x in prop::collection::vec(any_finite(), 2..9),
        y in prop::collection::vec(any_finite(), 2..9),
        ends in prop::array::uniform4(any_number()),
        start in 0..3usize,
        resolve_output: bool,
        hidden in prop::collection::vec(1..4usize, 0..3),
    ) {
        let samples = x.len().min(y.len());
        let data = data(&x[..samples], &y[..samples]);
        let [a, b, c, d] = ends;
        let Ok(scaling) = Scaling::from_ranges(&[(a, b)], &[(c, d)]).or_else(|_| data.scaling()) else {
            return Ok(());
        };
        let initialisation = [
            Initialisation::NguyenWidrow,
            Initialisation::LinearStart,
            Initialisation::DataAdapted { axis_aligned: 0.5 },
        ][start];
        let damping = TrainingSettings { resolve_output, initialisation, threads: 1, ..settings.clone() };
        prop_assert!(settings.threads <= 1024 || settings.validate().is_err());
        // Few settings are valid: those that are not give way to the usual ones.
        let chosen = [
            damping,
            TrainingSettings { epochs: 2, resolve_output, initialisation, threads: 1, ..TrainingSettings::default() },
            TrainingSettings { epochs: 2, initialisation, threads: 1, ..TrainingSettings::regularised() },
        ];
        for settings in chosen {
            let Ok(mut trainer) = Trainer::new(shape(&hidden), scaling.clone(), &data, settings) else {
                continue;
            };
            trainer.run(|_| ());
            prop_assert!(trainer.history().len() <= 2);
            for network in [trainer.network(), trainer.latest_network()] {
                prop_assert!(network.weights().iter().all(|w| w.is_finite()));
            }
            prop_assert!(Trainer::resume(&data, trainer.checkpoint()).is_ok());
        }
    }
}

#[test]
fn starting_weights_of_a_shape_without_inputs_are_refused() {
    let none = Shape {
        inputs: 0,
        ..shape(&[3])
    };
    let refused = nguyen_widrow(&none, 1).unwrap_err();
    assert!(matches!(refused, Error::EmptyLayer { what: "inputs", .. }));
}

/// 16 000 parameters are few, but every output has deltas of its own.
#[test]
fn a_training_that_would_fill_the_memory_is_refused() {
    let shape = Shape {
        inputs: 1,
        hidden: vec![],
        outputs: 8000,
    };
    let data = Dataset::new(1, 8000, vec![0.5], vec![0.5; 8000]).unwrap();
    let scaling = Scaling::from_ranges(&[(0.0, 1.0)], &vec![(0.0, 1.0); 8000]).unwrap();
    let refused = Trainer::new(shape, scaling, &data, TrainingSettings::default()).unwrap_err();
    assert!(matches!(refused, Error::TrainingMemory { .. }), "{refused}");
    let refused = Shape {
        inputs: 1 << 40,
        hidden: vec![1 << 40],
        outputs: 1,
    };
    assert_eq!(
        refused.validate().unwrap_err().to_string(),
        format!(
            "shape has {} parameters: must be at most 524288",
            usize::MAX
        )
    );
}

/// Samples so far outside the scaling that scaled ones overflow.
fn overflowing(initialisation: Initialisation) -> Result<Trainer, Error> {
    let scaling = Scaling::from_ranges(&[(0.0, 1e-200)], &[(0.0, 1.0)]).unwrap();
    let settings = TrainingSettings {
        epochs: 1000,
        initialisation,
        ..TrainingSettings::default()
    };
    let data = data(&[0.0, 1e200, 2e200], &[0.0, 0.5, 1.0]);
    Trainer::new(shape(&[2]), scaling, &data, settings)
}

#[test]
fn a_gradient_that_is_no_number_ends_the_training_at_once() {
    let mut trainer = overflowing(Initialisation::NguyenWidrow).unwrap();
    assert_eq!(trainer.run(|_| ()), TrainingOutcome::NotFinite);
    assert_eq!(trainer.history().len(), 1);
    assert!(!trainer.history()[0].gradient.is_finite());
    // What it started from is still there to be looked at.
    assert_eq!(trainer.network(), trainer.latest_network());
}

#[test]
fn starting_weights_that_overflow_are_refused() {
    let refused = overflowing(Initialisation::LinearStart).unwrap_err();
    assert!(matches!(
        refused,
        Error::NotFinite {
            what: "starting weights",
            ..
        }
    ));
}

/// A validation loss that is no number does not count as the best.
#[test]
fn a_validation_loss_that_is_no_number_ends_the_training() {
    let x: Vec<f64> = (0..40)
        .map(|i| if i == 7 { 1e200 } else { f64::from(i) })
        .collect();
    let y: Vec<f64> = (0..40).map(|i| f64::from(i % 5)).collect();
    let scaling = Scaling::from_ranges(&[(0.0, 1e-110)], &[(0.0, 4.0)]).unwrap();
    let outcomes: Vec<TrainingOutcome> = (0..8)
        .map(|seed| {
            let settings = TrainingSettings {
                epochs: 50,
                min_gradient: 0.0,
                validation: Some(EarlyStopping {
                    fraction: 0.2,
                    patience: 100,
                }),
                seed,
                ..TrainingSettings::default()
            };
            let data = data(&x, &y);
            let trainer = Trainer::new(shape(&[2]), scaling.clone(), &data, settings);
            trainer.unwrap().run(|_| ())
        })
        .collect();
    assert!(
        outcomes.iter().all(|&o| o == TrainingOutcome::NotFinite),
        "{outcomes:?}"
    );
}

/// Neither grows past its limit by its factor: the trial steps would not end.
#[test]
fn dampings_that_would_never_end_are_refused() {
    let usual = TrainingSettings::default();
    for settings in [
        TrainingSettings {
            initial_damping: 5e-324,
            ..usual.clone()
        },
        TrainingSettings {
            damping_increase: 1.0 + f64::EPSILON,
            ..usual.clone()
        },
        TrainingSettings {
            max_damping: f64::MAX,
            ..usual.clone()
        },
        TrainingSettings {
            threads: 1_000_000,
            ..usual
        },
    ] {
        assert!(matches!(settings.validate(), Err(Error::Setting { .. })));
    }
}

#[test]
fn networks_of_any_weights_are_finite_or_refused() {
    let scaling = Scaling::from_ranges(&[(0.0, 1.0)], &[(0.0, 1.0)]).unwrap();
    for (weights, fits) in [
        (vec![0.0, 1.0], true),
        (vec![0.0, f64::NAN], false),
        (vec![], false),
        (vec![f64::MAX, f64::MAX], true),
    ] {
        let made = Network::new(shape(&[]), scaling.clone(), weights);
        assert_eq!(made.is_ok(), fits);
    }
}
