//! A bump unit and the width of its tables.

use std::str::FromStr;

use rilievo::polar::{UnitKind, Width};

/// One of the units.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct UnitArg(pub(crate) UnitKind);

/// A table width in address bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TableBitsArg(pub(crate) Width);

impl FromStr for UnitArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        text.parse().map(Self).map_err(|unknown| format!("'{text}': {unknown}"))
    }
}

impl FromStr for TableBitsArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let bits = text.parse().map_err(|_| format!("'{text}' is not a whole number of address bits, 4 to 14"))?;
        Width::new(bits).map(Self).map_err(|error| error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_listed_and_widths_refused_with_the_reason() {
        assert_eq!("exact-z".parse(), Ok(UnitArg(UnitKind::ExactZ)));
        let error = "e5".parse::<UnitArg>().unwrap_err();
        assert!(error.contains("published") && error.contains("e4d"), "{error}");
        assert_eq!("8".parse(), Ok(TableBitsArg(Width::PAPER)));
        for wrong in ["3", "15", "-1", "eight"] {
            let error = wrong.parse::<TableBitsArg>().unwrap_err();
            assert!(error.contains("4 to 14"), "{error}");
        }
    }
}
