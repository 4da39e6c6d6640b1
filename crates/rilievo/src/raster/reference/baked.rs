//! A light map: every texel lit once, and drawn as a colour from then on.

use glam::Vec3;

use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::light::{Lighting, Shade, ShadeTable, shade};
use crate::mip::MipChain;
use crate::normal::{Normal, World};
use crate::raster::frame::check;
use crate::raster::scene::{Detail, Fragment, Object};
use crate::raster::texture::{Sampling, Taps};

/// Lights every texel of an object-space map once, for [`Detail::Baked`] and [`crate::raster::Method::Static`].
///
/// The view direction is one for the whole object, from its middle to `eye` (in the world), and so is that to each light:
/// the same look as the table method has with an entry for every texel. It stays right as long as lights and object
/// stand still, and highlights as long as the eye does.
///
/// - **Source:** Tarini et al. 2000, §§ 2 and 8: the precomputed light map that bump mapping is compared with.
///
/// # Errors
/// [`Error::Missing`] if the object's detail is no object-space map, and as [`crate::raster::prepare`].
pub fn bake_light_map(object: &Object<'_>, lighting: &Lighting<World>, eye: Vec3) -> Result<MipChain<Shade>> {
    check(object)?;
    let middle = object.mesh.bounding_sphere().0;
    let view = Normal::new_or(object.pose.point_to_object(eye) - middle, Normal::Z);
    let lighting = lighting.to_object(&object.pose).from_place(middle);
    let lit = |normal, material: u8| shade(&object.materials[usize::from(material)], &lighting, normal, view, middle);
    let levels: Result<Vec<Grid<Shade>>> = match object.detail {
        Detail::Object { normals, materials } => {
            let level = |(i, normals): (usize, &Grid<Normal<_>>)| {
                let material = |x, y| materials.map_or(0, |m| m.levels()[i][(x, y)]);
                let (width, height) = normals.size();
                Grid::from_fn(width, height, |x, y| lit(normals[(x, y)], material(x, y)))
            };
            normals.levels().iter().enumerate().map(level).collect()
        }
        Detail::Indexed(map) => {
            let table = ShadeTable::new(map.table(), object.materials, &lighting, view, middle)?;
            let entry = |&i: &u16| table.entries()[usize::from(i)];
            Ok(map.indices().levels().iter().map(|level| level.map(entry)).collect())
        }
        Detail::Smooth | Detail::Tangent { .. } | Detail::Baked(_) | Detail::Bump { .. } => {
            let remedy = "a light map is baked from an object-space map; bend a tangent-space map onto the mesh first";
            return Err(Error::Missing { what: "object-space normals", remedy });
        }
    };
    MipChain::from_levels(levels?)
}

/// Looks up a light map.
pub(in crate::raster) struct Baked<'a> {
    levels: &'a MipChain<Shade>,
}

impl<'a> Baked<'a> {
    /// # Errors
    /// [`Error::Missing`] without a light map.
    pub(in crate::raster) fn new(object: &Object<'a>) -> Result<Self> {
        let Detail::Baked(levels) = object.detail else {
            let remedy = "the static method draws a light map; bake one (raster::bake_light_map)";
            return Err(Error::Missing { what: "light map", remedy });
        };
        Ok(Self { levels })
    }

    pub(in crate::raster) fn shade(&self, fragment: &Fragment, sampling: Sampling) -> Shade {
        Taps::gather(self.levels, sampling, &fragment.footprint).iter().fold(Shade::default(), |sum, tap| {
            sum.add_weighted(self.levels.levels()[tap.level][(tap.x, tap.y)], tap.weight)
        })
    }
}
