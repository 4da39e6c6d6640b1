//! The vase, in whose place the paper has a bunny.

use std::f32::consts::FRAC_PI_2;

use anyhow::Result;
use glam::Vec2;
use rilievo::height::{Filter, HeightMap};
use rilievo::light::{Light, Lighting, Material};
use rilievo::normal::{NormalLevels, normal_levels};
use rilievo::progress::Silent;
use rilievo::quantize::{Dither, Effort, Options, Quantized, quantize};
use rilievo::raster::{BaseColor, Detail, Method, Object, Scene, bake_light_map};
use rilievo::sample::vase;
use rilievo::surface::{Camera, Deflect, Deflected, Mesh, deflect_heights};
use rilievo::{Edges, LinearRgb, MaterialMap, MipChain, Object as ObjectSpace, Progress, World};

use super::pictures::{Shown, shoot};

/// The mesh, its maps, and the normals of its relief.
pub(crate) struct Vase {
    mesh: Mesh,
    maps: vase::VaseMaps,
    bent: Deflected,
    /// The normals as they are, without materials.
    levels: NormalLevels<ObjectSpace>,
    color: MipChain<LinearRgb>,
    effort: Effort,
}

/// What lies on the vase besides light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Cover {
    /// Nothing: the colour is the material's.
    None,
    /// The painted colours.
    Painted,
}

impl Vase {
    /// With maps `width` texels wide.
    pub(crate) fn new(width: u32, progress: &dyn Progress) -> Result<Self> {
        progress.begin("making the vase", 1);
        let maps = vase::maps(width)?;
        let mesh = vase::mesh(vase::DEFAULT_SEGMENTS)?;
        let bent = bend(&mesh, &maps.height)?;
        let levels = normal_levels(bent.normals.clone(), None, Some(&bent.covered))?;
        let color = MipChain::from_picture(&maps.color);
        let effort = if width < 512 { Effort::Fast } else { Effort::Normal };
        progress.advance(1);
        Ok(Self { mesh, maps, bent, levels, color, effort })
    }

    /// 1200 triangles.
    pub(crate) fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Heights, materials and colours.
    pub(crate) fn maps(&self) -> &vase::VaseMaps {
        &self.maps
    }

    /// Object-space normals, and where they are.
    pub(crate) fn bent(&self) -> &Deflected {
        &self.bent
    }

    /// The normals as they are, for per-pixel shading with one material.
    pub(crate) fn exact(&self) -> Detail<'_> {
        Detail::Object { normals: &self.levels.normals, materials: None }
    }

    /// The normals of one material in a table of `entries`.
    pub(crate) fn quantized(&self, entries: u32, dither: Dither) -> Result<Quantized<ObjectSpace>> {
        self.quantized_as(&self.bent, entries, dither, None)
    }

    /// Normals and materials in one table.
    pub(crate) fn quantized_with(&self, entries: u32, materials: &MaterialMap) -> Result<Quantized<ObjectSpace>> {
        self.quantized_as(&self.bent, entries, Dither::None, Some(materials))
    }

    /// The same with the relief `times` as high.
    pub(crate) fn quantized_relief(&self, entries: u32, times: f32) -> Result<Quantized<ObjectSpace>> {
        let height = &self.maps.height;
        let bent = bend(&self.mesh, &HeightMap::new(height.heights().clone(), height.depth() * times)?)?;
        self.quantized_as(&bent, entries, Dither::None, Some(&self.maps.materials))
    }

    fn quantized_as(
        &self,
        bent: &Deflected,
        entries: u32,
        dither: Dither,
        materials: Option<&MaterialMap>,
    ) -> Result<Quantized<ObjectSpace>> {
        let covered = Some(&bent.covered);
        let options = Options { entries, effort: self.effort, materials, covered, mip_levels: true, dither };
        Ok(quantize(&bent.normals, &options, &Silent)?)
    }

    /// The vase, of `detail`, seen from the front in a picture of this aspect (width / height).
    pub(crate) fn scene<'a>(
        &'a self,
        detail: Detail<'a>,
        materials: &'a [Material],
        cover: Cover,
        lighting: Lighting<World>,
        aspect: f32,
    ) -> Result<Scene<'a>> {
        let base_color = (cover == Cover::Painted).then_some(BaseColor { levels: &self.color, repeat: Vec2::ONE });
        let object = Object { base_color, ..Object::new(&self.mesh, detail, materials) };
        Ok(Scene { objects: vec![object], lighting, camera: self.camera(aspect)? })
    }

    /// What a table with an entry for every texel would show: one view direction and colours that are filtered, but nothing
    /// quantised. What the method loses even so is not the quantiser's.
    pub(crate) fn shoot_unquantized(
        &self,
        materials: &[Material],
        lighting: &Lighting<World>,
        size: (u32, u32),
    ) -> Result<Shown> {
        let aspect = size.0 as f32 / size.1 as f32;
        let scene = self.scene(self.exact(), materials, Cover::None, lighting.clone(), aspect)?;
        let lit = bake_light_map(&scene.objects[0], lighting, scene.camera.eye())?;
        shoot(&self.scene(Detail::Baked(&lit), materials, Cover::None, lighting.clone(), aspect)?, Method::Static, size)
    }

    /// From the front, a little from above.
    pub(crate) fn camera(&self, aspect: f32) -> Result<Camera> {
        // The vase is taller than wide: the sphere about it need not fit the width.
        Ok(Camera::orbit(self.mesh.bounding_sphere(), 0.0, 0.18, 1.02, 0.45, aspect.max(1.0))?)
    }

    /// Width and height of a picture `height` pixels high.
    pub(crate) fn picture_size(height: u32) -> (u32, u32) {
        ((height * 3 / 4).max(1), height)
    }

    /// A key light from the upper left.
    pub(crate) fn one_light() -> Lighting<World> {
        let key = Light::from_angles(-FRAC_PI_2 * 0.55, 0.6, LinearRgb::gray(1.1));
        Lighting::new(LinearRgb::gray(0.09), vec![key])
    }

    /// A warm key light from the upper left and a weak cool one from the right.
    pub(crate) fn lights() -> Lighting<World> {
        let key = Light::from_angles(-FRAC_PI_2 * 0.5, 0.6, LinearRgb::new(1.2, 1.14, 1.05));
        let fill = Light::from_angles(FRAC_PI_2 * 1.15, 0.2, LinearRgb::new(0.2, 0.24, 0.3));
        Lighting::new(LinearRgb::new(0.10, 0.10, 0.11), vec![key, fill])
    }
}

fn bend(mesh: &Mesh, height: &HeightMap) -> Result<Deflected> {
    let options = Deflect::new(height.heights().size());
    Ok(deflect_heights(mesh, height, None, Filter::Plane4, Edges::Wrap, &options, &Silent)?)
}
