//! Shading by the pixel: the reference.

use glam::Vec3;

use crate::error::{Error, Result};
use crate::light::{Lighting, Material, Shade, shade};
use crate::mip::MipChain;
use crate::normal::{Normal, Object as ObjectSpace, Space};
use crate::raster::scene::{Detail, Fragment, Object};
use crate::raster::texture::{Footprint, Sampling, Taps};
use crate::surface::Frame;

/// Filters the normals, normalises, and evaluates the lighting model with the pixel's own view direction.
pub(in crate::raster) struct Exact<'a> {
    detail: Detail<'a>,
    materials: &'a [Material],
    lighting: Lighting<ObjectSpace>,
    eye: Vec3,
}

impl<'a> Exact<'a> {
    /// For an eye at `eye` in object space.
    ///
    /// # Errors
    /// [`Error::Missing`] if there are no normals.
    pub(in crate::raster) fn new(object: &Object<'a>, lighting: Lighting<ObjectSpace>, eye: Vec3) -> Result<Self> {
        let remedy = match object.detail {
            Detail::Baked(_) => Some("a light map can only be drawn as it is (Method::Static)"),
            Detail::Bump { .. } => Some("a bump-vector map holds words for a unit (Method::Polar)"),
            _ => None,
        };
        if let Some(remedy) = remedy {
            return Err(Error::Missing { what: "normals", remedy });
        }
        Ok(Self { detail: object.detail, materials: object.materials, lighting, eye })
    }

    /// The light, in object space.
    pub(in crate::raster) fn lighting(&self) -> &Lighting<ObjectSpace> {
        &self.lighting
    }

    /// The eye, in object space.
    pub(in crate::raster) fn eye(&self) -> Vec3 {
        self.eye
    }

    pub(in crate::raster) fn shade(&self, fragment: &Fragment, sampling: Sampling) -> Shade {
        let smooth = Normal::new_or(fragment.normal, Normal::Z);
        let view = Normal::new_or(self.eye - fragment.position, smooth);
        let frame = Frame::from_mikk(fragment.normal, fragment.tangent);
        let mut total = Shade::default();
        for part in gather(self.detail, fragment, sampling).iter() {
            let normal = match self.detail {
                Detail::Smooth | Detail::Baked(_) | Detail::Bump { .. } => smooth,
                Detail::Tangent { .. } => frame.to_object(Normal::new_or(part.sum, Normal::Z)),
                Detail::Object { .. } | Detail::Indexed(_) => Normal::new_or(part.sum, smooth),
            };
            let normal = if fragment.back_facing { Normal::from_unit(-normal.vec()) } else { normal };
            let material = &self.materials[usize::from(part.material)];
            let shade = shade(material, &self.lighting, normal, view, fragment.position);
            total = total.add_weighted(shade, part.weight);
        }
        total
    }
}

/// The map's normals under a pixel, summed per material.
pub(super) fn gather(detail: Detail<'_>, fragment: &Fragment, sampling: Sampling) -> Parts {
    let mut parts = Parts::default();
    match detail {
        Detail::Smooth | Detail::Baked(_) | Detail::Bump { .. } => parts.add(0, Vec3::ZERO, 1.0),
        Detail::Tangent { normals, repeat, materials } => {
            let sampling = Sampling { repeat, ..sampling };
            gather_map(&mut parts, normals, materials, &fragment.footprint, sampling);
        }
        Detail::Object { normals, materials } => {
            gather_map(&mut parts, normals, materials, &fragment.footprint, sampling);
        }
        Detail::Indexed(map) => {
            let levels = map.indices();
            for tap in Taps::gather(levels, sampling, &fragment.footprint).iter() {
                let index = levels.levels()[tap.level][(tap.x, tap.y)];
                let normal = map.table().normals()[usize::from(index)];
                parts.add(map.table().material_of(index), normal.vec(), tap.weight);
            }
        }
    }
    parts
}

fn gather_map<S: Space>(
    parts: &mut Parts,
    normals: &MipChain<Normal<S>>,
    materials: Option<&MipChain<u8>>,
    footprint: &Footprint,
    sampling: Sampling,
) {
    for tap in Taps::gather(normals, sampling, footprint).iter() {
        let at = (tap.x, tap.y);
        let material = materials.map_or(0, |m| m.levels()[tap.level][at]);
        parts.add(material, normals.levels()[tap.level][at].vec(), tap.weight);
    }
}

/// The texels of one material under a pixel.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Part {
    pub(super) material: u8,
    /// Weighted sum of the normals.
    pub(super) sum: Vec3,
    pub(super) weight: f32,
}

/// At most one part per tap.
#[derive(Default)]
pub(super) struct Parts {
    parts: [Part; 8],
    len: usize,
}

impl Parts {
    fn add(&mut self, material: u8, normal: Vec3, weight: f32) {
        let known = self.parts[..self.len].iter_mut().find(|p| p.material == material);
        let part = match known {
            Some(part) => part,
            None => {
                self.len += 1;
                let part = &mut self.parts[self.len - 1];
                part.material = material;
                part
            }
        };
        part.sum += normal * weight;
        part.weight += weight;
    }

    pub(super) fn iter(&self) -> std::slice::Iter<'_, Part> {
        self.parts[..self.len].iter()
    }
}
