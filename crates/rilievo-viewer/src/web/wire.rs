//! Recipes and subjects as bytes: a page makes its subjects in a worker, which shares no memory with it.
//!
//! Both sides are the same build, so there is no version and no byte order: little-endian, lengths before lists.

use bytemuck::{AnyBitPattern, NoUninit};
use glam::{Vec2, Vec3};
use rilievo::height::HeightMap;
use rilievo::light::Material;
use rilievo::measure::AngleStats;
use rilievo::normal::NormalLevels;
use rilievo::quantize::Effort;
use rilievo::surface::{Mesh, MeshParts};
use rilievo::{Convention, Edges, Grid, LinearRgb, MaterialSpan, MipChain, Normal, NormalTable, QuantizedMap, Space};

use crate::look::{Finish, Model};
use crate::subject::{File, Heights, Recipe, Sample, Subject, Surface, Tangents};

/// What was not written by [`Writer`].
type Damage = String;

/// Appends.
#[derive(Default)]
struct Writer(Vec<u8>);

impl Writer {
    fn value<T: NoUninit>(&mut self, value: T) {
        self.0.extend_from_slice(bytemuck::bytes_of(&value));
    }

    fn list<T: NoUninit>(&mut self, list: &[T]) {
        self.value(list.len() as u64);
        self.0.extend_from_slice(bytemuck::cast_slice(list));
    }

    fn option<T>(&mut self, option: Option<T>, write: impl FnOnce(&mut Self, T)) {
        self.value(u8::from(option.is_some()));
        if let Some(value) = option {
            write(self, value);
        }
    }

    fn levels<T, P: NoUninit>(&mut self, chain: &MipChain<T>, part: impl Fn(&T) -> P) {
        self.value(chain.levels().len() as u64);
        for level in chain.levels() {
            self.value([level.width(), level.height()]);
            self.value(level.texels().len() as u64);
            self.0.reserve(size_of_val(level.texels()));
            for texel in level.texels() {
                self.value(part(texel));
            }
        }
    }

    fn heights(&mut self, heights: &Heights) {
        let grid = heights.map.heights();
        self.value([grid.width(), grid.height()]);
        self.value(heights.map.depth());
        self.list(grid.texels());
        self.option(heights.materials.as_ref(), |w, m| w.list(m.texels()));
        self.option(heights.covered.as_ref(), |w, c| w.list(c.texels()));
    }

    fn normals<S: Space>(&mut self, levels: &NormalLevels<S>) {
        self.levels(&levels.normals, |n| n.vec().to_array());
        self.option(levels.materials.as_ref(), |w, m| w.levels(m, |&m| m));
    }
}

/// Reads what was appended.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn bytes(&mut self, len: usize) -> Result<&'a [u8], Damage> {
        let (bytes, rest) = self.0.split_at_checked(len).ok_or("a message of the worker ends early")?;
        self.0 = rest;
        Ok(bytes)
    }

    fn value<T: AnyBitPattern>(&mut self) -> Result<T, Damage> {
        Ok(bytemuck::pod_read_unaligned(self.bytes(size_of::<T>())?))
    }

    fn list<T: AnyBitPattern + NoUninit>(&mut self) -> Result<Vec<T>, Damage> {
        let len = self.value::<u64>()? as usize;
        let bytes = self.bytes(len.saturating_mul(size_of::<T>()))?;
        Ok(bytemuck::allocation::pod_collect_to_vec(bytes))
    }

    fn text(&mut self) -> Result<String, Damage> {
        String::from_utf8(self.list()?).map_err(told)
    }

    fn option<T>(&mut self, read: impl FnOnce(&mut Self) -> Result<T, Damage>) -> Result<Option<T>, Damage> {
        if self.value::<u8>()? == 1 { read(self).map(Some) } else { Ok(None) }
    }

    fn levels<T, P: AnyBitPattern + NoUninit>(&mut self, whole: impl Fn(P) -> T) -> Result<MipChain<T>, Damage> {
        let count = self.value::<u64>()?;
        let levels: Result<Vec<Grid<T>>, Damage> = (0..count)
            .map(|_| {
                let [width, height] = self.value::<[u32; 2]>()?;
                let len = self.value::<u64>()? as usize;
                let bytes = self.bytes(len.saturating_mul(size_of::<P>()))?;
                let parts = bytes.chunks_exact(size_of::<P>()).map(bytemuck::pod_read_unaligned);
                Grid::new(width, height, parts.map(&whole).collect()).map_err(told)
            })
            .collect();
        MipChain::from_levels(levels?).map_err(told)
    }

    fn heights(&mut self) -> Result<Heights, Damage> {
        let [width, height] = self.value::<[u32; 2]>()?;
        let depth = self.value()?;
        let heights = Grid::new(width, height, self.list()?).map_err(told)?;
        let materials = self.option(|r| Grid::new(width, height, r.list()?).map_err(told))?;
        let covered = self.option(|r| {
            let covered = r.list::<u8>()?.into_iter().map(|c| c == 1).collect();
            Grid::new(width, height, covered).map_err(told)
        })?;
        Ok(Heights { map: HeightMap::new(heights, depth).map_err(told)?, materials, covered })
    }

    fn normals<S: Space>(&mut self) -> Result<NormalLevels<S>, Damage> {
        Ok(NormalLevels {
            normals: self.levels(|v: [f32; 3]| Normal::new_or(v.into(), Normal::Z))?,
            materials: self.option(|r| r.levels(|m: u8| m))?,
        })
    }
}

fn told(error: impl std::fmt::Display) -> Damage {
    error.to_string()
}

/// A recipe, with its files.
pub(super) fn recipe_to_bytes(recipe: &Recipe) -> Vec<u8> {
    let mut w = Writer::default();
    let file = |w: &mut Writer, file: &File| {
        w.list(file.name.as_bytes());
        w.list(&file.bytes);
    };
    let sample = |s: Sample| Sample::ALL.into_iter().position(|x| x == s).unwrap_or(0) as u8;
    w.option(recipe.sample, |w, s| w.value(sample(s)));
    w.value(recipe.sample_width);
    w.option(recipe.map.as_ref(), file);
    let kind = match &recipe.surface {
        Surface::Plane => 0u8,
        Surface::Sphere => 1,
        Surface::Torus => 2,
        Surface::Mesh(_) => 3,
    };
    w.value(kind);
    if let Surface::Mesh(mesh) = &recipe.surface {
        file(&mut w, mesh);
    }
    w.value(recipe.entries);
    let effort = match recipe.effort {
        Effort::Fast => 0u8,
        Effort::Normal => 1,
        Effort::Best => 2,
    };
    w.value(effort);
    w.value(recipe.depth);
    w.value(u8::from(recipe.convention == Convention::Dx));
    w.0
}

/// The recipe again.
pub(super) fn recipe_from_bytes(bytes: &[u8]) -> Result<Recipe, Damage> {
    let mut r = Reader(bytes);
    let file = |r: &mut Reader<'_>| Ok(File { name: r.text()?, bytes: r.list::<u8>()?.into() });
    Ok(Recipe {
        sample: r.option(|r| Ok(Sample::ALL[usize::from(r.value::<u8>()?).min(Sample::ALL.len() - 1)]))?,
        sample_width: r.value()?,
        map: r.option(file)?,
        surface: match r.value::<u8>()? {
            1 => Surface::Sphere,
            2 => Surface::Torus,
            3 => Surface::Mesh(file(&mut r)?),
            _ => Surface::Plane,
        },
        entries: r.value()?,
        effort: match r.value::<u8>()? {
            1 => Effort::Normal,
            2 => Effort::Best,
            _ => Effort::Fast,
        },
        depth: r.value()?,
        convention: if r.value::<u8>()? == 1 { Convention::Dx } else { Convention::Gl },
    })
}

/// A subject.
pub(super) fn subject_to_bytes(subject: &Subject) -> Vec<u8> {
    let mut w = Writer::default();
    w.list(subject.name.as_bytes());
    let mesh = &subject.mesh;
    let vectors = |list: &[Vec3]| list.iter().map(Vec3::to_array).collect::<Vec<_>>();
    w.list(&vectors(mesh.positions()));
    w.list(&vectors(mesh.normals()));
    w.list(&mesh.uvs().iter().map(Vec2::to_array).collect::<Vec<_>>());
    w.list(mesh.triangles());
    w.option(subject.object.as_ref(), Writer::normals);
    w.option(subject.tangent.as_ref(), |w, tangents| {
        w.value(u8::from(tangents.heights().is_some()));
        match tangents.heights() {
            Some(heights) => w.heights(heights),
            None => w.normals(tangents.levels()),
        }
    });
    w.option(subject.indexed.as_ref(), |w, map| {
        w.list(&map.table().normals().iter().map(|n| n.vec().to_array()).collect::<Vec<_>>());
        let span = |s: &MaterialSpan| [u32::from(s.material), s.entries.start, s.entries.end];
        w.list(&map.table().spans().iter().map(span).collect::<Vec<_>>());
        w.levels(map.indices(), |&i| i);
    });
    w.option(subject.base_color.as_ref(), |w, (levels, repeat)| {
        w.levels(levels, |c| [c.r, c.g, c.b]);
        w.value(repeat.to_array());
    });
    w.value(match subject.edges {
        Edges::Wrap => 0u8,
        Edges::Clamp => 1,
        Edges::Mirror => 2,
    });
    let numbers = |f: &Finish| {
        let [r, g, b] = f.color;
        let [sr, sg, sb] = f.specular;
        [f32::from(u8::from(f.model == Model::Matte)), r, g, b, sr, sg, sb, f.shininess]
    };
    w.list(&subject.materials.iter().map(|m| numbers(&Finish::of(m))).collect::<Vec<_>>());
    w.option(subject.error, |w, e| {
        w.value([e.mean_rad, e.rms_rad, e.p99_rad, e.max_rad]);
        w.value(e.count);
    });
    w.value(subject.notes.len() as u64);
    for note in &subject.notes {
        w.list(note.as_bytes());
    }
    w.0
}

/// The subject again.
pub(super) fn subject_from_bytes(bytes: &[u8]) -> Result<Subject, Damage> {
    let mut r = Reader(bytes);
    let name = r.text()?;
    let vectors = |list: Vec<[f32; 3]>| list.into_iter().map(Vec3::from).collect::<Vec<_>>();
    let parts = MeshParts {
        positions: vectors(r.list()?),
        normals: vectors(r.list()?),
        uvs: r.list::<[f32; 2]>()?.into_iter().map(Vec2::from).collect(),
        triangles: r.list()?,
    };
    let mesh = Mesh::new(parts).map_err(told)?;
    let mesh = if mesh.uvs().is_empty() { mesh } else { mesh.with_tangents().map_err(told)? };
    let mut subject = Subject::plain(mesh);
    subject.name = name;
    subject.object = r.option(Reader::normals)?;
    subject.tangent = r.option(|r| {
        if r.value::<u8>()? == 1 {
            return Tangents::of_heights(r.heights()?).map_err(told);
        }
        Ok(Tangents::of_levels(r.normals()?))
    })?;
    subject.indexed = r.option(|r| {
        let normals = r.list::<[f32; 3]>()?.into_iter().map(|v| Normal::new_or(v.into(), Normal::Z)).collect();
        let spans = r.list::<[u32; 3]>()?.into_iter();
        let spans = spans.map(|[m, start, end]| MaterialSpan { material: m as u8, entries: start..end }).collect();
        let table = NormalTable::with_materials(normals, spans).map_err(told)?;
        QuantizedMap::new(table, r.levels(|i: u16| i)?).map_err(told)
    })?;
    subject.base_color = r.option(|r| {
        let levels = r.levels(|[red, green, blue]: [f32; 3]| LinearRgb::new(red, green, blue))?;
        Ok((levels, r.value::<[f32; 2]>()?.into()))
    })?;
    subject.edges = match r.value::<u8>()? {
        1 => Edges::Clamp,
        2 => Edges::Mirror,
        _ => Edges::Wrap,
    };
    let material = |[matte, red, green, blue, sr, sg, sb, shininess]: [f32; 8]| -> Material {
        let color = LinearRgb::new(red, green, blue);
        if matte == 1.0 {
            return Material::matte(color);
        }
        Material::blinn_phong(color, LinearRgb::new(sr, sg, sb), shininess)
    };
    subject.materials = r.list::<[f32; 8]>()?.into_iter().map(material).collect();
    subject.error = r.option(|r| {
        let [mean_rad, rms_rad, p99_rad, max_rad] = r.value()?;
        Ok(AngleStats { mean_rad, rms_rad, p99_rad, max_rad, count: r.value()? })
    })?;
    let notes = r.value::<u64>()?;
    subject.notes = (0..notes).map(|_| r.text()).collect::<Result<_, _>>()?;
    Ok(subject)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::subject::make;
    use rilievo::progress::Silent;

    fn same(recipe: &Recipe) {
        let subject = make(recipe, &Silent).unwrap();
        let bytes = subject_to_bytes(&subject);
        let back = subject_from_bytes(&bytes).unwrap();
        assert_eq!((&back.name, back.edges), (&subject.name, subject.edges));
        // Normals and tangents are made unit vectors again, and may change in the last bit.
        let parts = |s: &Subject| (s.mesh.positions().to_vec(), s.mesh.uvs().to_vec(), s.mesh.triangles().to_vec());
        assert_eq!(parts(&back), parts(&subject));
        let apart = |(a, b): (&glam::Vec4, &glam::Vec4)| (*a - *b).length() > 1e-4;
        assert!(!back.mesh.tangents().iter().zip(subject.mesh.tangents()).any(apart));
        let indexed = |s: &Subject| s.indexed.as_ref().map(|i| i.indices().clone());
        assert_eq!(indexed(&back), indexed(&subject));
        let spans = |s: &Subject| s.indexed.as_ref().map(|i| i.table().spans().to_vec());
        assert_eq!(spans(&back), spans(&subject));
        assert_eq!((&back.base_color, &back.materials), (&subject.base_color, &subject.materials));
        assert_eq!((back.error, &back.notes), (subject.error, &subject.notes));
        let kinds = |s: &Subject| s.object.as_ref().and_then(|o| o.materials.clone());
        assert_eq!(kinds(&back), kinds(&subject));
        let (a, b) = (back.object.unwrap(), subject.object.unwrap());
        for (a, b) in a.normals.levels().iter().zip(b.normals.levels()) {
            let far = a.texels().iter().zip(b.texels()).map(|(a, b)| a.angle_to(*b)).fold(0.0, f64::max);
            assert!(far < 1e-3, "{far}");
        }
        // What was cut short is told, wherever that is.
        for len in (0..bytes.len()).step_by(bytes.len() / 60) {
            assert!(subject_from_bytes(&bytes[..len]).is_err(), "{len} of {}", bytes.len());
        }
    }

    #[test]
    fn subjects_come_through() {
        same(&Recipe { entries: 64, ..Recipe::default() });
        same(&Recipe { sample: None, surface: Surface::Torus, entries: 32, ..Recipe::default() });
    }

    #[test]
    fn recipes_come_through() {
        let file = File { name: "größe.png".into(), bytes: vec![1, 2, 3].into() };
        let recipe = Recipe {
            sample: None,
            sample_width: 77,
            map: Some(file.clone()),
            surface: Surface::Mesh(File { name: "m.obj".into(), ..file }),
            entries: 77,
            effort: Effort::Best,
            depth: 0.25,
            convention: Convention::Dx,
        };
        let back = recipe_from_bytes(&recipe_to_bytes(&recipe)).unwrap();
        assert_eq!(format!("{back:?}"), format!("{recipe:?}"));
        assert_eq!(recipe_from_bytes(&recipe_to_bytes(&Recipe::default())).unwrap().sample, Some(Sample::Vase));
    }
}
