//! Tables for people: a heading, and columns that line up.

use std::fmt::Write as _;

/// Rows of cells under a heading; the first column is set to the left, the others to the right.
pub(super) struct Rows(Vec<Vec<String>>);

impl Rows {
    pub(super) fn new<'a>(heading: impl IntoIterator<Item = &'a str>) -> Self {
        Self(vec![heading.into_iter().map(str::to_owned).collect()])
    }

    pub(super) fn push(&mut self, cells: Vec<String>) {
        debug_assert_eq!(cells.len(), self.0[0].len());
        self.0.push(cells);
    }

    pub(super) fn to_text(&self) -> String {
        let columns = self.0[0].len();
        let width = |c: usize| self.0.iter().map(|row| row[c].chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..columns).map(width).collect();
        let mut text = String::new();
        for row in &self.0 {
            let mut line = format!("{:1$}", row[0], widths[0]);
            for (cell, width) in row.iter().zip(&widths).skip(1) {
                // Writing to a string cannot fail.
                let _ = write!(line, "  {cell:>width$}");
            }
            text += line.trim_end();
            text.push('\n');
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up() {
        let mut rows = Rows::new(["unit", "×"]);
        rows.push(vec!["a".into(), "12".into()]);
        rows.push(vec!["longer".into(), "3".into()]);
        assert_eq!(rows.to_text(), "unit     ×\na       12\nlonger   3\n");
    }
}
