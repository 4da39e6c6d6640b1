//! What a section found: prose, tables, plots and pictures for people, named figures for programs.

use anyhow::Result;
use rilievo::color::Picture;
use serde_json::{Map, Value};

use super::page::Plot;
use crate::report::number;

/// One part of a section, in the order of the page.
pub(crate) enum Block {
    /// A paragraph that says first what it is about.
    Note {
        label: &'static str,
        text: String,
    },
    Table(Table),
    Plot(Plot),
    Shots(Shots),
}

/// A figure a program may want, and what the paper has for it.
struct Figure {
    key: String,
    value: f64,
    paper: Option<f64>,
}

/// All that a section found.
#[derive(Default)]
pub(crate) struct Findings {
    blocks: Vec<Block>,
    figures: Vec<Figure>,
}

impl Findings {
    /// What the paper did.
    pub(crate) fn paper(&mut self, text: impl Into<String>) {
        self.note("The paper", text);
    }

    /// Under which conditions this program did the same.
    pub(crate) fn here(&mut self, text: impl Into<String>) {
        self.note("Here", text);
    }

    /// What came out, and where it differs.
    pub(crate) fn remark(&mut self, text: impl Into<String>) {
        self.note("Beside the paper", text);
    }

    fn note(&mut self, label: &'static str, text: impl Into<String>) {
        self.blocks.push(Block::Note { label, text: text.into() });
    }

    /// Shows something.
    pub(crate) fn show(&mut self, block: impl Into<Block>) {
        self.blocks.push(block.into());
    }

    /// A measured figure.
    pub(crate) fn figure(&mut self, key: impl Into<String>, value: f64) {
        self.figures.push(Figure { key: key.into(), value, paper: None });
    }

    /// A measured figure beside the paper's.
    pub(crate) fn against(&mut self, key: impl Into<String>, value: f64, paper: f64) {
        self.figures.push(Figure { key: key.into(), value, paper: Some(paper) });
    }

    /// The parts of the page.
    pub(crate) fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// The figures by their keys, and those the paper has under the same keys.
    pub(crate) fn to_json(&self) -> (Value, Value) {
        let measured: Map<String, Value> = self.figures.iter().map(|f| (f.key.clone(), number(f.value))).collect();
        let papers = self.figures.iter().filter_map(|f| Some((f.key.clone(), number(f.paper?))));
        (Value::Object(measured), Value::Object(papers.collect()))
    }
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Column {
    pub(crate) title: String,
    /// Whether its figures are the paper's.
    pub(crate) is_paper: bool,
}

impl Column {
    /// Measured here.
    pub(crate) fn here(title: impl Into<String>) -> Self {
        Self { title: title.into(), is_paper: false }
    }

    /// From the paper.
    pub(crate) fn paper(title: impl Into<String>) -> Self {
        Self { title: title.into(), is_paper: true }
    }
}

/// A table; the first column names its rows.
pub(crate) struct Table {
    pub(crate) caption: String,
    pub(crate) columns: Vec<Column>,
    pub(crate) rows: Vec<Vec<String>>,
}

impl Table {
    /// An empty table.
    pub(crate) fn new(caption: impl Into<String>, columns: Vec<Column>) -> Self {
        Self { caption: caption.into(), columns, rows: Vec::new() }
    }

    /// Adds a row with a cell for each column.
    pub(crate) fn row(&mut self, cells: Vec<String>) {
        debug_assert_eq!(cells.len(), self.columns.len());
        self.rows.push(cells);
    }
}

/// Pictures beside each other.
pub(crate) struct Shots {
    /// How many stand in a row on a wide page.
    pub(crate) columns: usize,
    pub(crate) shots: Vec<Shot>,
}

impl Shots {
    /// No pictures yet.
    pub(crate) fn new(columns: usize) -> Self {
        Self { columns, shots: Vec::new() }
    }

    /// Adds one.
    pub(crate) fn add(&mut self, shot: Shot) {
        self.shots.push(shot);
    }
}

/// One or more pictures, one under the other, with a caption.
pub(crate) struct Shot {
    pub(crate) images: Vec<Image>,
    pub(crate) title: String,
    pub(crate) caption: String,
}

impl Shot {
    /// A picture with a title and what there is to say of it.
    pub(crate) fn new(picture: &Picture, title: impl Into<String>, caption: impl Into<String>) -> Result<Self> {
        Ok(Self { images: vec![Image::new(picture)?], title: title.into(), caption: caption.into() })
    }

    /// The same with another picture under it.
    pub(crate) fn over(mut self, picture: &Picture) -> Result<Self> {
        self.images.push(Image::new(picture)?);
        Ok(self)
    }

    /// The same with its last picture enlarged so that texels stay squares.
    pub(crate) fn enlarged(mut self) -> Self {
        if let Some(image) = self.images.last_mut() {
            image.is_enlarged = true;
        }
        self
    }
}

/// A picture as a PNG.
pub(crate) struct Image {
    pub(crate) png: Vec<u8>,
    pub(crate) size: (u32, u32),
    pub(crate) is_enlarged: bool,
}

impl Image {
    fn new(picture: &Picture) -> Result<Self> {
        Ok(Self { png: rilievo_io::encode_picture_png(picture)?, size: picture.size(), is_enlarged: false })
    }
}

impl From<Table> for Block {
    fn from(table: Table) -> Self {
        Self::Table(table)
    }
}

impl From<Plot> for Block {
    fn from(plot: Plot) -> Self {
        Self::Plot(plot)
    }
}

impl From<Shots> for Block {
    fn from(shots: Shots) -> Self {
        Self::Shots(shots)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_go_to_json_with_the_papers_beside() {
        let mut found = Findings::default();
        found.figure("a", 1.25);
        found.against("b", f64::INFINITY, 2.0);
        let (measured, paper) = found.to_json();
        assert_eq!(measured.to_string(), r#"{"a":1.25,"b":null}"#);
        assert_eq!(paper.to_string(), r#"{"b":2.0}"#);
    }
}
