//! Reading, bending and quantising what a method needs of a surface and its maps.

use std::time::Instant;

use anyhow::{Context, Result};
use rilievo::height::{HeightMap, to_normals};
use rilievo::normal::{NormalMap, normal_levels};
use rilievo::polar::{BumpVectorMap, Twist};
use rilievo::quantize::{self, Effort, Options};
use rilievo::sample::vase;
use rilievo::surface::{Deflect, Deflected, Mesh, deflect_heights, deflect_normals};
use rilievo::{Grid, MaterialMap, MipChain, Object, Tangent};
use rilievo_io::{AnyIndexed, ImportAs, SpaceKind};

use super::{DefaultMaterials, OwnedDetail, QuantizedReport, Relief, ReliefArgs};
use crate::args::{Given, MethodKind};
use crate::exit::{self, usage};
use crate::inputs;
use crate::progress::Bars;
use crate::surface::SurfaceArg;

/// Width of the maps of the built-in vase.
const VASE_WIDTH: u32 = 2048;
/// Width and height of the map that a mesh's own normals are taken as, unless it is given.
const SMOOTH_SIZE: (u32, u32) = (1024, 1024);

/// What was read, before it is quantised or filtered.
enum Source {
    Nothing,
    /// Normals of the object, and where they are true.
    Object {
        normals: NormalMap<Object>,
        covered: Option<Grid<bool>>,
    },
    Tangent {
        normals: NormalMap<Tangent>,
        covered: Option<Grid<bool>>,
    },
    Indexed(AnyIndexed),
}

/// One call of [`ReliefArgs::load`].
struct Loader<'a> {
    args: &'a ReliefArgs,
    kind: MethodKind,
    given: &'a Given,
    progress: Bars,
}

impl ReliefArgs {
    /// Reads, bends and quantises what a method of this kind needs; `given` is what of the arguments was written.
    ///
    /// # Errors
    /// Usage errors where the method cannot draw what is given, errors of files and of the library.
    pub(crate) fn load(&self, kind: MethodKind, given: &Given) -> Result<Relief> {
        self.warn_of_unused(kind, given);
        Loader { args: self, kind, given, progress: Bars::new(self.surface.stem()) }.load()
    }
}

impl Loader<'_> {
    fn load(&self) -> Result<Relief> {
        let args = self.args;
        let is_vase = args.surface == SurfaceArg::Vase;
        let samples = is_vase.then(|| self.progress.step("drawing the maps", || vase::maps(VASE_WIDTH)));
        let samples = samples.transpose()?;
        let own_relief = args.has_no_map();
        if is_vase && own_relief && (self.given.has("repeat") || self.given.has("map_size")) {
            let (repeat, size) = (self.given.called("repeat"), self.given.called("map_size"));
            return Err(usage(format!(
                "the vase's own maps fit each other as they are; {repeat} and {size} are for maps you give"
            )));
        }
        let mut materials: Option<MaterialMap> = args.materials.as_deref().map(inputs::materials).transpose()?;
        if own_relief && materials.is_none() {
            materials = samples.as_ref().map(|s| s.materials.clone());
        }
        let (mesh, source) = self.source(samples.as_ref())?;
        let repeat = args.onto.repeat(&args.surface);
        let color = match (&args.color, &samples) {
            (Some(path), _) => Some(inputs::picture(path)?),
            (None, Some(samples)) => Some(samples.color.clone()),
            (None, None) => None,
        };
        let base_color = color.map(|picture| (MipChain::from_picture(&picture), repeat));
        let (detail, quantized) = self.detail(&mesh, source, materials, repeat)?;
        let default_materials = if is_vase { DefaultMaterials::Vase } else { DefaultMaterials::Plain };
        Ok(Relief { mesh, detail, base_color, default_materials, quantized })
    }

    fn source(&self, samples: Option<&vase::VaseMaps>) -> Result<(Mesh, Source)> {
        let args = self.args;
        if let Some(path) = &args.height {
            let (map, covered) = inputs::height_map(path, args.heights.depth)?;
            return self.heights(&map, covered);
        }
        if let Some(path) = &args.normals {
            if SpaceKind::from(args.space) == SpaceKind::Object {
                self.refuse_object_space("an object-space map")?;
                let image = inputs::normals::<Object>(path, args.convention.into(), false)?;
                let mesh = args.surface.load(image.normals.size())?;
                return Ok((mesh, Source::Object { normals: image.normals, covered: image.covered }));
            }
            let image = inputs::normals::<Tangent>(path, args.convention.into(), false)?;
            let mesh = args.surface.load(image.normals.size())?.with_tangents();
            let mesh = mesh.with_context(|| args.surface.stem())?;
            let as_it_is = match self.kind {
                MethodKind::Exact | MethodKind::Vectors => true,
                MethodKind::Polar(unit) => unit.twist() != Twist::Baked,
                MethodKind::Table | MethodKind::Static => false,
            };
            if as_it_is {
                return Ok((mesh, Source::Tangent { normals: image.normals, covered: image.covered }));
            }
            let options = args.onto.options(&args.surface, image.normals.size())?;
            let covered = image.covered.as_ref();
            let deflected = deflect_normals(&mesh, &image.normals, covered, &options, &self.progress)?;
            return Ok((mesh, bent(deflected)));
        }
        if let Some(path) = &args.indexed {
            self.refuse_object_space("an index map")?;
            if let MethodKind::Polar(_) = self.kind {
                return Err(usage(
                    "an index map holds no words of a polar unit; give the normal map or the height map it was made of",
                ));
            }
            let source = inputs::open(path)?;
            // For palettes made by other tools; our own files know.
            let import = ImportAs {
                space: self.given.has("space").then(|| args.space.into()),
                convention: self.given.has("convention").then(|| args.convention.into()),
            };
            let map = inputs::indexed(&source, &import)?.map;
            return Ok((args.surface.load(map.size())?, Source::Indexed(map)));
        }
        if let Some(samples) = samples {
            let depth = if self.given.has("depth") { args.heights.depth } else { samples.height.depth() };
            return self.heights(&HeightMap::new(samples.height.heights().clone(), depth)?, None);
        }
        let mesh = args.surface.load((1, 1))?;
        match self.kind {
            MethodKind::Exact | MethodKind::Vectors | MethodKind::Polar(_) => Ok((mesh, Source::Nothing)),
            MethodKind::Table | MethodKind::Static => {
                let source = self.own_normals(&mesh)?;
                Ok((mesh, source))
            }
        }
    }

    /// A height map: in tangent space where vectors are interpolated, bent onto the mesh otherwise.
    fn heights(&self, map: &HeightMap, covered: Option<Grid<bool>>) -> Result<(Mesh, Source)> {
        let args = self.args;
        let (filter, edges, size) = (args.heights.filter(), args.heights.edges(), map.heights().size());
        let mesh = args.surface.load(size)?;
        if self.kind == MethodKind::Vectors {
            let mesh = mesh.with_tangents().with_context(|| args.surface.stem())?;
            let normals = self.progress.step("height to normal", || to_normals(map, filter, edges));
            return Ok((mesh, Source::Tangent { normals, covered }));
        }
        let options = args.onto.options(&args.surface, size)?;
        let deflected = deflect_heights(&mesh, map, covered.as_ref(), filter, edges, &options, &self.progress)?;
        Ok((mesh, bent(deflected)))
    }

    /// The mesh's own normals as an object-space map: a flat map bent onto it.
    fn own_normals(&self, mesh: &Mesh) -> Result<Source> {
        let args = self.args;
        if mesh.uvs().is_empty() {
            return Err(usage(format!(
                "{}: without texture coordinates there is no map to look up; use the exact method",
                args.surface.stem()
            )));
        }
        let size = args.onto.map_size.map_or(SMOOTH_SIZE, |s| (s.width, s.height));
        let deflected = self.surface_normals(mesh, size)?;
        exit::remark(format!(
            "{}: no map; the mesh's own normals are looked up from one of {} x {} texels",
            args.surface.stem(),
            size.0,
            size.1
        ));
        Ok(bent(deflected))
    }

    /// The mesh's own normals as a map of this size.
    fn surface_normals(&self, mesh: &Mesh, size: (u32, u32)) -> Result<Deflected> {
        let flat = HeightMap::new(Grid::filled(1, 1, 0.0)?, 1.0)?;
        let options = Deflect { gutter: self.args.onto.gutter, ..Deflect::new(size) };
        let (filter, edges) = (self.args.heights.filter(), self.args.heights.edges());
        Ok(deflect_heights(mesh, &flat, None, filter, edges, &options, &self.progress)?)
    }

    fn refuse_object_space(&self, what: &str) -> Result<()> {
        if self.kind == MethodKind::Vectors {
            return Err(usage(format!(
                "methods that interpolate vectors need a tangent-space normal map, a height map, or the mesh's own normals; \
                 {what} is drawn by the methods table, exact and static"
            )));
        }
        Ok(())
    }

    fn detail(
        &self,
        mesh: &Mesh,
        source: Source,
        materials: Option<MaterialMap>,
        repeat: [f32; 2],
    ) -> Result<(OwnedDetail, Option<QuantizedReport>)> {
        let mapless = self.args.has_no_map() && self.args.surface != SurfaceArg::Vase;
        if materials.is_some() && (mapless || matches!(source, Source::Indexed(_))) {
            let called = self.given.called("materials");
            return Err(usage(format!(
                "{called} goes with a height map or a normal map; an indexed map has its own materials"
            )));
        }
        match source {
            Source::Nothing => Ok((OwnedDetail::Smooth, None)),
            Source::Indexed(AnyIndexed::Object(map)) => Ok((OwnedDetail::Indexed(Box::new(map)), None)),
            Source::Indexed(AnyIndexed::Tangent(map)) => {
                let flat = mesh.clone().with_tangents()?.constant_frame();
                let frame = flat.ok_or_else(|| {
                    usage(
                        "a tangent-space index map can only lie on a flat surface; make an object-space map for this \
                         mesh with `rilievo normal --from normal --onto MESH` and quantise that",
                    )
                })?;
                Ok((OwnedDetail::Indexed(Box::new(map.map_normals(|n| frame.to_object(n)))), None))
            }
            Source::Tangent { normals, covered } => {
                let materials = fitted(materials, normals.size(), "normal map")?;
                let levels = normal_levels(normals, materials, covered.as_ref())?;
                if let MethodKind::Polar(unit) = self.kind {
                    let map = BumpVectorMap::from_tangent(unit, &levels.normals)?;
                    return Ok((OwnedDetail::Bump { map, repeat, materials: levels.materials }, None));
                }
                Ok((OwnedDetail::Tangent { levels, repeat }, None))
            }
            Source::Object { normals, covered } => {
                let materials = fitted(materials, normals.size(), "object-space map")?;
                if self.kind == MethodKind::Table {
                    return self.quantized(&normals, covered.as_ref(), materials.as_ref());
                }
                let levels = normal_levels(normals, materials, covered.as_ref())?;
                if let MethodKind::Polar(unit) = self.kind {
                    let surface = self.surface_normals(mesh, levels.normals.base().size())?;
                    let surface = normal_levels(surface.normals, None, Some(&surface.covered))?;
                    let map = BumpVectorMap::from_object(unit, &levels.normals, &surface.normals)?;
                    let repeat = [1.0, 1.0];
                    return Ok((OwnedDetail::Bump { map, repeat, materials: levels.materials }, None));
                }
                Ok((OwnedDetail::Object { levels }, None))
            }
        }
    }

    fn quantized(
        &self,
        normals: &NormalMap<Object>,
        covered: Option<&Grid<bool>>,
        materials: Option<&MaterialMap>,
    ) -> Result<(OwnedDetail, Option<QuantizedReport>)> {
        let options = Options {
            entries: self.args.entries,
            effort: Effort::from(self.args.effort),
            materials,
            covered,
            mip_levels: true,
            ..Options::default()
        };
        let started = Instant::now();
        let quantized = quantize::quantize(normals, &options, &self.progress)?;
        let seconds = started.elapsed().as_secs_f64();
        let entries = quantized.map.table().len();
        let report = QuantizedReport { entries, error: quantized.error, seconds };
        Ok((OwnedDetail::Indexed(Box::new(quantized.map)), Some(report)))
    }
}

fn bent(deflected: Deflected) -> Source {
    remark_overlaps(&deflected);
    Source::Object { normals: deflected.normals, covered: Some(deflected.covered) }
}

/// Tells of texels that belong to several triangles.
pub(crate) fn remark_overlaps(deflected: &Deflected) {
    if deflected.overlaps > 0 {
        let message = format!(
            "{} texels belong to several triangles (mirrored or overlapping UVs); an object-space map can only serve one",
            deflected.overlaps
        );
        exit::warn("texture coordinates", &message);
    }
}

/// A material map of the size of the map it goes with.
fn fitted(materials: Option<MaterialMap>, size: (u32, u32), what: &str) -> Result<Option<MaterialMap>> {
    let Some(map) = materials else { return Ok(None) };
    if map.size() == size {
        return Ok(Some(map));
    }
    let ((w, h), (mw, mh)) = (size, map.size());
    Err(usage(format!(
        "the material map is {mw} x {mh}, but the {what} is {w} x {h}; give both the same size (that of an object-space map can be chosen)"
    )))
}
