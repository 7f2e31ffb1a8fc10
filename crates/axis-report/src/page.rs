//! The page: sections of blocks.

use crate::figure::Figure;
use crate::table::Table;

/// A whole report.
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    /// Title of the page and of the browser's tab.
    pub title: String,
    /// One or two sentences below the title; empty for none.
    pub lead: String,
    /// What stands above the table of contents: the result in short.
    pub first: Vec<Block>,
    /// The sections, in order. The table of contents lists them.
    pub sections: Vec<Section>,
}

impl Page {
    /// A page without sections.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            lead: String::new(),
            first: Vec::new(),
            sections: Vec::new(),
        }
    }

    /// Sets the sentences below the title.
    pub fn lead(mut self, text: impl Into<String>) -> Self {
        self.lead = text.into();
        self
    }

    /// Adds a block above the table of contents.
    pub fn first(mut self, block: Block) -> Self {
        self.first.push(block);
        self
    }

    /// Adds a section at the end.
    pub fn section(mut self, section: Section) -> Self {
        self.sections.push(section);
        self
    }
}

/// A titled part of a page.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Heading, repeated in the table of contents.
    pub title: String,
    /// The content, in order.
    pub blocks: Vec<Block>,
}

/// One piece of a section. Tables and figures are numbered through the page.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Block {
    /// Running text.
    Paragraph(String),
    /// Bullet points.
    List(Vec<String>),
    /// Text whose line breaks and spaces stand: a command, a diff.
    Preformatted(String),
    /// A boxed sentence that must not be missed.
    Notice(Notice, String),
    /// A table.
    Table(Table),
    /// A figure over the full width.
    Figure(Figure),
    /// Small figures side by side; one below the other on a phone.
    FigureGrid {
        /// The figures, row by row.
        figures: Vec<Figure>,
        /// Figures in a row on a wide screen, at least 1.
        columns: usize,
    },
    /// Names and values: settings, seed, versions.
    KeyValues(KeyValues),
    /// Questions, each with the lines that answer it.
    Answers(Vec<(String, Vec<String>)>),
    /// Content behind a line that unfolds.
    Folded {
        /// The line that is always shown.
        summary: String,
        /// What it hides.
        blocks: Vec<Block>,
    },
}

/// Kind of a notice box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Notice {
    /// Something to know.
    Info,
    /// A goal that was met.
    Good,
    /// A goal that was missed, or a limit of what is shown.
    Warn,
}

/// Names and values.
#[derive(Debug, Clone, PartialEq)]
pub struct KeyValues {
    /// Heading; empty for none.
    pub caption: String,
    /// Name and value, in order.
    pub entries: Vec<(String, String)>,
}

impl KeyValues {
    /// An empty list under that heading.
    pub fn new(caption: impl Into<String>) -> Self {
        Self {
            caption: caption.into(),
            entries: Vec::new(),
        }
    }

    /// Adds one name with its value.
    pub fn entry(mut self, name: impl Into<String>, value: impl ToString) -> Self {
        self.entries.push((name.into(), value.to_string()));
        self
    }
}

impl Section {
    /// A section without content.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            blocks: Vec::new(),
        }
    }

    /// Adds any block.
    pub fn block(mut self, block: Block) -> Self {
        self.blocks.push(block);
        self
    }

    /// Adds running text.
    pub fn paragraph(self, text: impl Into<String>) -> Self {
        self.block(Block::Paragraph(text.into()))
    }

    /// Adds a notice box.
    pub fn notice(self, kind: Notice, text: impl Into<String>) -> Self {
        self.block(Block::Notice(kind, text.into()))
    }

    /// Adds a table.
    pub fn table(self, table: Table) -> Self {
        self.block(Block::Table(table))
    }

    /// Adds a figure over the full width.
    pub fn figure(self, figure: Figure) -> Self {
        self.block(Block::Figure(figure))
    }

    /// Adds small figures, `columns` of them (at least 1) in a row.
    pub fn figure_grid(self, figures: Vec<Figure>, columns: usize) -> Self {
        self.block(Block::FigureGrid { figures, columns })
    }

    /// Adds names and values.
    pub fn key_values(self, list: KeyValues) -> Self {
        self.block(Block::KeyValues(list))
    }

    /// Adds blocks behind a line that unfolds them.
    pub fn folded(self, summary: impl Into<String>, blocks: Vec<Block>) -> Self {
        self.block(Block::Folded {
            summary: summary.into(),
            blocks,
        })
    }
}
