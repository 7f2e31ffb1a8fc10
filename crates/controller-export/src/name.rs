//! Names that files, types and functions can have.

use std::collections::BTreeSet;

use crate::ExportError;

/// Least number of characters that a compiler must tell apart in a name that is linked (ISO C99,
/// 5.2.4.1): the longest ending is counted by the compiler, not here.
const LONGEST: usize = 31;

/// Words of C99, and of C++ as far as headers are included there.
const WORDS: &[&str] = &[
    "alignas",
    "alignof",
    "and",
    "asm",
    "auto",
    "bool",
    "break",
    "case",
    "catch",
    "char",
    "class",
    "const",
    "constexpr",
    "continue",
    "decltype",
    "default",
    "delete",
    "do",
    "double",
    "else",
    "enum",
    "explicit",
    "export",
    "extern",
    "false",
    "float",
    "for",
    "friend",
    "goto",
    "if",
    "inline",
    "int",
    "long",
    "main",
    "mutable",
    "namespace",
    "new",
    "noexcept",
    "not",
    "nullptr",
    "operator",
    "or",
    "private",
    "protected",
    "public",
    "register",
    "restrict",
    "return",
    "short",
    "signed",
    "sizeof",
    "static",
    "struct",
    "switch",
    "template",
    "this",
    "throw",
    "true",
    "try",
    "typedef",
    "typeid",
    "typename",
    "union",
    "unsigned",
    "using",
    "virtual",
    "void",
    "volatile",
    "while",
    "xor",
];

/// What the code's own names end with, after the name and `_`.
const ENDINGS: &[&str] = &[
    "init",
    "reset",
    "switch",
    "step",
    "limit",
    "limits",
    "input",
    "output",
    "status",
    "ahead",
    "wound",
    "plan",
    "filter",
    "estimator",
    "friction",
    "feedback",
    "guard",
];

/// The same in upper case.
const CONSTANTS: &[&str] = &[
    "H",
    "OFF",
    "ON",
    "NOT_FINITE",
    "POSITION_LIMIT",
    "EFFORT_LIMIT",
    "SURPRISE_LIMIT",
    "LIMITS",
];

/// Refuses what is no name in C.
pub(crate) fn check_name(name: &str) -> Result<(), ExportError> {
    let refused = |why: &str| {
        Err(ExportError::Name {
            name: name.to_owned(),
            why: why.to_owned(),
        })
    };
    let letters = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if !name.starts_with(|c: char| c.is_ascii_lowercase()) {
        return refused("it does not begin with a lower-case letter");
    }
    if !name.chars().all(letters) {
        return refused("it has other characters");
    }
    if name.len() > LONGEST {
        return refused("it is too long");
    }
    match WORDS.contains(&name) {
        true => refused("it is a word of C or C++"),
        false => Ok(()),
    }
}

/// Refuses a name of which the evaluator, `body` with placeholders, has one of its own.
pub(crate) fn check_free(name: &str, body: &str) -> Result<(), ExportError> {
    let taken = at_file_scope(body);
    let upper = name.to_uppercase();
    let own = ENDINGS.iter().map(|end| format!("{name}_{end}"));
    let constants = CONSTANTS.iter().map(|end| format!("{upper}_{end}"));
    let mut all = std::iter::once(name.to_owned()).chain(own).chain(constants);
    match all.find(|word| taken.contains(word.as_str())) {
        None => Ok(()),
        Some(word) => Err(ExportError::Name {
            name: name.to_owned(),
            why: format!("the code has a name {word} inside"),
        }),
    }
}

/// Words of the lines that declare something at file scope, up to its value or parameters.
fn at_file_scope(body: &str) -> BTreeSet<&str> {
    let begins = ["static ", "typedef ", "} ", "#define "];
    let lines = body
        .lines()
        .filter(|line| begins.iter().any(|b| line.starts_with(b)));
    let heads = lines.filter_map(|line| line.split(['(', '=', '[', '{']).next());
    let words =
        heads.flat_map(|head| head.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == '@')));
    words.filter(|word| !word.is_empty()).collect()
}
