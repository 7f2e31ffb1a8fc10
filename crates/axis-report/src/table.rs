//! Tables of text and figures.

use crate::error::ReportError;

/// A table: a header, rows of as many cells, notes below.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// What the table shows.
    pub caption: String,
    /// Upper header over several columns ("Paper", "Ours"); empty for none.
    pub groups: Vec<ColumnGroup>,
    /// Header of each column, with its unit.
    pub columns: Vec<String>,
    /// Rows, each of `columns.len()` cells. The first cell names the row and
    /// stays in view when the table scrolls sideways.
    pub rows: Vec<Vec<Cell>>,
    /// Remarks below the table.
    pub notes: Vec<String>,
    /// Whether the rows are hidden until the reader unfolds them.
    pub folded: bool,
}

/// Upper header over neighbouring columns.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ColumnGroup {
    /// Text; empty over columns that belong to no group.
    pub label: String,
    /// Number of columns it spans.
    pub span: usize,
}

/// One cell.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Cell {
    /// Text, set left.
    Text(String),
    /// A finite number, set right.
    Number {
        /// The number, in the unit of the column.
        value: f64,
        /// Digits after the point.
        digits: usize,
        /// Emphasis.
        mark: Mark,
    },
    /// A finite number as mantissa and power of ten, set right.
    Scientific {
        /// The number, in the unit of the column.
        value: f64,
        /// Digits of the mantissa after the point.
        digits: usize,
        /// Emphasis.
        mark: Mark,
    },
    /// A finite number with its unit, as [`engineering`](crate::engineering) writes it, set right.
    Quantity {
        /// The number.
        value: f64,
        /// Its unit, with or without SI prefix.
        unit: String,
        /// Significant digits.
        digits: usize,
        /// Emphasis.
        mark: Mark,
    },
    /// No value: shown as a dash.
    Missing,
}

/// Emphasis of a number, shown by colour and by weight or underline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mark {
    /// None.
    #[default]
    Plain,
    /// The best of its row or column.
    Best,
    /// A goal that is missed.
    Failing,
}

impl Cell {
    /// A text cell.
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// A number with `digits` digits after the point.
    pub fn number(value: f64, digits: usize) -> Self {
        Self::Number {
            value,
            digits,
            mark: Mark::Plain,
        }
    }

    /// A number as mantissa, with `digits` digits after the point, and power of
    /// ten.
    pub fn scientific(value: f64, digits: usize) -> Self {
        Self::Scientific {
            value,
            digits,
            mark: Mark::Plain,
        }
    }

    /// A number with its unit, to `digits` significant digits: `12.3 µm`.
    pub fn quantity(value: f64, unit: impl Into<String>, digits: usize) -> Self {
        Self::Quantity {
            value,
            unit: unit.into(),
            digits,
            mark: Mark::Plain,
        }
    }

    /// The same cell with emphasis; text and missing cells take none.
    pub fn marked(mut self, with: Mark) -> Self {
        if let Self::Number { mark, .. }
        | Self::Scientific { mark, .. }
        | Self::Quantity { mark, .. } = &mut self
        {
            *mark = with;
        }
        self
    }
}

impl Table {
    /// A table without rows.
    pub fn new<C: Into<String>>(
        caption: impl Into<String>,
        columns: impl IntoIterator<Item = C>,
    ) -> Self {
        Self {
            caption: caption.into(),
            groups: Vec::new(),
            columns: columns.into_iter().map(Into::into).collect(),
            rows: Vec::new(),
            notes: Vec::new(),
            folded: false,
        }
    }

    /// Adds an upper header over the next `span` columns. The groups must
    /// together span all columns.
    pub fn group(mut self, label: impl Into<String>, span: usize) -> Self {
        self.groups.push(ColumnGroup {
            label: label.into(),
            span,
        });
        self
    }

    /// Adds a row.
    pub fn row(mut self, cells: impl IntoIterator<Item = Cell>) -> Self {
        self.rows.push(cells.into_iter().collect());
        self
    }

    /// Adds a remark below the table.
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }

    /// Hides the rows until the reader unfolds them.
    pub fn folded(mut self) -> Self {
        self.folded = true;
        self
    }

    pub(crate) fn check(&self) -> Result<(), ReportError> {
        let expected = self.columns.len();
        let spanned: usize = self.groups.iter().map(|g| g.span).sum();
        if !self.groups.is_empty() && spanned != expected {
            return Err(ReportError::GroupSpan {
                table: self.caption.clone(),
                found: spanned,
                expected,
            });
        }
        for (index, row) in self.rows.iter().enumerate() {
            if row.len() != expected {
                return Err(ReportError::RowLength {
                    table: self.caption.clone(),
                    row: index + 1,
                    found: row.len(),
                    expected,
                });
            }
            self.check_values(index, row)?;
        }
        Ok(())
    }

    fn check_values(&self, row: usize, cells: &[Cell]) -> Result<(), ReportError> {
        for (column, cell) in cells.iter().enumerate() {
            match *cell {
                Cell::Number { value, .. }
                | Cell::Scientific { value, .. }
                | Cell::Quantity { value, .. }
                    if !value.is_finite() =>
                {
                    return Err(ReportError::TableValue {
                        table: self.caption.clone(),
                        row: row + 1,
                        column: column + 1,
                        name: self.columns[column].clone(),
                        value,
                    });
                }
                _ => {}
            }
        }
        Ok(())
    }
}
