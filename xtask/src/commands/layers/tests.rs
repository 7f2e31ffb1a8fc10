//! Circles that are planted in a crate of a few lines.

use super::circles_in;

/// The circles of a crate of these files.
fn planted(files: &[(&str, &str)]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join("src").join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    let place = format!("{}/src/", folder.path().display());
    let found = circles_in(folder.path()).unwrap();
    found
        .iter()
        .map(|words| words.replace(&place, ""))
        .collect()
}

const LIB: (&str, &str) = ("lib.rs", "mod a;\nmod b;\npub use a::A;\npub use b::B;\n");

#[test]
fn two_files_that_import_from_one_another_are_named_with_what_ties_them() {
    let a = ("a.rs", "use crate::b::B;\npub struct A(B);\n");
    let b = ("b.rs", "use super::a::{A, made};\npub struct B(Box<A>);\n");
    let words = "2 files:\n  a.rs takes from b.rs: B\n  b.rs takes from a.rs: A, made";
    let a = (a.0, &*format!("{}pub fn made() {{}}\n", a.1));
    assert_eq!(planted(&[LIB, a, b]), [words]);
}

#[test]
fn a_name_is_taken_from_the_file_that_defines_it_however_it_is_called() {
    // By the face of the crate, by a path without an import, in a macro, under another name.
    let a = ("a.rs", "use crate::B as Other;\npub struct A(Other);\n");
    for b in [
        "pub fn b() -> Option<crate::a::A> { None }\npub struct B;\n",
        "pub fn b() { assert!(size_of::<crate::A>() > 0) }\npub struct B;\n",
        "pub fn b() { use crate::{a::A}; drop(None::<A>) }\npub struct B;\n",
        "use super::*;\npub struct B(Box<A>);\n",
    ] {
        let found = planted(&[LIB, a, ("b.rs", b)]);
        assert_eq!(found.len(), 1, "{b}");
        assert!(found[0].contains("b.rs takes from a.rs: A"), "{found:?}");
    }
}

#[test]
fn three_files_in_a_row_are_a_circle_and_what_they_stand_on_is_not_in_it() {
    let lib = ("lib.rs", "mod a;\nmod b;\nmod c;\nmod leaf;\n");
    let found = planted(&[
        lib,
        (
            "a.rs",
            "use crate::b::B;\nuse crate::leaf::Leaf;\npub struct A(B, Leaf);\n",
        ),
        ("b.rs", "use crate::c::C;\npub struct B(C);\n"),
        ("c.rs", "use crate::a::A;\npub struct C(Box<A>);\n"),
        ("leaf.rs", "pub struct Leaf;\n"),
    ]);
    assert_eq!(found.len(), 1);
    assert!(
        found[0].starts_with("3 files:") && !found[0].contains("leaf"),
        "{found:?}"
    );
}

#[test]
fn faces_modules_inside_one_another_and_tests_make_no_circle() {
    let lib = ("lib.rs", "mod outer;\npub use outer::{Outer, part};\n");
    // The outer module shows and uses what is inside; what is inside uses the outer one.
    let outer = (
        "outer/mod.rs",
        "mod inner;\npub mod other;\npub use inner::part;\npub struct Outer;\npub fn both() { other::other() }\n",
    );
    let inner = (
        "outer/inner.rs",
        "use super::Outer;\npub fn part(_: Outer) {}\n#[cfg(test)]\nmod tests {\n    use crate::outer::other;\n    fn t() { other::other() }\n}\n",
    );
    let other = (
        "outer/other.rs",
        "use super::part;\npub fn other() { part(super::Outer) }\n",
    );
    assert!(planted(&[lib, outer, inner, other]).is_empty());
}

#[test]
fn a_circle_inside_a_module_and_one_through_its_face_are_found() {
    let lib = ("lib.rs", "mod outer;\nmod user;\n");
    let outer = ("outer/mod.rs", "mod inner;\npub use inner::Inner;\n");
    let inner = (
        "outer/inner.rs",
        "use crate::user::User;\npub struct Inner(Box<User>);\n",
    );
    let user = (
        "user.rs",
        "use crate::outer::Inner;\npub struct User(Inner);\n",
    );
    let found = planted(&[lib, outer, inner, user]);
    assert_eq!(found.len(), 1);
    assert!(
        found[0].contains("user.rs takes from outer/inner.rs: Inner"),
        "{found:?}"
    );
}

#[test]
fn a_precise_capture_is_no_import() {
    let lib = (
        "lib.rs",
        "pub fn f<'a>(x: &'a [u8]) -> impl Iterator<Item = u8> + use<'a> { x.iter().copied() }\n",
    );
    assert!(planted(&[lib]).is_empty());
}
