//! The outside kinds are read, and refused, as those of the library.

use axis_sim::Axis;

use crate::{DRAG, read};

#[test]
fn kind_and_effect_are_read() {
    let axis = read(&format!("{}{DRAG}", outside::HOIST));
    assert_eq!(axis.mechanism.kind().name, "chain-hoist");
    assert_eq!(axis.effects[0].effect.name, "quadratic-drag");
    assert_eq!(axis.effects[0].values, [2000.0]);
    assert!(axis.known().contains(&"chain_stiffness"));
    // The fingerprint is over the values of outside kinds too.
    let other = read(&outside::HOIST.replace("free_length_m = 5", "free_length_m = 6"));
    assert_ne!(other.fingerprint, read(outside::HOIST).fingerprint);
}

/// File, line, what is wrong, and what is valid.
#[test]
fn what_is_wrong_is_told_with_file_line_and_what_is_valid() {
    let with_drag = format!("{}{DRAG}", outside::HOIST);
    for (from, to, at, said) in [
        (
            "sprocket_radius_mm",
            "sprocket_radus_mm",
            "sprocket_radus_mm",
            "did you mean `sprocket_radius_mm`?",
        ),
        (
            "free_length_m =",
            "free_length =",
            "free_length =",
            "has no unit of length; there are free_length_mm, free_length_m",
        ),
        (
            "ratio = 20",
            "ratio = 0",
            "ratio = 0",
            "valid: a number from 0.01 to 10000",
        ),
        (
            "\"chain-hoist\"",
            "\"chain-hoits\"",
            "kind = \"chain-hoits\"",
            "did you mean \"chain-hoist\"?",
        ),
        (
            "coefficient",
            "coeficient",
            "coeficient",
            "did you mean `coefficient`?",
        ),
        (
            "maximum_m = 4",
            "maximum_m = 5",
            "[stroke]",
            "valid: -995 m <= minimum < maximum <= 4.95 m",
        ),
    ] {
        let bad = with_drag.replace(from, to);
        let line = 1 + bad.lines().position(|l| l.contains(at)).unwrap();
        let error = Axis::parse_with("bad.toml", &bad, &outside::registry());
        let message = error.unwrap_err().to_string();
        assert!(
            message.starts_with(&format!("bad.toml:{line}: ")),
            "{message}"
        );
        assert!(message.contains(said), "{said}\n{message}");
    }
}

/// The library alone knows nothing of them.
#[test]
fn without_the_registry_there_is_no_such_kind() {
    let error = Axis::parse("hoist.toml", outside::HOIST).unwrap_err();
    let message = error.to_string();
    assert!(
        message.starts_with("hoist.toml:8: ") && message.contains("chain-hoist"),
        "{message}"
    );
}
