//! The table and the plot in `docs/`.

use super::Row;
use anyhow::{Context, Result};
use std::fs;
use std::path::PathBuf;

const PAGE: &str = "docs/size-against-error.md";
const PLOT: &str = "docs/images/size-against-error.svg";
/// What stands before and after the table.
const MARKS: [&str; 2] = ["<!-- the table is written by `cargo xtask bench size` -->\n", "<!-- end of the table -->"];

fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..").join(name)
}

/// Puts the table into the page.
pub(super) fn update(rows: &[Row], texels: usize) -> Result<()> {
    let path = path(PAGE);
    let old = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
    let new = replaced(&old, &table(rows, texels)).with_context(|| format!("{PAGE} has no place for the table"))?;
    Ok(fs::write(&path, new)?)
}

pub(super) fn write_plot(svg: &str) -> Result<()> {
    Ok(fs::write(path(PLOT), svg)?)
}

fn table(rows: &[Row], texels: usize) -> String {
    let mut text =
        "| stored as | | kB | bits per texel | RMS | largest error |\n|---|---|--:|--:|--:|--:|\n".to_owned();
    for Row { family, variant, bytes, rms_deg, max_deg } in rows {
        let (kilobytes, bits) = (*bytes as f64 * 1e-3, *bytes as f64 * 8.0 / texels as f64);
        text += &format!("| {family} | {variant} | {kilobytes:.1} | {bits:.2} | {rms_deg:.3}° | {max_deg:.2}° |\n");
    }
    text
}

/// The page with another table between the marks.
fn replaced(page: &str, table: &str) -> Option<String> {
    let (before, rest) = page.split_once(MARKS[0])?;
    let (_, after) = rest.split_once(MARKS[1])?;
    Some([before, MARKS[0], table, MARKS[1], after].concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_table_is_replaced() {
        let page = format!("a\n{}old\n{}\nb\n", MARKS[0], MARKS[1]);
        assert_eq!(replaced(&page, "new\n").unwrap(), page.replace("old", "new"));
        assert_eq!(replaced("no marks", "new"), None);
        let row = Row { family: "f", variant: "v".to_owned(), bytes: 2500, rms_deg: 0.12345, max_deg: 1.0 };
        assert!(table(&[row], 1000).ends_with("| f | v | 2.5 | 20.00 | 0.123° | 1.00° |\n"));
    }
}
