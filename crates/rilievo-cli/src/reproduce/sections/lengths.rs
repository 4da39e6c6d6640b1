//! Section 2 of Hast et al.: how far from unit length interpolated vectors are.

use anyhow::Result;
use glam::{DVec2, DVec3};
use rilievo::Progress;
use rilievo::fill::Triangle;
use rilievo::raster::Scene;
use rilievo::raster::vectors::{Field, Interpolation, Sides, Vertices};

use crate::reproduce::Kit;
use crate::reproduce::findings::{Column, Findings, Table};
use crate::reproduce::page::{Axis, Plot, Series};
use crate::reproduce::subjects::{METHODS, Torus, VIEWS};

/// Cells each way: 288, 512 and 800 triangles.
const TORI: [u32; 3] = [12, 16, 20];
/// What the paper says of the torus of 288 polygons, in hundredths.
const PAPER_MEAN: f64 = 0.45;
const PAPER_MAX: f64 = 3.2;
/// The histogram: shortest length, width and number of its bins. Unit length is the middle of one.
const SHORTEST: f64 = 0.84875;
const BIN: f64 = 0.0025;
const BINS: usize = 88;
/// The least share of the vectors that is shown, in hundredths.
const LEAST_SHARE: f64 = 0.01;

/// Deviations from unit length, of L' and H' alike.
#[derive(Debug, Clone, PartialEq)]
struct Lengths {
    /// Sum of the absolute deviations.
    sum: f64,
    max: f64,
    count: u64,
    /// How many have a length within each bin; lengths outside go to the first or the last.
    histogram: Vec<u64>,
}

impl Lengths {
    fn new() -> Self {
        Self { sum: 0.0, max: 0.0, count: 0, histogram: vec![0; BINS] }
    }

    fn add(&mut self, length: f64) {
        let off = (length - 1.0).abs();
        self.sum += off;
        self.max = self.max.max(off);
        self.count += 1;
        let bin = ((length - SHORTEST) / BIN).clamp(0.0, (BINS - 1) as f64) as usize;
        self.histogram[bin] += 1;
    }

    fn mean_percent(&self) -> f64 {
        100.0 * self.sum / self.count.max(1) as f64
    }

    fn max_percent(&self) -> f64 {
        100.0 * self.max
    }

    /// Share of the vectors in each bin, in hundredths, over the middle of the bin; bins that are as good as empty are
    /// left out.
    fn curve(&self) -> Vec<[f64; 2]> {
        let share = |n: u64| 100.0 * n as f64 / self.count.max(1) as f64;
        let all = self.histogram.iter().enumerate().map(|(i, &n)| [SHORTEST + (i as f64 + 0.5) * BIN, share(n)]);
        all.filter(|point| point[1] >= LEAST_SHARE).collect()
    }
}

pub(crate) fn run(kit: &Kit<'_>) -> Result<Findings> {
    let side = if kit.quick { kit.size } else { 2 * kit.size };
    kit.bars.begin("lengths of vectors", TORI.len() as u64);
    let mut found = Findings::default();
    found.paper(
        "On a torus of 288 polygons the quadratically interpolated vectors differ from unit length by 0.45 % on average and 3.2 % at \
         most. Which view and light, and whether both vectors count, is not said.",
    );
    found.here(format!(
        "L' and H' in all front faces of the torus, hidden ones too, at the pixels of three views of {side} × {side} pixels together; the \
         light is that of the previous section. Normalised vectors are of unit length by construction."
    ));
    let mut all = Vec::new();
    for n in TORI {
        let torus = Torus::new(n, 64)?;
        let scenes = VIEWS.iter().map(|&view| torus.bare_scene(view)).collect::<Result<Vec<_>>>()?;
        let of = |how| {
            let mut lengths = Lengths::new();
            scenes.iter().for_each(|scene| measure(scene, how, side, &mut lengths));
            lengths
        };
        all.push((torus.mesh().triangles().len(), METHODS.map(|way| of(way.how))));
        kit.bars.advance(1);
    }
    let deviations = table(&all, &mut found);
    found.show(deviations);
    let curves = [0, 2, 3, 4].map(|m| Series::curve(METHODS[m].name, all[0].1[m].curve()));
    let share = format!("share of the vectors in each {BIN} of length, in %");
    let caption = format!("Lengths on the torus of 288 polygons: {share}. Normalised vectors would all stand at 1.");
    found.show(Plot::new(caption, Axis::linear("length"), Axis::decades("share in %"), curves.to_vec()));
    let [new_frames, averaged] = [&all[0].1[2], &all[0].1[3]];
    let (mean, max) = (new_frames.mean_percent() / PAPER_MEAN, new_frames.max_percent() / PAPER_MAX);
    let is_met = (0.6..=1.4).contains(&mean) && (0.6..=1.4).contains(&max);
    found.remark(format!(
        "The paper's figures are {}: {:.2} % on average and {:.1} % at most beside its 0.45 % and 3.2 %. Vectors that are averaged at the \
         midpoints are nearer to unit length ({:.2} %) and yet do not make the better picture: length alone is no measure of quality.",
        if is_met { "met" } else { "not met" },
        new_frames.mean_percent(),
        new_frames.max_percent(),
        averaged.mean_percent()
    ));
    Ok(found)
}

fn table(all: &[(usize, [Lengths; METHODS.len()])], found: &mut Findings) -> Table {
    let mut columns = vec![Column::here("method")];
    for (polygons, _) in all {
        columns.push(Column::here(format!("{polygons} polygons, mean")));
        columns.push(Column::here("max"));
    }
    columns.extend([Column::paper("288 polygons, mean"), Column::paper("max")]);
    let mut table = Table::new("Deviation from unit length in %.", columns);
    for (m, way) in METHODS.iter().enumerate() {
        let mut row = vec![way.name.to_owned()];
        for (polygons, lengths) in all {
            let (mean, max) = (lengths[m].mean_percent(), lengths[m].max_percent());
            row.extend([format!("{mean:.2}"), format!("{max:.1}")]);
            let keys = ["mean", "max"].map(|what| format!("{polygons}_{}_{what}_percent", way.key));
            for (key, (value, paper)) in keys.into_iter().zip([(mean, PAPER_MEAN), (max, PAPER_MAX)]) {
                if *polygons == 288 && way.key == "quadratic_new_frames" {
                    found.against(key, value, paper);
                } else {
                    found.figure(key, value);
                }
            }
        }
        let is_papers = way.key == "quadratic_new_frames";
        row.extend(if is_papers {
            [PAPER_MEAN.to_string(), PAPER_MAX.to_string()]
        } else {
            ["–", "–"].map(str::to_owned)
        });
        table.row(row);
    }
    table
}

/// Over all pixel centres in front faces of the scene's object, which stands at the world's origin, has tangents, and lies wholly
/// in the picture of `side` × `side` pixels.
fn measure(scene: &Scene<'_>, how: Interpolation, side: u32, lengths: &mut Lengths) {
    let view_projection = scene.camera.view_projection(1.0).as_dmat4();
    let to_screen = |p: DVec3| {
        let ndc = view_projection.project_point3(p);
        DVec2::new(ndc.x * 0.5 + 0.5, 0.5 - ndc.y * 0.5) * f64::from(side)
    };
    let whole = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for object in &scene.objects {
        let lights = scene.lighting.to_object(&object.pose).lights;
        let vertices = Vertices::new(object.mesh, &lights, scene.camera.eye());
        for light in 0..vertices.lights() {
            let viewer = vertices.viewer(light);
            for &triangle in object.mesh.triangles() {
                let corners = triangle.map(|v| to_screen(object.mesh.positions()[v as usize].as_dvec3()));
                let Some(shape) = Triangle::new(corners).filter(|shape| !shape.is_clockwise()) else { continue };
                let from_first = |i: usize| (corners[i] - corners[0]).as_vec2();
                let sides = Sides { first: from_first(1), second: from_first(2) };
                // Slivers are linear whatever the method, and cover next to nothing.
                if sides.is_sliver() {
                    continue;
                }
                let lit = vertices.triangle(triangle, &whole, light);
                let Some(field) = Field::new(how, (&lit.corners, &lit.vectors), &sides, &viewer, 1.0) else { continue };
                shape.for_each_pixel(0..side, 0..side, |x, y, _| {
                    let p = (DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) - corners[0]).as_vec2();
                    let at = field.at(p.x, p.y);
                    lengths.add(at.light.length().into());
                    lengths.add(at.half.length().into());
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deviations_are_counted_on_both_sides_of_one() {
        let mut lengths = Lengths::new();
        for length in [0.98, 1.01, 1.0, 5.0] {
            lengths.add(length);
        }
        assert!((lengths.mean_percent() - 100.0 * (0.02 + 0.01 + 4.0) / 4.0).abs() < 1e-9);
        assert!((lengths.max_percent() - 400.0).abs() < 1e-9);
        assert_eq!(lengths.histogram.iter().sum::<u64>(), 4);
        assert_eq!((lengths.histogram[BINS - 1], lengths.histogram[60]), (1, 1));
    }
}
