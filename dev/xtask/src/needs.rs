//! `cargo xtask needs`: the external tools, what for, and how to get them.

use crate::run::{Run, has_cargo_command, is_ci, on_path};
use anyhow::{Result, bail};
use std::path::Path;

/// What becomes of the work without a tool.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Without {
    /// Nothing builds.
    Stop,
    /// Something is skipped, and said so; with `CI=true` that is a failure.
    Skip,
    /// The same work is done another way, or was never promised.
    Fine,
}

/// One external tool.
struct Tool {
    name: &'static str,
    /// Any one of these programs will do. A cargo subcommand is spelled `cargo NAME`, a file by its path from the root.
    programs: &'static [&'static str],
    purpose: &'static str,
    without: Without,
    debian: Option<&'static str>,
    /// How to get it elsewhere.
    hint: &'static str,
}

const TOOLS: &[Tool] = &[
    Tool {
        name: "C compiler",
        programs: &["cc", "gcc", "clang"],
        purpose: "builds Zstandard for KTX2 files",
        without: Without::Stop,
        debian: Some("gcc libc6-dev"),
        hint: "install gcc or clang",
    },
    Tool {
        name: "C++ compiler",
        programs: &["c++", "g++", "clang++"],
        purpose: "builds the reference of the FLIP measure, for tests",
        without: Without::Stop,
        debian: Some("g++"),
        hint: "install g++ or clang",
    },
    Tool {
        name: "rustfmt",
        programs: &["cargo fmt"],
        purpose: "checks the format",
        without: Without::Skip,
        debian: None,
        hint: "rustup component add rustfmt",
    },
    Tool {
        name: "clippy",
        programs: &["cargo clippy"],
        purpose: "checks the lints",
        without: Without::Skip,
        debian: None,
        hint: "rustup component add clippy",
    },
    Tool {
        name: "rustup",
        programs: &["rustup"],
        purpose: "gets the standard library for WebAssembly, for the page",
        without: Without::Fine,
        debian: None,
        hint: "install Rust by rustup",
    },
    Tool {
        name: "git",
        programs: &["git"],
        purpose: "lists the files for the hygiene step",
        without: Without::Skip,
        debian: Some("git"),
        hint: "install git",
    },
    Tool {
        name: "pngquant",
        programs: &["pngquant"],
        purpose: "makes palette pictures that the import tests read",
        without: Without::Skip,
        debian: Some("pngquant"),
        hint: "install pngquant",
    },
    Tool {
        name: "pnmquant",
        programs: &["pnmquant"],
        purpose: "makes palette pictures that the import tests read",
        without: Without::Skip,
        debian: Some("netpbm"),
        hint: "install netpbm",
    },
    Tool {
        name: "pngtopnm",
        programs: &["pngtopnm"],
        purpose: "turns pictures into what pnmquant reads",
        without: Without::Skip,
        debian: Some("netpbm"),
        hint: "install netpbm",
    },
    Tool {
        name: "verilator",
        programs: &["verilator"],
        purpose: "simulates the hardware of the polar units",
        without: Without::Skip,
        debian: Some("verilator make g++"),
        hint: "install verilator 5",
    },
    Tool {
        name: "yosys",
        programs: &["yosys"],
        purpose: "counts what the hardware of the polar units is made of",
        without: Without::Skip,
        debian: Some("yosys"),
        hint: "install yosys",
    },
    Tool {
        name: "chromium",
        programs: &["chromium"],
        purpose: "opens the pages that the program writes, and drags their light",
        without: Without::Skip,
        debian: Some("chromium"),
        hint: "install chromium",
    },
    Tool {
        name: "Xvfb",
        programs: &["Xvfb"],
        purpose: "a display without a screen, on which the viewer's window is tested",
        without: Without::Skip,
        debian: Some("xvfb libx11-xcb1 libxkbcommon-x11-0 libxcursor1 libxi6"),
        hint: "install Xvfb and the X libraries that windows are opened with",
    },
    Tool {
        name: "lavapipe",
        programs: &[
            "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json",
            "/usr/share/vulkan/icd.d/lvp_icd.aarch64.json",
            "/usr/share/vulkan/icd.d/lvp_icd.json",
        ],
        purpose: "a software GPU: the GPU renderer is tested on it, the CPU renderer measured against it",
        without: Without::Skip,
        debian: Some("mesa-vulkan-drivers libvulkan1"),
        hint: "install Mesa's software Vulkan driver; tests take whatever GPU there is",
    },
    Tool {
        name: "SwiftShader",
        programs: &["/usr/lib/chromium/vk_swiftshader_icd.json"],
        // A peer of `cargo xtask bench raster`: nothing but that looks for it, so nobody gets it unasked.
        purpose: "another software GPU that the bench holds the renderer against",
        without: Without::Fine,
        debian: None,
        hint: "on Debian: apt-get install --no-install-recommends chromium libvulkan1",
    },
    Tool {
        name: "cargo-nextest",
        programs: &["cargo nextest"],
        purpose: "runs tests faster and with a time limit; cargo test does without",
        without: Without::Fine,
        debian: None,
        hint: "cargo install cargo-nextest --locked",
    },
];

impl Tool {
    fn is_there(&self) -> bool {
        // On Windows the compilers are found in the registry, not on the search path: let the build find out.
        if cfg!(windows) && self.without == Without::Stop {
            return true;
        }
        self.programs.iter().any(|program| match program.strip_prefix("cargo ") {
            Some(command) => has_cargo_command(command),
            None if program.starts_with('/') => Path::new(program).is_file(),
            None => on_path(program),
        })
    }

    fn describe(&self) -> String {
        format!("{} is missing ({})", self.name, self.purpose)
    }
}

/// Whether the tool of this name is there.
pub(crate) fn has(name: &str) -> bool {
    TOOLS.iter().find(|tool| tool.name == name).is_some_and(Tool::is_there)
}

/// An error that says how to get what of these tools is not there.
pub(crate) fn demand(names: &[&str]) -> Result<()> {
    let missing: Vec<&Tool> = missing().into_iter().filter(|tool| names.contains(&tool.name)).collect();
    verdict(&missing)?;
    if let Some(tool) = missing.first() {
        bail!("{}", tool.describe());
    }
    Ok(())
}

fn missing() -> Vec<&'static Tool> {
    TOOLS.iter().filter(|tool| !tool.is_there()).collect()
}

/// The Debian packages of these tools, each once.
fn debian_packages(tools: &[&Tool]) -> Vec<&'static str> {
    let mut packages: Vec<_> = tools.iter().filter_map(|tool| tool.debian).flat_map(str::split_whitespace).collect();
    packages.sort_unstable();
    packages.dedup();
    packages
}

/// `cargo xtask needs`: says what is missing and installs nothing.
pub(crate) fn report() -> Result<()> {
    for tool in TOOLS {
        eprintln!("{:<8} {:<14} {}", if tool.is_there() { "found" } else { "MISSING" }, tool.name, tool.purpose);
    }
    verdict(&missing()).map(drop)
}

/// The first step of `cargo xtask test`: as root on a Debian-like system gets what is missing, after saying so.
/// Gives what has to be skipped.
pub(crate) fn provide() -> Result<Vec<String>> {
    let packages = debian_packages(&missing());
    if !packages.is_empty() && on_path("apt-get") && is_root() {
        eprintln!("Missing tools; getting them with apt-get, as this is root on a Debian-like system.");
        let apt = || Run::new("apt-get").env("DEBIAN_FRONTEND", "noninteractive");
        let got = apt()
            .arg("update")
            .wait()
            .and_then(|()| apt().args(["install", "-y", "--no-install-recommends"]).args(&packages).wait());
        if let Err(error) = got {
            eprintln!("{error:#}");
        }
    }
    verdict(&missing())
}

/// Says how to get what is missing. An error if nothing can build, or if something would be skipped in CI;
/// otherwise what is skipped.
fn verdict(missing: &[&Tool]) -> Result<Vec<String>> {
    let packages = debian_packages(missing);
    for tool in missing {
        eprintln!("{}: {}", tool.describe(), tool.hint);
    }
    if !packages.is_empty() {
        eprintln!("On Debian or Ubuntu: apt-get install --no-install-recommends {}", packages.join(" "));
    }
    let fatal = fatal(missing, is_ci());
    if !fatal.is_empty() {
        bail!("{}", fatal.join("; "));
    }
    Ok(missing.iter().filter(|tool| tool.without == Without::Skip).map(|tool| tool.describe()).collect())
}

fn fatal(missing: &[&Tool], ci: bool) -> Vec<String> {
    let stops = |tool: &&&Tool| tool.without == Without::Stop || (ci && tool.without == Without::Skip);
    missing.iter().filter(stops).map(|tool| tool.describe()).collect()
}

fn is_root() -> bool {
    // Asked of `id`, as the standard library has no call for it.
    on_path("id") && Run::new("id").arg("-u").output().is_ok_and(|id| id.trim() == "0")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tool(name: &str) -> &'static Tool {
        TOOLS.iter().find(|tool| tool.name == name).unwrap()
    }

    #[test]
    fn packages_are_named_once_and_sorted() {
        let tools = [tool("pnmquant"), tool("pngtopnm"), tool("C compiler"), tool("rustfmt")];
        assert_eq!(debian_packages(&tools), ["gcc", "libc6-dev", "netpbm"]);
    }

    #[test]
    fn missing_compiler_always_stops() {
        assert_eq!(fatal(&[tool("C++ compiler")], false).len(), 1);
    }

    #[test]
    fn missing_peer_stops_only_ci() {
        assert!(fatal(&[tool("pngquant")], false).is_empty());
        assert_eq!(fatal(&[tool("pngquant")], true).len(), 1);
    }

    #[test]
    fn missing_convenience_never_stops() {
        assert!(fatal(&[tool("cargo-nextest")], true).is_empty());
    }

    #[test]
    fn a_peer_s_driver_is_nobody_s_duty_and_not_installed_unasked() {
        let drivers = [tool("SwiftShader")];
        assert!(fatal(&drivers, true).is_empty());
        assert!(debian_packages(&drivers).is_empty());
    }

    #[test]
    fn file_is_looked_for_where_it_should_lie() {
        let there = |file: &'static str| {
            let programs: &'static [&'static str] = Box::leak(Box::new([file]));
            Tool { programs, without: Without::Fine, ..*tool("lavapipe") }.is_there()
        };
        assert!(!there("/no/such/file"));
        let me: &'static str = Box::leak(std::env::current_exe().unwrap().to_str().unwrap().into());
        assert!(!me.starts_with('/') || there(me));
    }

    #[test]
    fn steps_name_tools_that_exist() {
        for step in crate::test::STEPS {
            for name in step.tools {
                tool(name);
            }
        }
    }
}
