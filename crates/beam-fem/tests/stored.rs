//! What is stored through serde comes back; what constructors refuse does not get in.

use beam_fem::{Bearing, CrossSection, Damping, LumpedMass, Material, Mesh, SectionShape};
use serde::{Serialize, de::DeserializeOwned};
use std::fmt::Debug;

/// That a value comes back as it was, by its debug text: all its fields to the bit.
fn comes_back<T: Serialize + DeserializeOwned + Debug>(value: &T) -> String {
    let text = serde_json::to_string(value).unwrap();
    let back: T = serde_json::from_str(&text).unwrap();
    assert_eq!(format!("{back:?}"), format!("{value:?}"));
    text
}

/// That a text with `from` replaced by `to` is refused with a message that has `part`.
fn is_refused<T: DeserializeOwned + Debug>(text: &str, [from, to]: [&str; 2], part: &str) {
    assert!(text.contains(from), "{text}");
    let message = serde_json::from_str::<T>(&text.replacen(from, to, 1))
        .unwrap_err()
        .to_string();
    assert!(message.contains(part), "{message}");
}

#[test]
fn parts_come_back_and_invalid_ones_do_not_get_in() {
    let material = Material::new(2.1e11, 0.3, 7850.0).unwrap();
    let text = comes_back(&material);
    is_refused::<Material>(&text, ["0.3", "0.7"], "at most 0.5");
    is_refused::<Material>(&text, ["density", "mass"], "unknown field");
    let section = CrossSection::solid_circle(0.03, &material).unwrap();
    let text = comes_back(&section);
    is_refused::<CrossSection>(&text, ["\"area\":", "\"area\":-"], "area");
    let text = comes_back(&Mesh::uniform(1.5, 3).unwrap());
    assert_eq!(text, r#"{"nodes":[0.0,0.5,1.0,1.5]}"#);
    is_refused::<Mesh>(&text, ["0.5", "1.25"], "node 2");
    comes_back(&LumpedMass::disc([0.1, 0.02], 0.01, &material).unwrap());
    comes_back(&Bearing::orthotropic([1e8, 2e8], [1e3, 0.0]));
    comes_back(&[
        Damping::None,
        Damping::Modal(vec![0.01]),
        Damping::rayleigh_at([(100.0, 0.01), (900.0, 0.02)]).unwrap(),
    ]);
    comes_back(&SectionShape::Rectangle {
        height: 0.02,
        width: 0.01,
    });
}
