//! Results on stdout: lines for people, or one JSON object per input.

use std::io::{self, Write};

use anyhow::{Context, Result};
use rilievo::measure::AngleStats;
use serde_json::{Map, Value};

/// Six digits say all that was measured; what is not finite has no number.
pub(crate) fn number(value: f64) -> Value {
    let rounded = format!("{value:.6}").parse::<f64>().unwrap_or(value);
    serde_json::Number::from_f64(rounded).map_or(Value::Null, Value::Number)
}

/// Named results in the order they were added.
#[derive(Debug, Default)]
pub(crate) struct Report {
    rows: Vec<(String, Value)>,
}

impl Report {
    /// Adds a result.
    pub(crate) fn add(&mut self, key: &str, value: impl Into<Value>) -> &mut Self {
        self.rows.push((key.to_owned(), value.into()));
        self
    }

    /// Adds an angle or another measured figure; what is not finite becomes `null` in JSON.
    pub(crate) fn add_f64(&mut self, key: &str, value: f64) -> &mut Self {
        self.add(key, number(value))
    }

    /// Adds a list of measured figures; left out if it is empty.
    pub(crate) fn add_f64s(&mut self, key: &str, values: impl Iterator<Item = f64>) -> &mut Self {
        let values: Vec<Value> = values.map(number).collect();
        if values.is_empty() { self } else { self.add(key, values) }
    }

    /// Adds the four error keys of normal maps, in degrees.
    pub(crate) fn add_angles(&mut self, stats: &AngleStats) -> &mut Self {
        self.add_f64("rms_deg", stats.rms_rad.to_degrees())
            .add_f64("mean_deg", stats.mean_rad.to_degrees())
            .add_f64("p99_deg", stats.p99_rad.to_degrees())
            .add_f64("max_deg", stats.max_rad.to_degrees())
    }

    /// Writes it to stdout.
    pub(crate) fn print(self, json: bool) -> Result<()> {
        let mut out = io::stdout().lock();
        if json {
            let object: Map<String, Value> = self.rows.into_iter().collect();
            writeln!(out, "{}", Value::Object(object)).context("stdout")?;
            return Ok(());
        }
        let width = self.rows.iter().map(|(k, _)| k.len()).max().unwrap_or(0);
        for (key, value) in &self.rows {
            match value {
                Value::String(text) => writeln!(out, "{key:width$}  {text}"),
                // Infinite has no number in JSON: the PSNR of equal pictures.
                Value::Null => writeln!(out, "{key:width$}  inf"),
                Value::Array(list) => {
                    let list: Vec<String> = list.iter().map(ToString::to_string).collect();
                    writeln!(out, "{key:width$}  {}", list.join(" "))
                }
                other => writeln!(out, "{key:width$}  {other}"),
            }
            .context("stdout")?;
        }
        Ok(())
    }
}
