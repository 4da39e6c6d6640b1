//! Frames of the vase, and tables without frames, against the clock.

use std::hint::black_box;

use anyhow::Result;
use glam::Vec3;
use rilievo::indexed::{NormalTable, QuantizedMap};
use rilievo::light::{Light, Lighting, Material, Shade, ShadeTable};
use rilievo::raster::{Detail, Method, Object, Scene, bake_light_map};
use rilievo::surface::Mesh;
use rilievo::{LinearRgb, MipChain, Normal, Object as ObjectSpace, Pose, World};

use super::{ENTRIES, MODELS, SPECULAR, spiral};
use crate::reproduce::Kit;
use crate::reproduce::subjects::{Cover, Easel, Vase, dense, surroundings};

/// Faces around the dense vase: some 69 000 triangles, as many as the paper's bunny.
const SEGMENTS: u32 = 182;
/// In a quick run.
const FEW_SEGMENTS: u32 = 40;

/// All that is drawn.
pub(super) struct Subject<'a> {
    vase: &'a Vase,
    maps: &'a [QuantizedMap<ObjectSpace>],
    materials: Vec<[Material; 1]>,
    lighting: Lighting<World>,
    dense: Mesh,
}

/// Of each model and size of the table: seconds of lighting it, and of the whole frame.
pub(super) struct Table {
    pub(super) table: [[f64; ENTRIES.len()]; MODELS.len()],
    pub(super) frame: [[f64; ENTRIES.len()]; MODELS.len()],
    /// Entries there are in fact: small maps have fewer distinct normals.
    pub(super) entries: Vec<usize>,
    pub(super) covered: u64,
}

/// Entries and seconds of lighting them, of each model.
pub(super) type Growth = [Vec<[f64; 2]>; MODELS.len()];

/// A way to draw the vase.
pub(super) struct Rival {
    pub(super) name: &'static str,
    pub(super) key: &'static str,
    pub(super) faces: usize,
    pub(super) seconds: f64,
    /// What the paper says of it, in frames a second.
    pub(super) paper: &'static str,
}

/// A picture of a side under so many lights: seconds of the table, the frame by table, and the exact frame.
pub(super) struct Scaling {
    pub(super) side: u32,
    pub(super) lights: usize,
    pub(super) table: f64,
    pub(super) frame: f64,
    pub(super) exact: f64,
}

impl<'a> Subject<'a> {
    pub(super) fn new(kit: &Kit<'_>, vase: &'a Vase, maps: &'a [QuantizedMap<ObjectSpace>]) -> Result<Self> {
        let lighting = Lighting { environment: Some(surroundings()?), ..Vase::one_light() };
        let segments = if kit.quick { FEW_SEGMENTS } else { SEGMENTS };
        let dense = dense(segments, &vase.maps().height)?;
        let materials = MODELS.iter().map(|model| [(model.layers)()]).collect();
        Ok(Self { vase, maps, materials, lighting, dense })
    }

    fn scene<'s>(&'s self, detail: Detail<'s>, model: usize, lighting: &Lighting<World>) -> Result<Scene<'s>> {
        self.vase.scene(detail, &self.materials[model], Cover::None, lighting.clone(), 1.0)
    }

    /// The paper's table: frames of all models and sizes, and their tables alone, in turns.
    pub(super) fn table(&self, kit: &Kit<'_>) -> Result<Table> {
        let cases: Vec<[usize; 2]> = (0..MODELS.len()).flat_map(|m| (0..ENTRIES.len()).map(move |k| [m, k])).collect();
        let mut scenes = Vec::with_capacity(cases.len());
        for &[m, k] in &cases {
            scenes.push(self.scene(Detail::Indexed(&self.maps[k]), m, &self.lighting)?);
        }
        let mut easel = Easel::new(kit.size)?;
        let covered = easel.draw(&scenes[0], Method::Table)?;
        let seconds = kit.clock.turns(2 * cases.len(), |side| {
            let case = side / 2;
            let [m, k] = cases[case];
            if side % 2 == 0 {
                return self.light(self.maps[k].table(), m, &self.lighting);
            }
            easel.draw(&scenes[case], Method::Table).map(drop)
        })?;
        let mut found = Table {
            table: Default::default(),
            frame: Default::default(),
            entries: self.maps.iter().map(|map| map.table().len()).collect(),
            covered,
        };
        for (case, [m, k]) in cases.into_iter().enumerate() {
            [found.table[m][k], found.frame[m][k]] = [seconds[2 * case], seconds[2 * case + 1]];
        }
        Ok(found)
    }

    /// Tables of sizes in between.
    pub(super) fn growth(&self, kit: &Kit<'_>) -> Result<Growth> {
        let tables = (4..=14).map(|power| spiral(1 << power)).collect::<Result<Vec<_>>>()?;
        let seconds = kit.clock.turns(MODELS.len() * tables.len(), |side| {
            self.light(&tables[side % tables.len()], side / tables.len(), &self.lighting)
        })?;
        let points = |m: usize| {
            let of = seconds[m * tables.len()..].iter().zip(&tables);
            of.map(|(&seconds, table)| [table.len() as f64, seconds]).collect()
        };
        Ok(std::array::from_fn(points))
    }

    /// The same look by other means.
    pub(super) fn rivals(&self, kit: &Kit<'_>) -> Result<[Rival; 5]> {
        let scene = |detail| self.scene(detail, SPECULAR, &self.lighting);
        let table = scene(Detail::Indexed(&self.maps[1]))?;
        let baked: MipChain<Shade> = bake_light_map(&table.objects[0], &self.lighting, table.camera.eye())?;
        let bare = |mesh| Object { mesh, ..Object::new(mesh, Detail::Smooth, &self.materials[SPECULAR]) };
        let simple = Scene { objects: vec![bare(self.vase.mesh())], ..table.clone() };
        let dense = Scene { objects: vec![bare(&self.dense)], ..table.clone() };
        let (faces, dense_faces) = (self.vase.mesh().triangles().len(), self.dense.triangles().len());
        let all = [
            ("light map, baked once", "static", faces, scene(Detail::Baked(&baked))?, Method::Static, "16"),
            ("table of 2048, lit each frame", "table", faces, table, Method::Table, "15.5"),
            ("per-pixel shading of the normal map", "exact", faces, scene(self.vase.exact())?, Method::Exact, "–"),
            ("the same mesh without bumps", "bare", faces, simple, Method::Exact, "–"),
            ("dense mesh without a map", "dense", dense_faces, dense, Method::Exact, "< 2"),
        ];
        let mut easel = Easel::new(kit.size)?;
        let seconds = kit.clock.turns(all.len(), |side| easel.draw(&all[side].3, all[side].4).map(drop))?;
        let mut seconds = seconds.into_iter();
        Ok(all.map(|(name, key, faces, _, _, paper)| Rival {
            name,
            key,
            faces,
            seconds: seconds.next().unwrap_or(f64::NAN),
            paper,
        }))
    }

    /// Pictures of several sizes, and several lights.
    pub(super) fn scaling(&self, kit: &Kit<'_>) -> Result<Vec<Scaling>> {
        let cases = [(kit.size / 2, 1), (kit.size, 1), (kit.size * 2, 1), (kit.size, 4), (kit.size, 16)];
        let lightings = cases.map(|(_, lights)| self.with_lights(lights));
        let mut shots = Vec::with_capacity(cases.len());
        for ((side, _), lighting) in cases.iter().zip(&lightings) {
            let table = self.scene(Detail::Indexed(&self.maps[1]), SPECULAR, lighting)?;
            shots.push((Easel::new(*side)?, table, self.scene(self.vase.exact(), SPECULAR, lighting)?));
        }
        let seconds = kit.clock.turns(3 * cases.len(), |side| {
            let (easel, table, exact) = &mut shots[side / 3];
            match side % 3 {
                0 => self.light(self.maps[1].table(), SPECULAR, &lightings[side / 3]),
                1 => easel.draw(table, Method::Table).map(drop),
                _ => easel.draw(exact, Method::Exact).map(drop),
            }
        })?;
        let row = |(i, (side, lights)): (usize, (u32, usize))| {
            let [table, frame, exact] = [0, 1, 2].map(|k| seconds[3 * i + k]);
            Scaling { side, lights, table, frame, exact }
        };
        Ok(cases.into_iter().enumerate().map(row).collect())
    }

    /// So many lights from all around, together as bright as one.
    fn with_lights(&self, count: usize) -> Lighting<World> {
        let light = |i: usize| {
            let azimuth = -0.86 + std::f32::consts::TAU * i as f32 / count as f32;
            Light::from_angles(azimuth, 0.6, LinearRgb::gray(1.1 / count as f32))
        };
        Lighting { lights: (0..count).map(light).collect(), ..self.lighting.clone() }
    }

    fn light(&self, table: &NormalTable<ObjectSpace>, model: usize, lighting: &Lighting<World>) -> Result<()> {
        let lighting = lighting.to_object(&Pose::IDENTITY);
        black_box(ShadeTable::new(table, &self.materials[model], &lighting, Normal::Z, Vec3::ZERO)?);
        Ok(())
    }
}
