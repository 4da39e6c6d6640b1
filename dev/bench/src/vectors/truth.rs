//! Lengths and pictures.

use crate::report::Report;
use anyhow::Result;

pub(super) fn run(_report: &mut Report) -> Result<()> {
    Ok(())
}
