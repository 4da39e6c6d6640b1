//! From files and samples to a subject: decoding, bending, quantising. Runs beside the window.

use std::sync::Arc;

use glam::Vec2;
use rilievo::height::{Filter, HeightMap, to_normals};
use rilievo::normal::normal_levels;
use rilievo::quantize::{Effort, Options, quantize};
use rilievo::surface::{Deflect, Deflected, Frame, Mesh, deflect_heights, deflect_normals, shapes};
use rilievo::{
    Convention, Edges, Grid, MaterialMap, MipChain, NormalMap, Object as ObjectSpace, Progress, QuantizedMap, Tangent,
};
use rilievo_io::{self as io, AnyIndexed, ImportAs, Limits, NormalImage, ReliefImage, Source};

use super::{Heights, Sample, Subject, Tangents};

/// Width of the samples' maps.
const SAMPLE_WIDTH: u32 = 1024;
/// Width of those that are made first where there is one thread and somebody waits.
const PREVIEW_WIDTH: u32 = 384;
/// Width and height of a map that is made of a mesh's own normals.
const OWN_SIZE: (u32, u32) = (1024, 1024);
/// The smallest map that is bent onto a mesh, unless the file's is larger.
const LEAST_BENT: u32 = 512;

/// What a map may have at most. Making one takes some 60 bytes a texel, and a page has 4 GiB, the two copies of the file
/// among them.
const LIMITS: Limits =
    if cfg!(target_arch = "wasm32") { Limits { max_texels: 1 << 25, ..Limits::DEFAULT } } else { Limits::DEFAULT };

/// A file that was opened or dropped.
#[derive(Debug, Clone)]
pub struct File {
    /// Its name, for messages.
    pub name: String,
    /// What is in it.
    pub bytes: Arc<[u8]>,
}

/// What a map is laid on.
#[derive(Debug, Clone, Default)]
pub enum Surface {
    /// A flat sheet of the map's proportions.
    #[default]
    Plane,
    /// A sphere.
    Sphere,
    /// A torus.
    Torus,
    /// A mesh of the user's own.
    Mesh(File),
}

impl Surface {
    /// Its name, for people.
    pub fn name(&self) -> &str {
        match self {
            Self::Plane => "Plane",
            Self::Sphere => "Sphere",
            Self::Torus => "Torus",
            Self::Mesh(file) => &file.name,
        }
    }

    fn mesh(&self, (width, height): (u32, u32), notes: &mut Vec<String>) -> Result<Mesh, String> {
        let mesh = match self {
            Self::Plane => shapes::plane(width as f32 / height as f32),
            Self::Sphere => shapes::sphere(128, 64),
            Self::Torus => shapes::torus(96, 48, 1.0, 0.45),
            Self::Mesh(file) => {
                let read = io::decode_mesh(&file.source(), &LIMITS).map_err(told)?;
                notes.extend(read.warnings);
                Ok(read.mesh)
            }
        };
        let mesh = mesh.map_err(told)?;
        if mesh.uvs().is_empty() { Ok(mesh) } else { mesh.with_tangents().map_err(told) }
    }
}

impl File {
    fn source(&self) -> Source {
        Source::from_bytes(self.name.clone(), self.bytes.to_vec())
    }

    /// Whether it is a mesh and not a map, by its name and its first bytes.
    pub fn is_mesh(&self) -> bool {
        let name = self.name.to_lowercase();
        let named = [".obj", ".ply", ".glb", ".gltf", ".obj.gz", ".ply.gz"].iter().any(|end| name.ends_with(end));
        named || self.bytes.starts_with(b"glTF") || self.bytes.starts_with(b"ply\n") || self.bytes.starts_with(b"ply\r")
    }
}

/// What to make.
#[derive(Debug, Clone)]
pub struct Recipe {
    /// A sample, if there is no map.
    pub sample: Option<Sample>,
    /// A map: heights, normals, or an indexed one.
    pub map: Option<File>,
    /// Width of a sample's maps.
    pub sample_width: u32,
    /// What it is laid on; samples have their own.
    pub surface: Surface,
    /// Entries of the table.
    pub entries: u32,
    /// How hard the quantiser tries.
    pub effort: Effort,
    /// Height of full white as a share of the map's width.
    pub depth: f32,
    /// Which way green points in a normal map.
    pub convention: Convention,
}

impl Default for Recipe {
    fn default() -> Self {
        Self {
            sample: Some(Sample::default()),
            sample_width: SAMPLE_WIDTH,
            map: None,
            surface: Surface::default(),
            entries: 2048,
            effort: Effort::Fast,
            depth: 0.05,
            convention: Convention::Gl,
        }
    }
}

impl Recipe {
    /// A file becomes the mesh or the map.
    pub(crate) fn take_in(&mut self, file: File) {
        if file.is_mesh() {
            self.surface = Surface::Mesh(file);
        } else {
            self.map = Some(file);
        }
        self.sample = None;
    }

    /// How a map is quantised.
    fn options<'a>(&self, materials: Option<&'a MaterialMap>, covered: Option<&'a Grid<bool>>) -> Options<'a> {
        Options {
            entries: self.entries,
            effort: self.effort,
            materials,
            covered,
            mip_levels: true,
            ..Options::default()
        }
    }

    /// What is made at first, to be seen soon.
    pub fn preview(self) -> Self {
        Self { sample_width: PREVIEW_WIDTH, ..self }
    }

    /// Whether the same would come of both, for samples.
    pub(crate) fn is_made_as(&self, other: &Self) -> bool {
        let key = |r: &Self| (r.sample, r.sample_width, r.entries, r.effort);
        self.sample.is_some() && key(self) == key(other)
    }

    /// What is made of a preview once it is seen; nothing of what is no preview.
    pub fn refined(&self) -> Option<Self> {
        let is_preview = self.sample.is_some() && self.sample_width < SAMPLE_WIDTH;
        is_preview.then(|| Self { sample_width: SAMPLE_WIDTH, ..self.clone() })
    }
}

fn told(error: impl std::fmt::Display) -> String {
    error.to_string()
}

/// Makes a subject.
///
/// # Errors
/// A complete sentence for the user.
pub fn make(recipe: &Recipe, progress: &dyn Progress) -> Result<Subject, String> {
    match (&recipe.map, recipe.sample) {
        (Some(file), _) => from_map(recipe, file, progress),
        (None, Some(sample)) => from_sample(recipe, sample, progress),
        (None, None) => from_mesh(recipe, progress),
    }
}

fn from_sample(recipe: &Recipe, sample: Sample, progress: &dyn Progress) -> Result<Subject, String> {
    progress.begin("drawing the maps", 1);
    let parts = sample.parts(recipe.sample_width).map_err(told)?;
    progress.advance(1);
    let mesh = parts.mesh.with_tangents().map_err(told)?;
    let size = parts.height.heights().size();
    let bent = bend_heights(&mesh, &parts.height, None, size, progress)?;
    let heights = Heights { map: parts.height, materials: parts.kinds.clone(), covered: None };
    let tangents = Tangents::of_heights(heights).map_err(told)?;
    let mut subject = finish(recipe, mesh, bent, parts.kinds, progress)?;
    subject.name = sample.name().to_owned();
    subject.tangent = Some(tangents);
    subject.base_color = Some((MipChain::from_picture(&parts.color), Vec2::ONE));
    subject.materials = parts.materials;
    Ok(subject)
}

/// A mesh without a map: its own normals are what is quantised.
fn from_mesh(recipe: &Recipe, progress: &dyn Progress) -> Result<Subject, String> {
    let mut notes = Vec::new();
    let mesh = recipe.surface.mesh((1, 1), &mut notes)?;
    let name = recipe.surface.name().to_owned();
    if mesh.uvs().is_empty() {
        notes.push("the mesh has no texture coordinates: it is drawn with its own normals".to_owned());
        return Ok(Subject { name, notes, ..Subject::plain(mesh) });
    }
    let flat = HeightMap::new(Grid::filled(1, 1, 0.0).map_err(told)?, 1.0).map_err(told)?;
    let bent = bend_heights(&mesh, &flat, None, OWN_SIZE, progress)?;
    let mut subject = finish(recipe, mesh, bent, None, progress)?;
    subject.name = name;
    subject.notes.extend(notes);
    Ok(subject)
}

fn from_map(recipe: &Recipe, file: &File, progress: &dyn Progress) -> Result<Subject, String> {
    let source = file.source();
    progress.begin("reading", 1);
    if io::is_indexed(&source) {
        return from_indexed(recipe, file, &source);
    }
    let relief = io::decode_relief::<Tangent>(&source, recipe.convention, &LIMITS).map_err(|error| {
        format!(
            "{error} (formats: PNG, JPEG, TIFF, EXR, NPY for heights and normals; indexed PNG, KTX2; OBJ, PLY, GLB)"
        )
    })?;
    progress.advance(1);
    let image = match relief {
        ReliefImage::Heights(image) => image,
        ReliefImage::Normals(image) => return from_normals(recipe, file, image, progress),
    };
    let mut notes = image.warnings;
    let height = HeightMap::new(image.heights, recipe.depth).map_err(told)?;
    let size = height.heights().size();
    let mesh = with_uvs(recipe.surface.mesh(size, &mut notes)?)?;
    if let Some(frame) = flat_frame(recipe, &mesh) {
        let normals = to_normals(&height, Filter::Plane4, Edges::Wrap);
        return lie_flat(recipe, file, (mesh, &frame), (normals, Some(height), image.covered), notes, progress);
    }
    let bent = bend_heights(&mesh, &height, image.covered.as_ref(), bent_size(size), progress)?;
    let heights = Heights { map: height, materials: None, covered: image.covered };
    let tangents = Tangents::of_heights(heights).map_err(told)?;
    close(recipe, file, (mesh, bent, tangents), notes, progress)
}

fn from_normals(
    recipe: &Recipe,
    file: &File,
    image: NormalImage<Tangent>,
    progress: &dyn Progress,
) -> Result<Subject, String> {
    let mut notes = image.warnings;
    let mesh = with_uvs(recipe.surface.mesh(image.normals.size(), &mut notes)?)?;
    if let Some(frame) = flat_frame(recipe, &mesh) {
        return lie_flat(recipe, file, (mesh, &frame), (image.normals, None, image.covered), notes, progress);
    }
    let options = Deflect::new(bent_size(image.normals.size()));
    let bent = deflect_normals(&mesh, &image.normals, image.covered.as_ref(), &options, progress).map_err(told)?;
    let tangent = normal_levels(image.normals, None, image.covered.as_ref()).map_err(told)?;
    close(recipe, file, (mesh, bent, Tangents::of_levels(tangent)), notes, progress)
}

/// The frame of a flat sheet that its map covers once: there is nothing to bend.
fn flat_frame(recipe: &Recipe, mesh: &Mesh) -> Option<Frame> {
    matches!(recipe.surface, Surface::Plane).then(|| mesh.constant_frame()).flatten()
}

/// Lays a map on a flat sheet. The same normals as by bending, which for a large map takes longer than quantising it.
fn lie_flat(
    recipe: &Recipe,
    file: &File,
    (mesh, frame): (Mesh, &Frame),
    (normals, heights, covered): (NormalMap<Tangent>, Option<HeightMap>, Option<Grid<bool>>),
    notes: Vec<String>,
    progress: &dyn Progress,
) -> Result<Subject, String> {
    let quantized = quantize(&normals, &recipe.options(None, covered.as_ref()), progress).map_err(told)?;
    let tangents = match heights {
        Some(map) => Tangents::of_heights(Heights { map, materials: None, covered }),
        None => normal_levels(normals, None, covered.as_ref()).map(Tangents::of_levels),
    };
    let name = file.name.clone();
    let mut subject = Subject { name, notes, ..Subject::plain(mesh) };
    subject.indexed = Some(quantized.map.map_normals(|n| frame.to_object(n)));
    subject.error = Some(quantized.error);
    subject.tangent = Some(tangents.map_err(told)?);
    Ok(subject)
}

fn close(
    recipe: &Recipe,
    file: &File,
    (mesh, bent, tangents): (Mesh, Deflected, Tangents),
    notes: Vec<String>,
    progress: &dyn Progress,
) -> Result<Subject, String> {
    let mut subject = finish(recipe, mesh, bent, None, progress)?;
    subject.name = file.name.clone();
    subject.tangent = Some(tangents);
    subject.notes.extend(notes);
    Ok(subject)
}

fn from_indexed(recipe: &Recipe, file: &File, source: &Source) -> Result<Subject, String> {
    let import = ImportAs { space: None, convention: Some(recipe.convention) };
    let read = io::decode_indexed(source, &import, &LIMITS).map_err(told)?;
    let mut notes = read.warnings;
    let mesh = with_uvs(recipe.surface.mesh(read.map.size(), &mut notes)?)?;
    let indexed: QuantizedMap<ObjectSpace> = match read.map {
        AnyIndexed::Object(map) => map,
        AnyIndexed::Tangent(map) => {
            let frame = mesh.constant_frame().ok_or(
                "a tangent-space index map can only lie on a plane: choose it, or open the map it was made of",
            )?;
            map.map_normals(|n| frame.to_object(n))
        }
    };
    Ok(Subject { name: file.name.clone(), indexed: Some(indexed), notes, ..Subject::plain(mesh) })
}

fn with_uvs(mesh: Mesh) -> Result<Mesh, String> {
    if mesh.uvs().is_empty() {
        return Err("the mesh has no texture coordinates, so no map can lie on it; unwrap it first".to_owned());
    }
    Ok(mesh)
}

/// The size of a map bent onto a mesh.
fn bent_size((width, height): (u32, u32)) -> (u32, u32) {
    (width.max(LEAST_BENT), height.max(LEAST_BENT))
}

fn bend_heights(
    mesh: &Mesh,
    map: &HeightMap,
    covered: Option<&Grid<bool>>,
    size: (u32, u32),
    progress: &dyn Progress,
) -> Result<Deflected, String> {
    deflect_heights(mesh, map, covered, Filter::Plane4, Edges::Wrap, &Deflect::new(size), progress).map_err(told)
}

/// Quantises what was bent.
fn finish(
    recipe: &Recipe,
    mesh: Mesh,
    bent: Deflected,
    kinds: Option<MaterialMap>,
    progress: &dyn Progress,
) -> Result<Subject, String> {
    let mut notes = Vec::new();
    if bent.overlaps > 0 {
        notes.push(format!(
            "{} texels belong to several triangles; an object-space map serves one of them",
            bent.overlaps
        ));
    }
    let options = recipe.options(kinds.as_ref(), Some(&bent.covered));
    let normals: &NormalMap<ObjectSpace> = &bent.normals;
    let quantized = quantize(normals, &options, progress).map_err(told)?;
    let levels = normal_levels(bent.normals, kinds, Some(&bent.covered)).map_err(told)?;
    let mut subject = Subject::plain(mesh);
    subject.object = Some(levels);
    subject.indexed = Some(quantized.map);
    subject.error = Some(quantized.error);
    subject.notes = notes;
    Ok(subject)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rilievo::progress::Silent;
    use testkit::write_npy_f32;

    #[test]
    fn bad_files_are_refused_by_name_and_reason() {
        let refused = |name: &str, bytes: Vec<u8>| {
            let map = Some(File { name: name.to_owned(), bytes: bytes.into() });
            let why = make(&Recipe { sample: None, map, ..Recipe::default() }, &Silent).err().unwrap();
            assert!(why.contains(name), "{why}");
            why
        };
        let png = io::encode_gray_png16(&Grid::from_fn(9, 9, |x, y| (x * y) as f32 / 64.0).unwrap()).unwrap();
        assert!(refused("empty.png", Vec::new()).contains("empty"));
        assert!(refused("notes.txt", b"Not a map of anything.".to_vec()).contains("EXR"));
        refused("cut.png", png[..png.len() / 2].to_vec());
        let why = refused("huge.npy", write_npy_f32(&[65_536, 65_536], &[0.5; 4]));
        assert!(why.contains("65536 × 65536") && why.contains("limit"), "{why}");
        let why = refused("holes.npy", write_npy_f32(&[2, 2], &[0.1, 0.2, f32::NAN, 0.3]));
        assert!(why.contains("texel (0, 1)"), "{why}");
    }

    #[test]
    fn a_flat_sheet_needs_no_bending() {
        let wave = |v: u32| (v as f32 / 640.0 * 25.0).sin();
        let heights = Grid::from_fn(640, 512, |x, y| 0.5 + 0.25 * (wave(x) + wave(y) * wave(x))).unwrap();
        let height = HeightMap::new(heights, 0.05).unwrap();
        let size = height.heights().size();
        let mesh = Surface::Plane.mesh(size, &mut Vec::new()).unwrap();
        let frame = flat_frame(&Recipe::default(), &mesh).unwrap();
        let bent = bend_heights(&mesh, &height, None, size, &Silent).unwrap();
        assert!(bent.overlaps == 0 && bent.covered.texels().iter().all(|&c| c));
        let flat = to_normals(&height, Filter::Plane4, Edges::Wrap).map(|&n| frame.to_object(n));
        let apart = flat.texels().iter().zip(bent.normals.texels()).map(|(a, b)| a.angle_to(*b));
        let most = apart.fold(0.0, f64::max);
        assert!(most < 1e-3, "{most} rad");
    }
}
