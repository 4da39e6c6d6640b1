//! Cases and how they are told: a table, or one JSON object a line.

use crate::harness::Spent;
use anyhow::Result;
use serde_json::{Value, json};
use std::io::Write;

/// What `ours` and `peer` are counted in, and so which way round their ratio is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unit {
    /// Ratio: peer's over ours; larger is better.
    Seconds,
    /// Ratio: ours over the bound's; smaller is better.
    Degrees,
    /// Ratio: ours over the peer's; smaller is better.
    Bytes,
}

/// One measured figure.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    /// `group/case`.
    pub(crate) name: String,
    pub(crate) unit: Unit,
    pub(crate) ours: f64,
    /// The other side's figure, or the bound.
    pub(crate) peer: Option<f64>,
    /// How alike the pictures of both sides are.
    pub(crate) psnr_db: Option<f64>,
    /// What the ratio should be at least (times) or at most (errors).
    pub(crate) target: Option<f64>,
    /// Time that was taken beside an error.
    pub(crate) spent: Option<Spent>,
    /// What the reader has to know.
    pub(crate) note: String,
}

impl Case {
    pub(crate) fn new(name: impl Into<String>, unit: Unit, ours: f64, peer: Option<f64>) -> Self {
        Self { name: name.into(), unit, ours, peer, psnr_db: None, target: None, spent: None, note: String::new() }
    }

    fn ratio(&self) -> Option<f64> {
        self.peer.map(|peer| match self.unit {
            Unit::Seconds => peer / self.ours,
            Unit::Degrees | Unit::Bytes => self.ours / peer,
        })
    }

    fn met(&self) -> Option<bool> {
        let (ratio, target) = (self.ratio()?, self.target?);
        Some(match self.unit {
            Unit::Seconds => ratio >= target,
            Unit::Degrees | Unit::Bytes => ratio <= target,
        })
    }

    fn to_json(&self) -> Value {
        let mut object = json!({
            "case": self.name,
            "unit": match self.unit { Unit::Seconds => "s", Unit::Degrees => "deg", Unit::Bytes => "B" },
            "ours": self.ours,
            "peer": self.peer,
            "ratio": self.ratio(),
            "psnr_db": self.psnr_db,
            "target": self.target,
            "met": self.met(),
        });
        if let Some(spent) = self.spent {
            object["cpu_seconds"] = spent.cpu_seconds.into();
            object["wall_seconds"] = spent.wall_seconds.into();
        }
        if !self.note.is_empty() {
            object["note"] = self.note.as_str().into();
        }
        object
    }

    fn to_row(&self) -> String {
        let or_dash = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
        let target = self.target.map(|target| match self.unit {
            Unit::Seconds => format!("≥ {target}"),
            Unit::Degrees | Unit::Bytes => format!("≤ {target}"),
        });
        let spent = self.spent.map(|s| format!("{:.2} s CPU, {:.2} s wall", s.cpu_seconds, s.wall_seconds));
        let remarks: Vec<_> = spent.into_iter().chain((!self.note.is_empty()).then(|| self.note.clone())).collect();
        format!(
            "{:<24} {:>11} {:>11} {:>8} {:>8} {:>7} {:>4}  {}",
            self.name,
            amount(self.ours, self.unit),
            or_dash(self.peer.map(|p| amount(p, self.unit))),
            or_dash(self.ratio().map(|r| if r < 100.0 { format!("{r:.3}") } else { format!("{r:.0}") })),
            or_dash(self.psnr_db.map(|p| format!("{p:.1} dB"))),
            or_dash(target),
            or_dash(self.met().map(|met| if met { "yes" } else { "NO" }.to_owned())),
            remarks.join("; "),
        )
    }
}

fn amount(value: f64, unit: Unit) -> String {
    match unit {
        Unit::Degrees => format!("{value:.4}°"),
        Unit::Bytes if value < 1e7 => format!("{:.1} kB", value * 1e-3),
        Unit::Bytes => format!("{:.0} MB", value * 1e-6),
        Unit::Seconds if value < 1e-6 => format!("{:.1} ns", value * 1e9),
        Unit::Seconds if value < 1e-3 => format!("{:.1} µs", value * 1e6),
        Unit::Seconds if value < 1.0 => format!("{:.2} ms", value * 1e3),
        Unit::Seconds => format!("{value:.3} s"),
    }
}

/// Where figures go, as soon as each is known.
pub(crate) struct Report {
    json: bool,
    missed: Vec<String>,
}

impl Report {
    pub(crate) fn new(json: bool) -> Self {
        Self { json, missed: Vec::new() }
    }

    /// Tells one figure.
    pub(crate) fn add(&mut self, case: &Case) -> Result<()> {
        if case.met() == Some(false) {
            self.missed.push(case.name.clone());
        }
        self.line(&if self.json { case.to_json().to_string() } else { case.to_row() })
    }

    /// Tells a row of another table.
    pub(crate) fn row(&self, value: &Value, text: &str) -> Result<()> {
        self.line(&if self.json { value.to_string() } else { text.to_owned() })
    }

    /// The head of the table.
    pub(crate) fn heading(&self) -> Result<()> {
        if self.json {
            return Ok(());
        }
        let [case, ours, peer, ratio] = ["case", "ours", "peer", "ratio"];
        let [psnr, target, met] = ["PSNR", "target", "met"];
        self.line(&format!("{case:<24} {ours:>11} {peer:>11} {ratio:>8} {psnr:>8} {target:>7} {met:>4}"))
    }

    /// Says which targets were missed: an answer, not a failure.
    pub(crate) fn close(&self) -> Result<()> {
        if !self.missed.is_empty() {
            self.remark(&format!("targets not met: {}", self.missed.join(", ")));
        }
        Ok(())
    }

    /// A line of the result, on stdout.
    pub(crate) fn line(&self, text: &str) -> Result<()> {
        Ok(writeln!(std::io::stdout().lock(), "{text}")?)
    }

    /// Something beside the result, on stderr.
    #[expect(clippy::print_stderr, reason = "stdout holds nothing but results")]
    pub(crate) fn remark(&self, text: &str) {
        eprintln!("{text}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(value: &Value) -> Vec<&str> {
        value.as_object().unwrap().keys().map(String::as_str).collect()
    }

    #[test]
    fn json_of_a_time_has_the_keys_scripts_rely_on() {
        let case = Case { psnr_db: Some(44.5), target: Some(3.5), ..Case::new("g/c", Unit::Seconds, 0.5, Some(2.0)) };
        let value = case.to_json();
        for key in ["case", "ours", "peer", "ratio", "psnr_db", "target", "met"] {
            assert!(keys(&value).contains(&key), "{key}");
        }
        assert_eq!((&value["case"], &value["ratio"], &value["met"]), (&json!("g/c"), &json!(4.0), &json!(true)));
        assert!(!value.to_string().contains('\n'));
    }

    #[test]
    fn errors_are_ours_over_the_bound_and_should_be_small() {
        let mut case = Case { target: Some(1.25), ..Case::new("g/c", Unit::Degrees, 3.0, Some(2.0)) };
        assert_eq!((case.ratio(), case.met()), (Some(1.5), Some(false)));
        case.ours = 2.5;
        assert_eq!((case.ratio(), case.met()), (Some(1.25), Some(true)));
    }

    #[test]
    fn slower_than_the_target_is_not_met() {
        let case = Case { target: Some(0.75), ..Case::new("g/c", Unit::Seconds, 1.0, Some(0.5)) };
        assert_eq!(case.met(), Some(false));
        let mut report = Report::new(true);
        report.add(&case).unwrap();
        assert_eq!(report.missed, ["g/c"]);
    }

    #[test]
    fn what_has_no_peer_or_target_is_null_and_not_missed() {
        let alone = Case { target: Some(1.0), ..Case::new("g/c", Unit::Degrees, 1.0, None) };
        let value = alone.to_json();
        assert!(["peer", "ratio", "met", "psnr_db"].iter().all(|key| value[key].is_null()));
        assert_eq!(Case::new("g/c", Unit::Seconds, 1.0, Some(1.0)).to_json()["met"], Value::Null);
    }

    #[test]
    fn time_and_note_stand_beside() {
        let spent = Some(Spent { cpu_seconds: 1.5, wall_seconds: 2.0 });
        let case = Case { spent, note: "why".to_owned(), ..Case::new("g/c", Unit::Degrees, 1.0, None) };
        assert_eq!(case.to_json()["cpu_seconds"], json!(1.5));
        assert!(case.to_row().ends_with("1.50 s CPU, 2.00 s wall; why"), "{}", case.to_row());
        assert!(!keys(&Case::new("g/c", Unit::Degrees, 1.0, None).to_json()).contains(&"note"));
    }

    #[test]
    fn amounts_are_readable() {
        assert_eq!(amount(0.000_012_34, Unit::Seconds), "12.3 µs");
        assert_eq!(amount(0.25, Unit::Seconds), "250.00 ms");
        assert_eq!(amount(2.0, Unit::Seconds), "2.000 s");
        assert_eq!(amount(5.1, Unit::Degrees), "5.1000°");
    }
}
