//! Rows: what is kept of a case.

use crate::Failure;

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number, kept to the last bit.
    Number,
    /// Text, often JSON.
    Text,
}

/// A column of a job's rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name: letters, digits and underscores, with the unit at its end.
    pub name: &'static str,
    /// What it holds.
    pub kind: Kind,
}

impl Column {
    /// A column of numbers.
    pub const fn number(name: &'static str) -> Self {
        let kind = Kind::Number;
        Self { name, kind }
    }

    /// A column of text.
    pub const fn text(name: &'static str) -> Self {
        let kind = Kind::Text;
        Self { name, kind }
    }
}

/// A value of a row.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number, in the unit that the column's name says.
    Number(f64),
    /// Text.
    Text(String),
}

/// The values of a case, in the order of the columns.
pub type Row = Vec<Value>;

impl Value {
    /// What a column of this value holds.
    pub fn kind(&self) -> Kind {
        match self {
            Self::Number(_) => Kind::Number,
            Self::Text(_) => Kind::Text,
        }
    }

    /// The number.
    ///
    /// # Errors
    /// It is text.
    pub fn number(&self) -> Result<f64, Failure> {
        match self {
            Self::Number(value) => Ok(*value),
            Self::Text(text) => Err(format!("\"{text}\" is no number").into()),
        }
    }

    /// The text.
    ///
    /// # Errors
    /// It is a number.
    pub fn text(&self) -> Result<&str, Failure> {
        match self {
            Self::Text(text) => Ok(text),
            Self::Number(value) => Err(format!("{value} is no text").into()),
        }
    }

    fn put(&self, to: &mut Vec<u8>) {
        match self {
            Self::Number(value) => to.extend(value.to_bits().to_le_bytes()),
            Self::Text(text) => {
                to.extend((text.len() as u64).to_le_bytes());
                to.extend(text.as_bytes());
            }
        }
    }

    fn take(kind: Kind, from: &mut &[u8]) -> Option<Self> {
        let head = u64::from_le_bytes(*split(from, 8)?.first_chunk()?);
        Some(match kind {
            Kind::Number => Self::Number(f64::from_bits(head)),
            Kind::Text => {
                let bytes = split(from, usize::try_from(head).ok()?)?;
                Self::Text(String::from_utf8(bytes.to_vec()).ok()?)
            }
        })
    }
}

fn split<'a>(from: &mut &'a [u8], length: usize) -> Option<&'a [u8]> {
    let (taken, rest) = from.split_at_checked(length)?;
    *from = rest;
    Some(taken)
}

/// Rows as bytes, for the journal.
pub(crate) fn encode(rows: &[Row]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for value in rows.iter().flatten() {
        value.put(&mut bytes);
    }
    bytes
}

/// What [`encode`] made; `None` if it is something else.
pub(crate) fn decode(columns: &[Column], mut bytes: &[u8]) -> Option<Vec<Row>> {
    let mut rows = Vec::new();
    while !bytes.is_empty() {
        let values = columns.iter().map(|c| Value::take(c.kind, &mut bytes));
        rows.push(values.collect::<Option<Row>>()?);
    }
    Some(rows)
}
