//! Table 1 of Hast et al.: the setup of Duff's denominator on the actual and on the ortho-normalised triangle.

use std::hint::black_box;

use anyhow::Result;
use glam::{DVec2, Vec3};
use rilievo::Progress;
use rilievo::fill::Triangle;
use rilievo::raster::scanline::{LeftEdges, Setup, set_up_denominator};

use crate::reproduce::Kit;
use crate::reproduce::findings::{Column, Findings, Table};

/// Height of the picture that the triangles lie in.
const PICTURE: u32 = 1024;
/// Left edges, what keys call it, and the paper's seconds for 10⁸ triangles on both triangles.
const ROWS: [(usize, &str, [f64; 2]); 2] = [(1, "one_left_edge", [24.7, 16.1]), (2, "two_left_edges", [26.2, 16.4])];

pub(crate) fn run(kit: &Kit<'_>) -> Result<Findings> {
    let count = if kit.quick { 500 } else { 20_000 };
    kit.bars.begin("timing the setup", 1);
    let triangles = ROWS.map(|(edges, ..)| random_triangles(count, edges == 2));
    // Sides: the actual and the ortho-normalised triangle with one left edge, with two, and an empty loop.
    let times = kit.clock.turns(5, |side| {
        let how = if side % 2 == 0 { Setup::Actual } else { Setup::Normalized };
        let sum: f32 = match triangles.get(side / 2) {
            Some(all) => all.iter().map(|(edges, corners)| set_up_denominator(how, edges, corners)).sum(),
            None => triangles[0].iter().map(|(_, corners)| corners[0].x).sum(),
        };
        black_box(sum);
        Ok(())
    })?;
    let ns: Vec<f64> = times.iter().map(|s| s * 1e9 / count as f64).collect();
    kit.bars.advance(1);
    Ok(told(&ns, count))
}

fn told(ns: &[f64], count: usize) -> Findings {
    let mut found = Findings::default();
    found.paper(
        "Vectors that are interpolated linearly are divided by their length, whose square is a quadratic polynomial over the \
         triangle (Duff). Its coefficients and the variables of the two inner loops are set up on the triangle as it lies on \
         the screen, through six samples (Abbas et al. 2001), or on a triangle with corners (0, 0), (1, 0), (0, 1), straight \
         from the linear vector. The paper times 100 million triangles on a Pentium 4 at 1.8 GHz.",
    );
    found.here(format!(
        "{count} random triangles, 40 to 100 pixels high, whose middle corner is on the right (one left edge) or on the left \
         (two). Both ways end in the same variables, which a test compares. The paper's seconds for 10⁸ triangles are given in \
         nanoseconds for one."
    ));
    let mut table = Table::new(
        format!("Nanoseconds a triangle; an empty loop over the triangles takes {:.1} ns (paper: 2.4).", ns[4]),
        vec![
            Column::here("left edges"),
            Column::here("actual triangle"),
            Column::here("ortho-normalised"),
            Column::here("ratio"),
            Column::paper("actual triangle"),
            Column::paper("ortho-normalised"),
            Column::paper("ratio"),
        ],
    );
    let mut ratios = Vec::new();
    for (i, (edges, key, paper)) in ROWS.into_iter().enumerate() {
        let [actual, normalized] = [ns[2 * i], ns[2 * i + 1]];
        let (ratio, paper_ratio) = (actual / normalized, paper[0] / paper[1]);
        found.against(format!("{key}_actual_ns"), actual, paper[0] * 10.0);
        found.against(format!("{key}_normalised_ns"), normalized, paper[1] * 10.0);
        found.against(format!("{key}_ratio"), ratio, paper_ratio);
        table.row(vec![
            edges.to_string(),
            format!("{actual:.1}"),
            format!("{normalized:.1}"),
            format!("{ratio:.2}"),
            format!("{:.0}", paper[0] * 10.0),
            format!("{:.0}", paper[1] * 10.0),
            format!("{paper_ratio:.2}"),
        ]);
        ratios.push(ratio);
    }
    found.show(table);
    let verdict = if ratios.iter().all(|&r| r > 1.05) {
        "The order is the paper's: the ortho-normalised triangle is the cheaper one"
    } else if ratios.iter().any(|&r| r < 0.95) {
        "The order is not the paper's here: the actual triangle is no dearer in every row"
    } else {
        "The two cost about the same here"
    };
    let edges = if ratios[1] < ratios[0] {
        "the second edge brings the ratio nearer to 1 here, which in the paper it does not"
    } else {
        "the second edge changes the ratio little, as in the paper"
    };
    found.remark(format!(
        "{verdict}; actual over ortho-normalised is {:.2} and {:.2} where the paper has 1.53 and 1.60. The variables on the left edges \
         are the same work in both columns: {edges}. As the paper says itself, the gain is of academic interest: it is nanoseconds a \
         triangle.",
        ratios[0], ratios[1]
    ));
    found
}

/// Triangles whose middle corner is on the left, or on the right, with unit vectors at their corners.
fn random_triangles(count: usize, two_left: bool) -> Vec<(LeftEdges, [Vec3; 3])> {
    let mut random = Random(11);
    let mut out = Vec::with_capacity(count);
    while out.len() < count {
        let mut within = |low: f64, high: f64| low + (high - low) * random.unit();
        let top = DVec2::new(within(100.0, 900.0), within(100.0, 800.0));
        let bottom = top + DVec2::new(within(-60.0, 60.0), within(40.0, 100.0));
        let aside = DVec2::X * within(10.0, 60.0) * if two_left { -1.0 } else { 1.0 };
        let middle = top.lerp(bottom, within(0.2, 0.8)) + aside;
        let mut unit = || Vec3::new(within(-0.5, 0.5) as f32, within(-0.5, 0.5) as f32, 1.0).normalize();
        let corners = [unit(), unit(), unit()];
        out.extend(Triangle::new([top, middle, bottom]).map(|shape| (LeftEdges::new(&shape, PICTURE), corners)));
    }
    out
}

/// Numbers that look random and are the same in every run (SplitMix64: Steele, Lea, Flood 2014).
struct Random(u64);

impl Random {
    /// From 0 up to 1.
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_have_the_left_edges_they_should_and_both_ways_agree() {
        for (count, two_left) in [(1, false), (2, true)] {
            let triangles = random_triangles(200, two_left);
            assert!(triangles.iter().all(|(edges, _)| edges.count() == count));
            for (edges, corners) in &triangles {
                let [a, b] = [Setup::Actual, Setup::Normalized].map(|how| set_up_denominator(how, edges, corners));
                assert!((a - b).abs() < 1e-3 * (1.0 + a.abs()), "{a} and {b}");
            }
        }
    }
}
