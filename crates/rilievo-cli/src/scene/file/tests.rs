//! docs/scenes.md against what is read.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::material::MODELS;
use super::section::Text;
use super::*;

/// Keys in the first column of the tables below each heading.
fn documented() -> BTreeMap<String, BTreeSet<String>> {
    let mut found: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let mut heading = String::new();
    for line in include_str!("../../../../../docs/scenes.md").lines() {
        if let Some(title) = line.strip_prefix("## ") {
            heading = title.replace('`', "");
        } else if let Some(key) = line.strip_prefix("| `").and_then(|rest| rest.split('`').next()) {
            found.entry(heading.clone()).or_default().insert(key.to_owned());
        }
    }
    found
}

/// Kinds of tables with keys that were asked for in them.
type Asked = BTreeSet<(&'static str, &'static str)>;

fn read_text(text: &str) -> (Result<(SceneSpec, Given)>, Asked) {
    let text = Text::new(Path::new("scene.toml"), text);
    let read = scene(&text, Path::new("scene.toml"));
    (read, text.asked())
}

fn spec(text: &str) -> SceneSpec {
    read_text(text).0.unwrap().0
}

#[test]
fn every_key_is_documented_and_every_documented_key_is_read() {
    let mut asked: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for model in MODELS {
        let text = format!(
            "[[lights]]\n[environment]\n[camera]\n[picture]\n[[objects]]\nmaterials = [\"m\"]\n\
             [materials.m]\nlayers = [{{ model = \"{model}\" }}]"
        );
        let (read, keys) = read_text(&text);
        read.unwrap();
        for (kind, key) in keys {
            let heading = if kind == "the scene" { "The file" } else { kind };
            asked.entry(heading.to_owned()).or_default().insert(key.to_owned());
        }
    }
    assert_eq!(asked, documented());
}

#[test]
fn names_and_defaults_in_the_documentation_are_those_of_the_program() {
    let page = include_str!("../../../../../docs/scenes.md");
    let listed = |names: Vec<String>| {
        let list = names.iter().map(|n| format!("`\"{n}\"`")).collect::<Vec<_>>().join(", ");
        assert!(page.contains(&list), "{list}");
    };
    fn names<T: clap::ValueEnum>() -> Vec<String> {
        let values = T::value_variants().iter().filter_map(clap::ValueEnum::to_possible_value);
        values.map(|v| v.get_name().to_owned()).collect()
    }
    use crate::args::{BlendArg, EdgesArg, EffortArg, FilterArg, SpaceArg};
    listed(names::<MethodArg>());
    listed(names::<OrderArg>());
    listed(names::<MidpointsArg>());
    listed(names::<SamplingArg>());
    listed(names::<BlendArg>());
    listed(names::<EdgesArg>());
    listed(names::<EffortArg>());
    listed(names::<FilterArg>());
    listed(names::<SpaceArg>());
    listed(MODELS.map(str::to_owned).to_vec());
}

#[test]
fn defaults_are_those_of_the_command_line() {
    let scene = spec("[[objects]]");
    let clap = crate::commands::render::asked_for(&["sphere"]);
    assert_eq!(format!("{:?}", scene.camera), format!("{:?}", clap.camera));
    assert_eq!(format!("{:?}", scene.picture), format!("{:?}", clap.picture));
    assert_eq!(format!("{:?}", scene.light.lamps), format!("{:?}", clap.light.lamps));
    assert_eq!(scene.light.ambient, clap.light.ambient);
    let (ours, theirs) = (&scene.objects[0], &clap.objects[0]);
    assert_eq!(format!("{:?}", ours.relief), format!("{:?}", theirs.relief));
    assert_eq!((ours.pose, ours.blend, ours.double_sided), (theirs.pose, theirs.blend, theirs.double_sided));
    // And so they are if the tables are there and empty.
    let empty = spec("[environment]\n[camera]\n[picture]\n[[objects]]\n[[lights]]");
    assert_eq!(format!("{:?}{:?}", empty.camera, empty.picture), format!("{:?}{:?}", scene.camera, scene.picture));
    assert_eq!(
        (empty.light.lamps.as_slice(), empty.light.ambient),
        (scene.light.lamps.as_slice(), scene.light.ambient)
    );
}

#[test]
fn rotations_go_about_x_then_y_then_z() {
    let pose = spec("[[objects]]\nrotation = [90, 90, 0]\nscale = 2\nposition = [0, 0, 1]").objects[0].pose;
    // +Y goes to +Z about x, and on to +X about y.
    assert!((pose.point_to_world(Vec3::Y) - Vec3::new(2.0, 0.0, 1.0)).length() < 1e-5);
}

#[test]
fn errors_name_file_line_and_key() {
    for (text, expected) in [
        ("[[objects]]\nshinyness = 3", "scene.toml:2: `shinyness` is not a key of [[objects]]; there are shape"),
        ("[[objects]]\n\n[camera]\nfov = 180", "scene.toml:4: `fov` is 180; it must be a number from 0.1 to 170"),
        ("[[objects]]\nscale = \"big\"", "scene.toml:2: `scale` must be a number"),
        ("[[objects]]\nscale = nan", "scene.toml:2: `scale` must be a number"),
        ("[[objects]]\nentries = 1", "scene.toml:2: `entries` is 1; it must be a whole number from 2 to 65536"),
        ("[[objects]]\nentries = 2.5", "scene.toml:2: `entries` must be a whole number"),
        ("[[objects]]\nposition = [1, 2]", "scene.toml:2: `position` must be a list of 3 numbers"),
        ("[[objects]]\nedges = \"torn\"", "scene.toml:2: `edges` is 'torn'; it must be one of wrap, clamp, mirror"),
        ("[[objects]]\nshape = \"sphere:9\"", "scene.toml:2: `shape` is wrong"),
        ("[[objects]]\nshape = \"rock.obj\"", "scene.toml:2: `shape` is 'rock.obj', which is no built-in shape"),
        ("[[objects]]\nmaterials = [\"clay\"]", "scene.toml:2: there is no [materials.clay]; the file has none"),
        ("[materials.m]\nlayers = [\n{ model = \"shiny\" }]\n[[objects]]", "scene.toml:3: `model` is 'shiny'"),
        ("[materials.m]\nlayers = [{ weight = 1 }]\n[[objects]]", "scene.toml:2: `model` is missing"),
        (
            "[materials.m]\nlayers = [{ model = \"lambert\", shininess = 3 }]\n[[objects]]",
            "scene.toml:2: `shininess` is not a key of layers; there are model, weight, color",
        ),
        ("[materials.m]\nshininess = 1\nlayers = []\n[[objects]]", "scene.toml:2: `shininess` says the same"),
        ("[materials.m]\ndiffuse = \"red\"\n[[objects]]", "scene.toml:2: `diffuse` is wrong: 'red' is not a colour"),
        (
            "[[lights]]\nposition = [0, 0, 1]\nazimuth = 3\n[[objects]]",
            "scene.toml:3: `azimuth` is for a light from a side",
        ),
        (
            "[camera]\neye = [0, 0, 1]\ndistance = 3\n[[objects]]",
            "scene.toml:3: `distance` is for a camera on an orbit",
        ),
        ("[camera]\nnear = 1\n[[objects]]", "scene.toml:2: `near` is for a camera with an `eye`"),
        ("[camera]\neye = [0, 0, 1]\ntarget = [0, 0, 1]\n[[objects]]", "scene.toml:2: `eye` is where the `target` is"),
        ("[picture]\nsize = [0, 4]\n[[objects]]", "scene.toml:2: `size` is too large or empty"),
        ("[picture]\nsamples = 9\n[[objects]]", "scene.toml:2: `samples` is 9; it must be a whole number from 1 to 8"),
        ("[pictures]\n[[objects]]", "scene.toml:1: `pictures` is not a key of the scene"),
        ("[picture]\n", "`objects` is missing"),
        ("[[objects]]\ndepth = = 3", "scene.toml:2: "),
        ("[[objects]]\ndepth = 1\ndepth = 2", "scene.toml:3: "),
    ] {
        let error = read_text(text).0.err().map(|e| format!("{e:#}")).unwrap_or_default();
        assert!(
            error.starts_with(expected) || (expected.starts_with('`') && error.contains(expected)),
            "{text}: {error}"
        );
    }
}

#[test]
fn damaged_files_end_in_a_message() {
    let page = include_str!("../../../../../docs/scenes.md");
    let example = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let end = |text: &str| {
        if let Err(error) = read_text(text).0 {
            assert!(format!("{error:#}").starts_with("scene.toml:"), "{text}: {error:#}");
        }
    };
    (0..=example.len()).filter_map(|end| example.get(..end)).for_each(end);
    for at in 0..example.len() {
        for mark in ["\0", "9", "-", "[", "}", "\"", "=", "é", "\n"] {
            if let (Some(before), Some(after)) = (example.get(..at), example.get(at + 1..)) {
                end(&format!("{before}{mark}{after}"));
            }
        }
    }
}
