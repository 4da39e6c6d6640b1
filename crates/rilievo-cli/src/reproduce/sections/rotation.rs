//! The rotation of Lee et al. alone: where and how much it errs.

use std::f64::consts::{FRAC_PI_2, PI};

use anyhow::Result;
use rilievo::color::Picture;
use rilievo::polar::{PixelSampling, Polar, Rotation, rotation_errors};
use rilievo::{Grid, LinearRgb};

use crate::reproduce::Kit;
use crate::reproduce::findings::{Column, Findings, Shot, Shots, Table};

/// Polar angles of the normal that maps are drawn for, in degrees.
const NORMALS: [u32; 4] = [15, 45, 75, 90];
/// What the brightest colour of a map stands for, in degrees.
const FULL_DEG: f64 = 60.0;
/// Cells of a map, across and down: one for each degree of Δ and half a degree of θ.
const CELLS: (u32, u32) = (360, 180);

/// Known answers: Δ, θA, θN and the error, all in degrees, derived by hand from the equations.
const KNOWN: [[f64; 4]; 5] = [
    [90.0, 90.0, 90.0, 45.0],
    [45.0, 90.0, 90.0, 60.0],
    [45.0, 60.0, 0.0, 7.229],
    [60.0, 45.0, 45.0, 16.20],
    [90.0, 60.0, 30.0, 28.96],
];

pub(crate) fn run(kit: &Kit<'_>) -> Result<Findings> {
    let mut found = Findings::default();
    found.paper(
        "Equations (5) to (9) and (15) to (18) rotate a polar vector into the reference space by angles alone. They are derived from a picture of the sphere and \
         taken for exact.",
    );
    found.here(
        "The same equations in 64-bit floating point with their misprints mended, against the rotation matrix: no table and no rounding plays a part. Vectors and \
         normals are uniform over the upper half of the sphere; pairs with the vector on the normal's side count. “Exact Z” is the published unit with its \
         first mistake taken out.",
    );
    let pixels = PixelSampling { count: if kit.quick { 50_000 } else { 1_000_000 }, ..PixelSampling::default() };
    let columns = ["rotation", "mean, °", "RMS, °", "one in a hundred, °", "largest, °"].map(Column::here);
    let mut table = Table::new("Angle between the rotated vector and where it should be.", columns.to_vec());
    let mut rms = [0.0; 2];
    let both = [("published", "published", Rotation::Published), ("exact Z", "exact_z", Rotation::ExactZ)];
    for (k, (name, key, rotation)) in both.into_iter().enumerate() {
        let stats = rotation_errors(rotation, &pixels)?;
        let degrees = [stats.mean, stats.rms, stats.p99, stats.max].map(f64::to_degrees);
        rms[k] = degrees[1];
        for (what, value) in ["mean", "rms", "p99", "max"].into_iter().zip(degrees) {
            found.figure(format!("{key}_{what}_deg"), value);
        }
        table.row(std::iter::once(name.to_owned()).chain(degrees.map(|d| format!("{d:.1}"))).collect());
    }
    found.show(table);
    found.show(known());
    for (name, rotation) in [("published", Rotation::Published), ("exact Z", Rotation::ExactZ)] {
        found.show(maps(name, rotation)?);
    }
    found.remark(format!(
        "The published rotation is off by {:.1}° RMS. Its main mistake is that a circle of constant x does not stay one under a rotation about y: the true \
         x' = x·cos θN − z·sin θN is the paper's sin(θx − θN) only where y = 0 or θN = 0. With that mended {:.1}° RMS are left, of the “angular proportion” of equation (10): \
         cos θ' is the product of two cosines, and the linear form is too large by up to 8.61°. Only Δ = 0° and 180° are exact. The exact units cost no more; see the tables \
         above.",
        rms[0], rms[1]
    ));
    Ok(found)
}

fn polar(phi_deg: f64, theta_deg: f64) -> Polar {
    Polar { phi: phi_deg.to_radians(), theta: theta_deg.to_radians() }
}

fn known() -> Table {
    let columns = ["Δ, °", "θA, °", "θN, °", "error, °", "by hand, °"].map(Column::here);
    let mut table = Table::new("Single vectors, as a check.", columns.to_vec());
    for [delta, theta_a, theta_n, expected] in KNOWN {
        let error = Rotation::Published.error_rad(polar(delta, theta_a), polar(0.0, theta_n)).to_degrees();
        table.row([delta, theta_a, theta_n, error, expected].map(|v| format!("{v:.6}")).map(trimmed).to_vec());
    }
    table
}

/// Two digits at most, without needless zeros.
fn trimmed(text: String) -> String {
    let value: f64 = text.parse().unwrap_or(f64::NAN);
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A map for each normal: Δ across, θA down; grey where the vector is behind the surface.
fn maps(name: &str, rotation: Rotation) -> Result<Shots> {
    let mut shots = Shots::new(4);
    for theta_n in NORMALS {
        let normal = polar(0.0, theta_n.into());
        let mut worst = 0.0f64;
        let cells = Grid::from_fn(CELLS.0, CELLS.1, |x, y| {
            let delta = (f64::from(x) + 0.5) / f64::from(CELLS.0) * 2.0 * PI - PI;
            let theta = (f64::from(y) + 0.5) / f64::from(CELLS.1) * FRAC_PI_2;
            let a = Polar { phi: delta, theta };
            // A·N, with φN = 0.
            let facing = a.theta.sin() * a.phi.cos() * normal.theta.sin() + a.theta.cos() * normal.theta.cos();
            let error = (facing > 0.0).then(|| rotation.error_rad(a, normal).to_degrees());
            worst = worst.max(error.unwrap_or(0.0));
            error
        })?;
        let picture: Picture = cells.map(|error| error.map_or(LinearRgb::gray(0.2), heat).to_srgb());
        let caption = format!(
            "θN = {theta_n}°; Δ from −180° to 180° across, θA from 0° to 90° down; black 0°, white {FULL_DEG}°; largest {worst:.1}°"
        );
        shots.add(Shot::new(&picture, name, caption)?);
    }
    Ok(shots)
}

/// Black, violet, red, yellow, white: brighter with every degree, also to eyes that see few colours.
fn heat(degrees: f64) -> LinearRgb {
    const STOPS: [[f32; 3]; 5] =
        [[0.0, 0.0, 0.0], [0.09, 0.01, 0.2], [0.55, 0.03, 0.06], [0.95, 0.55, 0.03], [1.0, 1.0, 1.0]];
    let at = (degrees / FULL_DEG).clamp(0.0, 1.0) as f32 * (STOPS.len() - 1) as f32;
    let k = (at as usize).min(STOPS.len() - 2);
    let [r, g, b] = [0, 1, 2].map(|c| STOPS[k][c] + (STOPS[k + 1][c] - STOPS[k][c]) * (at - k as f32));
    LinearRgb::new(r, g, b)
}
