//! Artifacts come back bit for bit, or are refused with a telling error.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use cfnn::artifact::{
    ArtifactError, checkpoint_from_bytes, checkpoint_to_bytes, network_from_bytes, network_to_bytes,
};
use cfnn::train::{
    Bayesian, Dataset, EarlyStopping, Trainer, TrainingSettings, nguyen_widrow, starting_weights,
};
use cfnn::{Activation, Architecture, Links, Network, Scaling, Shape};
use proptest::prelude::*;

use crate::support::architectures;

fn network() -> Network {
    let shape = Shape {
        inputs: 2,
        hidden: vec![3, 2],
        outputs: 2,
    };
    let scaling =
        Scaling::from_ranges(&[(0.0, 1.5), (-0.1, 0.7)], &[(-1e-9, 3e-9), (0.0, 1.0)]).unwrap();
    let weights = nguyen_widrow(&shape, 9).unwrap();
    Network::new(shape, scaling, weights).unwrap()
}

fn checkpoint() -> (Dataset, cfnn::train::Checkpoint) {
    let input: Vec<f64> = (0..60).map(|i| f64::from(i) / 59.0).collect();
    let target = input.iter().map(|x| (6.0 * x).sin()).collect();
    let data = Dataset::new(1, 1, input, target).unwrap();
    let shape = Shape {
        inputs: 1,
        hidden: vec![4],
        outputs: 1,
    };
    let settings = TrainingSettings {
        validation: Some(EarlyStopping {
            fraction: 0.25,
            patience: 9,
        }),
        ..TrainingSettings::default()
    };
    let mut trainer = Trainer::new(shape, data.scaling().unwrap(), &data, settings).unwrap();
    trainer.epoch();
    trainer.epoch();
    (data, trainer.checkpoint())
}

#[test]
fn round_trips() {
    let network = network();
    let bytes = network_to_bytes(&network, "axis blake3 0f1e").unwrap();
    let (again, provenance) = network_from_bytes(&bytes).unwrap();
    assert_eq!(again, network);
    assert_eq!(provenance, "axis blake3 0f1e");

    let (data, checkpoint) = checkpoint();
    let bytes = checkpoint_to_bytes(&checkpoint, "axis").unwrap();
    let (again, _) = checkpoint_from_bytes(&bytes).unwrap();
    assert_eq!(again, checkpoint);
    let mut one = Trainer::resume(&data, checkpoint).unwrap();
    let mut two = Trainer::resume(&data, again).unwrap();
    assert_eq!(one.epoch(), two.epoch());
}

/// Bytes that version 0.1.0 wrote, before there was a second schema: they are read, and written the same.
#[test]
fn artifacts_of_the_first_schema_are_read() {
    let bytes = include_bytes!("golden/network_schema1.cfnn");
    let (network, provenance) = network_from_bytes(bytes).unwrap();
    assert_eq!(provenance, "axis 1");
    let shape = Shape {
        inputs: 2,
        hidden: vec![3, 2],
        outputs: 2,
    };
    let weights: Vec<f64> = (0..37).map(|k| (f64::from(k) - 12.0) / 16.0).collect();
    assert_eq!(network.architecture(), &Architecture::from(shape));
    assert_eq!(network.weights(), weights);
    assert_eq!(network.scaling().output()[0].maximum(), 3e-9);
    assert_eq!(network_to_bytes(&network, "axis 1").unwrap(), bytes);

    let bytes = include_bytes!("golden/checkpoint_schema1.cfnn");
    let (checkpoint, _) = checkpoint_from_bytes(bytes).unwrap();
    assert_eq!(checkpoint.epochs_done(), 2);
    assert_eq!(checkpoint.shape().hidden, [1]);
    assert_eq!(checkpoint.settings.epochs, 2);
    assert_eq!(checkpoint_to_bytes(&checkpoint, "axis 1").unwrap(), bytes);
    let x: Vec<f64> = (0..8).map(|i| f64::from(i) / 8.0).collect();
    let data = Dataset::new(1, 1, x.clone(), x).unwrap();
    Trainer::resume(&data, checkpoint).unwrap();
}

/// A state of the second schema: plain feed-forward, an input dropped, Bayesian regularisation.
fn bayesian() -> (Dataset, cfnn::train::Checkpoint) {
    let input: Vec<f64> = (0..40).flat_map(|i| [f64::from(i) / 39.0, 5.0]).collect();
    let target = input.chunks(2).map(|x| (6.0 * x[0]).sin()).collect();
    let data = Dataset::new(2, 1, input, target).unwrap();
    let (scaling, constant) = data.scaling_of_varying().unwrap();
    let shape = Shape {
        inputs: 2,
        hidden: vec![4, 2],
        outputs: 1,
    };
    let architecture = Architecture::from(shape)
        .with_links(Links::FeedForward)
        .with_transfers(&[Activation::Logsig, Activation::Tansig])
        .unwrap()
        .without_inputs(&constant)
        .unwrap();
    let settings = TrainingSettings {
        bayesian: Some(Bayesian {
            tolerance: 1e-4,
            ..Bayesian::default()
        }),
        validation: Some(EarlyStopping {
            fraction: 0.25,
            patience: 9,
        }),
        threads: 1,
        ..TrainingSettings::default()
    };
    let mut trainer = Trainer::new(architecture, scaling, &data, settings).unwrap();
    trainer.epoch();
    trainer.epoch();
    (data, trainer.checkpoint())
}

#[test]
fn a_state_of_the_second_schema_comes_back() {
    let (data, checkpoint) = bayesian();
    let bytes = checkpoint_to_bytes(&checkpoint, "axis").unwrap();
    assert_eq!(bytes[12], 2);
    let (again, _) = checkpoint_from_bytes(&bytes).unwrap();
    assert_eq!(again, checkpoint);
    let mut one = Trainer::resume(&data, checkpoint).unwrap();
    let mut two = Trainer::resume(&data, again).unwrap();
    assert_eq!(one.epoch(), two.epoch());
}

proptest! {
    #[test]
    fn any_architecture_comes_back(architecture in architectures(), seed in 0..100u64) {
        let shape = architecture.shape();
        let scaling = Scaling::from_ranges(
            &vec![(-0.1, 1.3); shape.inputs],
            &vec![(1e-9, 3e-9); shape.outputs],
        ).unwrap();
        let plain = architecture == Architecture::from(shape.clone());
        let weights = starting_weights(&architecture, seed).unwrap();
        let network = Network::new(architecture, scaling, weights).unwrap();
        let bytes = network_to_bytes(&network, "p").unwrap();
        prop_assert_eq!(bytes[12], if plain { 1 } else { 2 });
        prop_assert_eq!(network_from_bytes(&bytes).unwrap().0, network);
    }
}

#[test]
fn every_flipped_bit_is_refused() {
    let mut bytes = network_to_bytes(&network(), "p").unwrap();
    for position in 0..bytes.len() * 8 {
        bytes[position / 8] ^= 1 << (position % 8);
        assert!(network_from_bytes(&bytes).is_err(), "bit {position}");
        bytes[position / 8] ^= 1 << (position % 8);
    }
    assert!(network_from_bytes(&bytes).is_ok());
}

#[test]
fn every_truncation_and_extension_is_refused() {
    let bytes = network_to_bytes(&network(), "p").unwrap();
    for length in 0..bytes.len() {
        let refused = network_from_bytes(&bytes[..length]);
        assert!(
            matches!(refused, Err(ArtifactError::Truncated { .. })),
            "{length}: {refused:?}"
        );
    }
    let mut longer = bytes.clone();
    longer.push(0);
    let refused = network_from_bytes(&longer);
    assert!(matches!(refused, Err(ArtifactError::TrailingBytes { .. })));
}

#[test]
fn each_fault_has_its_own_error() {
    let bytes = network_to_bytes(&network(), "p").unwrap();
    let refused = checkpoint_from_bytes(&bytes).unwrap_err();
    assert!(
        matches!(refused, ArtifactError::WrongKind { .. }),
        "{refused}"
    );

    // Another schema, with a hash that fits it.
    let mut other = bytes[..bytes.len() - 32].to_vec();
    other[12] = 3;
    other.extend_from_slice(blake3::hash(&other).as_bytes());
    let refused = network_from_bytes(&other).unwrap_err();
    let expected = ArtifactError::OtherSchema {
        found: 3,
        expected: 2,
    };
    assert_eq!(refused, expected);

    // A payload that is whole but longer than its content.
    let mut longer = bytes[..bytes.len() - 32].to_vec();
    longer.push(7);
    let length = longer.len() as u64 - 24;
    longer[16..24].copy_from_slice(&length.to_le_bytes());
    longer.extend_from_slice(blake3::hash(&longer).as_bytes());
    let refused = network_from_bytes(&longer).unwrap_err();
    assert!(
        matches!(refused, ArtifactError::Payload { .. }),
        "{refused}"
    );

    assert_eq!(
        network_from_bytes(b"PK\x03\x04something else").unwrap_err(),
        ArtifactError::NotAnArtifact
    );
    let mut flipped = bytes.clone();
    flipped[60] ^= 4;
    assert_eq!(
        network_from_bytes(&flipped).unwrap_err(),
        ArtifactError::Damaged
    );
}

/// Length and hash that fit a changed payload: what only a hostile hand makes.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let length = bytes.len() as u64 - 24;
    bytes[16..24].copy_from_slice(&length.to_le_bytes());
    let hash = blake3::hash(&bytes);
    bytes.extend_from_slice(hash.as_bytes());
    bytes
}

/// A damping below zero would keep the trial steps of an epoch from ending.
#[test]
fn a_checkpoint_with_a_damping_below_zero_is_refused() {
    let (_, checkpoint) = checkpoint();
    let mut bytes = checkpoint_to_bytes(&checkpoint, "p").unwrap();
    bytes.truncate(bytes.len() - 32);
    let damping = checkpoint.history().last().unwrap().damping.to_le_bytes();
    let place = bytes.windows(8).position(|w| w == damping).unwrap();
    bytes[place..place + 8].copy_from_slice(&(-1.0f64).to_le_bytes());
    let refused = checkpoint_from_bytes(&sealed(bytes)).unwrap_err();
    assert!(refused.to_string().contains("damping is -1"), "{refused}");
}

proptest! {
    /// Payloads with any bytes changed, under a hash that fits: refused, or a
    /// training that goes on and ends.
    #[test]
    fn changed_payloads_are_refused_or_sound(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in prop::option::of(any::<prop::sample::Index>()),
        second: bool,
    ) {
        let (data, checkpoint) = if second { bayesian() } else { checkpoint() };
        let network = match second {
            true => network_to_bytes(&Trainer::resume(&data, checkpoint.clone()).unwrap().network(), "provenance"),
            false => network_to_bytes(&network(), "provenance"),
        }.unwrap();
        let state = checkpoint_to_bytes(&checkpoint, "provenance").unwrap();
        let changed = |mut bytes: Vec<u8>| {
            bytes.truncate(bytes.len() - 32);
            let payload = bytes.len() - 24;
            for (place, byte) in &changes {
                bytes[24 + place.index(payload)] = *byte;
            }
            if let Some(cut) = &cut {
                bytes.truncate(24 + cut.index(payload));
            }
            sealed(bytes)
        };
        if let Ok((network, _)) = network_from_bytes(&changed(network)) {
            prop_assert!(network.weights().iter().all(|w| w.is_finite()));
        }
        if let Ok((mut checkpoint, _)) = checkpoint_from_bytes(&changed(state)) {
            checkpoint.settings.threads = 1;
            if let Ok(mut trainer) = Trainer::resume(&data, checkpoint) {
                trainer.epoch();
                prop_assert!(trainer.network().weights().iter().all(|w| w.is_finite()));
            }
        }
    }

    /// Any bytes at all.
    #[test]
    fn any_bytes_are_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        prop_assert!(network_from_bytes(&bytes).is_err());
        let mut framed = network_to_bytes(&network(), "p").unwrap()[..24].to_vec();
        framed.extend(&bytes);
        prop_assert!(network_from_bytes(&sealed(framed)).is_err());
    }
}
