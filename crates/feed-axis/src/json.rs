//! Results as JSON, by one rule for numbers that JSON has not.
//!
//! A number without a bound is the text `"inf"` or `"-inf"`, one that is not defined `"nan"`: what Python's `float()` reads.
//! `null` says that there is none, or that it is not known; a key that is left out does not apply.

use serde::ser::{
    Serialize, SerializeMap, SerializeSeq, SerializeStruct, SerializeStructVariant, SerializeTuple,
    SerializeTupleStruct, SerializeTupleVariant, Serializer,
};
use serde_json::Value;

/// Texts in the place of numbers that are not finite.
#[derive(Clone, Copy)]
struct Words {
    infinite: &'static str,
    negative: &'static str,
    undefined: &'static str,
}

const TEXTS: Words = Words {
    infinite: "inf",
    negative: "-inf",
    undefined: "nan",
};

/// The same with a mark that no text of a result has.
const MARKED: Words = Words {
    infinite: "\0Infinity",
    negative: "\0-Infinity",
    undefined: "\0NaN",
};

/// A value as a document of several lines.
///
/// # Errors
/// As `serde_json`: a map with keys that are no texts.
pub fn pretty(value: &impl Serialize) -> serde_json::Result<Vec<u8>> {
    serde_json::to_vec_pretty(&Of(value, TEXTS))
}

/// A value as Python's `json` reads it, with the words `Infinity` and `NaN` that JSON itself has not: numbers come back as numbers.
///
/// # Errors
/// As [`pretty`].
pub fn for_python(value: &impl Serialize) -> serde_json::Result<String> {
    let mut text = serde_json::to_string(&Of(value, MARKED))?;
    for word in [MARKED.infinite, MARKED.negative, MARKED.undefined] {
        let written = serde_json::to_string(word)?;
        text = text.replace(&written, word.trim_start_matches('\0'));
    }
    Ok(text)
}

/// The JSON Schema of a result, made by the types of its fields, with the texts that may stand for a number.
pub fn with_words(mut schema: Value) -> Value {
    match &mut schema {
        Value::Object(object) => {
            for (_, inner) in object.iter_mut() {
                *inner = with_words(inner.take());
            }
            let types = match object.get("type") {
                Some(Value::String(one)) if one == "number" => vec!["number".into()],
                Some(Value::Array(all)) if all.iter().any(|one| one == "number") => all.clone(),
                _ => return schema,
            };
            let types = types.into_iter().chain(["string".into()]);
            object.insert("type".to_owned(), types.collect());
            object.insert("pattern".to_owned(), "^(-?inf|nan)$".into());
        }
        Value::Array(all) => all
            .iter_mut()
            .for_each(|inner| *inner = with_words(inner.take())),
        _ => {}
    }
    schema
}

impl Words {
    fn of(self, number: f64) -> Option<&'static str> {
        match number {
            f64::INFINITY => Some(self.infinite),
            f64::NEG_INFINITY => Some(self.negative),
            _ if number.is_nan() => Some(self.undefined),
            _ => None,
        }
    }
}

/// A value, or a serialiser of one, by the rule.
struct Of<T>(T, Words);

impl<T: Serialize + ?Sized> Serialize for Of<&T> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(Of(to, self.1))
    }
}

/// Methods that go through as they are.
macro_rules! as_it_is {
    ($($name:ident($($what:ident: $kind:ty),*);)*) => {$(
        fn $name(self, $($what: $kind),*) -> Result<S::Ok, S::Error> {
            self.0.$name($($what),*)
        }
    )*};
}

/// Methods that begin what has values in it.
macro_rules! begun {
    ($($name:ident -> $sort:ident($($what:ident: $kind:ty),*);)*) => {$(
        fn $name(self, $($what: $kind),*) -> Result<Self::$sort, S::Error> {
            Ok(Of(self.0.$name($($what),*)?, self.1))
        }
    )*};
}

impl<S: Serializer> Serializer for Of<S> {
    type Ok = S::Ok;
    type Error = S::Error;
    type SerializeSeq = Of<S::SerializeSeq>;
    type SerializeTuple = Of<S::SerializeTuple>;
    type SerializeTupleStruct = Of<S::SerializeTupleStruct>;
    type SerializeTupleVariant = Of<S::SerializeTupleVariant>;
    type SerializeMap = Of<S::SerializeMap>;
    type SerializeStruct = Of<S::SerializeStruct>;
    type SerializeStructVariant = Of<S::SerializeStructVariant>;

    fn serialize_f64(self, value: f64) -> Result<S::Ok, S::Error> {
        match self.1.of(value) {
            Some(word) => self.0.serialize_str(word),
            None => self.0.serialize_f64(value),
        }
    }

    fn serialize_f32(self, value: f32) -> Result<S::Ok, S::Error> {
        match self.1.of(f64::from(value)) {
            Some(word) => self.0.serialize_str(word),
            None => self.0.serialize_f32(value),
        }
    }

    as_it_is! {
        serialize_bool(v: bool);
        serialize_i8(v: i8);
        serialize_i16(v: i16);
        serialize_i32(v: i32);
        serialize_i64(v: i64);
        serialize_u8(v: u8);
        serialize_u16(v: u16);
        serialize_u32(v: u32);
        serialize_u64(v: u64);
        serialize_char(v: char);
        serialize_str(v: &str);
        serialize_bytes(v: &[u8]);
        serialize_none();
        serialize_unit();
        serialize_unit_struct(name: &'static str);
        serialize_unit_variant(name: &'static str, index: u32, variant: &'static str);
    }

    begun! {
        serialize_seq -> SerializeSeq(length: Option<usize>);
        serialize_tuple -> SerializeTuple(length: usize);
        serialize_tuple_struct -> SerializeTupleStruct(name: &'static str, length: usize);
        serialize_tuple_variant -> SerializeTupleVariant(name: &'static str, index: u32, variant: &'static str, length: usize);
        serialize_map -> SerializeMap(length: Option<usize>);
        serialize_struct -> SerializeStruct(name: &'static str, length: usize);
        serialize_struct_variant -> SerializeStructVariant(name: &'static str, index: u32, variant: &'static str, length: usize);
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<S::Ok, S::Error> {
        self.0.serialize_some(&Of(value, self.1))
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        name: &'static str,
        value: &T,
    ) -> Result<S::Ok, S::Error> {
        self.0.serialize_newtype_struct(name, &Of(value, self.1))
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        name: &'static str,
        index: u32,
        variant: &'static str,
        value: &T,
    ) -> Result<S::Ok, S::Error> {
        let value = &Of(value, self.1);
        self.0
            .serialize_newtype_variant(name, index, variant, value)
    }
}

/// What holds values one after the other.
macro_rules! holds_values {
    ($($holder:ident::$push:ident;)*) => {$(
        impl<S: $holder> $holder for Of<S> {
            type Ok = S::Ok;
            type Error = S::Error;

            fn $push<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), S::Error> {
                self.0.$push(&Of(value, self.1))
            }

            fn end(self) -> Result<S::Ok, S::Error> {
                self.0.end()
            }
        }
    )*};
}

holds_values! {
    SerializeSeq::serialize_element;
    SerializeTuple::serialize_element;
    SerializeTupleStruct::serialize_field;
    SerializeTupleVariant::serialize_field;
}

/// What holds values by their names.
macro_rules! holds_fields {
    ($($holder:ident;)*) => {$(
        impl<S: $holder> $holder for Of<S> {
            type Ok = S::Ok;
            type Error = S::Error;

            fn serialize_field<T: Serialize + ?Sized>(
                &mut self,
                key: &'static str,
                value: &T,
            ) -> Result<(), S::Error> {
                self.0.serialize_field(key, &Of(value, self.1))
            }

            fn end(self) -> Result<S::Ok, S::Error> {
                self.0.end()
            }
        }
    )*};
}

holds_fields! {
    SerializeStruct;
    SerializeStructVariant;
}

impl<S: SerializeMap> SerializeMap for Of<S> {
    type Ok = S::Ok;
    type Error = S::Error;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<(), S::Error> {
        self.0.serialize_key(key)
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), S::Error> {
        self.0.serialize_value(&Of(value, self.1))
    }

    fn end(self) -> Result<S::Ok, S::Error> {
        self.0.end()
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[derive(serde::Serialize)]
    struct Inner {
        life: f64,
    }

    #[derive(serde::Serialize)]
    enum Case {
        Plain,
        One(f64),
        Two(f64, f32),
        Named { a: Option<f64> },
    }

    #[derive(serde::Serialize)]
    struct Result {
        margin: f64,
        least: Option<f64>,
        missing: Option<f64>,
        list: Vec<f64>,
        pair: (f64, i32),
        map: BTreeMap<&'static str, f64>,
        cases: Vec<Case>,
        #[serde(flatten)]
        inner: Inner,
    }

    fn result() -> Result {
        Result {
            margin: f64::INFINITY,
            least: Some(f64::NEG_INFINITY),
            missing: None,
            list: vec![1.5, f64::NAN],
            pair: (f64::INFINITY, -2),
            map: BTreeMap::from([("a", f64::INFINITY)]),
            cases: vec![
                Case::Plain,
                Case::One(f64::INFINITY),
                Case::Two(0.25, f32::NAN),
                Case::Named {
                    a: Some(f64::INFINITY),
                },
            ],
            inner: Inner {
                life: f64::INFINITY,
            },
        }
    }

    #[test]
    fn what_is_unbounded_is_told_from_what_is_missing() {
        let text = pretty(&result()).unwrap();
        let found: Value = serde_json::from_slice(&text).unwrap();
        let expected = serde_json::json!({
            "margin": "inf",
            "least": "-inf",
            "missing": null,
            "list": [1.5, "nan"],
            "pair": ["inf", -2],
            "map": { "a": "inf" },
            "cases": ["Plain", { "One": "inf" }, { "Two": [0.25, "nan"] }, { "Named": { "a": "inf" } }],
            "life": "inf",
        });
        assert_eq!(found, expected);
    }

    #[test]
    fn finite_numbers_are_written_as_ever() {
        let value = serde_json::json!({ "a": [1.0, 1e-300, 0.1], "b": { "c": "inf", "d": null } });
        assert_eq!(
            pretty(&value).unwrap(),
            serde_json::to_vec_pretty(&value).unwrap()
        );
    }

    #[test]
    fn a_schema_has_the_texts() {
        let schema = serde_json::json!({
            "properties": {
                "a": { "type": "number", "format": "double" },
                "b": { "type": "array", "items": { "type": ["number", "null"] } },
                "c": { "type": "string" },
            },
        });
        let validator = jsonschema::validator_for(&with_words(schema)).unwrap();
        let is_valid = |value: Value| validator.is_valid(&value);
        assert!(is_valid(
            serde_json::json!({ "a": "inf", "b": [1, null, "nan", "-inf"], "c": "x" })
        ));
        assert!(is_valid(serde_json::json!({ "a": 1.5 })));
        for wrong in [
            serde_json::json!({ "a": "1" }),
            serde_json::json!({ "a": null }),
            serde_json::json!({ "c": 1 }),
        ] {
            assert!(!is_valid(wrong));
        }
    }

    #[test]
    fn python_reads_numbers() {
        let text = for_python(&result()).unwrap();
        assert!(
            text.starts_with(
                r#"{"margin":Infinity,"least":-Infinity,"missing":null,"list":[1.5,NaN]"#
            ),
            "{text}"
        );
        // A text stays one.
        assert_eq!(for_python(&"Infinity").unwrap(), "\"Infinity\"");
    }
}
