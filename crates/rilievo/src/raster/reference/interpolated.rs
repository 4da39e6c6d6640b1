//! Shading with interpolated light and half vectors, the normals as the tangent-space map has them.

use glam::{Vec2, Vec3};

use crate::color::LinearRgb;
use crate::error::{Error, Result};
use crate::light::{Lighting, LightingModel, Material, Shade};
use crate::normal::{Normal, Object as ObjectSpace};
use crate::raster::reference::draw::ScreenTriangle;
use crate::raster::reference::exact::gather;
use crate::raster::scene::{Detail, Fragment, Object};
use crate::raster::texture::Sampling;
use crate::raster::vectors::{Field, Interpolation, Rotated, Sides, Vertices};

/// One object under interpolated vectors.
pub(in crate::raster) struct Interpolated<'a> {
    how: Interpolation,
    object: &'a Object<'a>,
    lighting: Lighting<ObjectSpace>,
    eye: Vec3,
}

/// The vectors of all lights over one triangle of the screen.
#[derive(Debug, Clone)]
pub(in crate::raster) struct Fields {
    /// Vertex 0 in pixels, which the fields start from.
    origin: [f64; 2],
    /// One for each light; none if the triangle has no area in f32.
    pub(in crate::raster) fields: Vec<Field>,
}

impl Fields {
    /// The vectors of light number `light` at the centre of a pixel; none if there are no vectors.
    fn at(&self, light: usize, x: u32, y: u32) -> Rotated {
        let [x, y] = [f64::from(x) + 0.5 - self.origin[0], f64::from(y) + 0.5 - self.origin[1]];
        self.fields.get(light).map_or_else(Rotated::default, |f| f.at(x as f32, y as f32))
    }
}

impl<'a> Interpolated<'a> {
    /// For an eye at `eye` in object space.
    ///
    /// # Errors
    /// [`Error::Missing`] if the normals are not in tangent space, or a material needs other vectors than L' and H'.
    pub(in crate::raster) fn new(
        how: Interpolation,
        object: &'a Object<'a>,
        lighting: Lighting<ObjectSpace>,
        eye: Vec3,
    ) -> Result<Self> {
        if !matches!(object.detail, Detail::Tangent { .. } | Detail::Smooth) {
            let remedy = "interpolated vectors need a tangent-space normal map, or the mesh's own normals; \
                          use the exact or the table method for object-space maps";
            return Err(Error::Missing { what: "tangent-space normals", remedy });
        }
        if !object.materials.iter().all(supported) {
            let remedy = "interpolated vectors light ambient, Lambert and Blinn-Phong layers; use the exact method \
                          for others";
            return Err(Error::Missing { what: "materials of light and half vectors", remedy });
        }
        Ok(Self { how, object, lighting, eye })
    }

    /// The vectors in all corners of the mesh.
    pub(in crate::raster) fn vertices(&self) -> Vertices {
        Vertices::new(self.object.mesh, &self.lighting.lights, self.eye)
    }

    /// The light, in object space.
    pub(in crate::raster) fn lighting(&self) -> &Lighting<ObjectSpace> {
        &self.lighting
    }

    /// The vectors over all triangles.
    pub(in crate::raster) fn fields(&self, triangles: &[ScreenTriangle]) -> Vec<Fields> {
        let vertices = self.vertices();
        triangles.iter().map(|t| self.fields_over(t, &vertices)).collect()
    }

    fn fields_over(&self, triangle: &ScreenTriangle, vertices: &Vertices) -> Fields {
        let corners = triangle.shape.corners();
        let from_first = |i: usize| (corners[i] - corners[0]).as_vec2();
        let sides = Sides { first: from_first(1), second: from_first(2) };
        let weights = triangle.corners.map(|c| c.weights);
        let fields = self.over_triangle(triangle.vertices, &weights, &sides, vertices);
        Fields { origin: corners[0].to_array(), fields }
    }

    /// The vectors over a triangle of the mesh, or the part of it whose corners have these weights: one field for each light,
    /// none if it has no area.
    pub(in crate::raster) fn over_triangle(
        &self,
        corners: [u32; 3],
        weights: &[[f64; 3]; 3],
        sides: &Sides,
        vertices: &Vertices,
    ) -> Vec<Field> {
        let shininess = self.object.highest_shininess();
        let field = |light| {
            let lit = vertices.triangle(corners, weights, light);
            Field::new(self.how, (&lit.corners, &lit.vectors), sides, &vertices.viewer(light), shininess)
        };
        (0..vertices.lights()).filter_map(field).collect()
    }

    /// The pixel (x, y) of a triangle with these fields.
    pub(in crate::raster) fn shade(
        &self,
        fragment: &Fragment,
        sampling: Sampling,
        fields: &Fields,
        (x, y): (u32, u32),
    ) -> Shade {
        self.shade_by(fragment, sampling, |light| fields.at(light, x, y))
    }

    /// A pixel at which light number `i` has the vectors `vectors(i)`.
    pub(in crate::raster) fn shade_by(
        &self,
        fragment: &Fragment,
        sampling: Sampling,
        vectors: impl Fn(usize) -> Rotated,
    ) -> Shade {
        let side = if fragment.back_facing { -1.0 } else { 1.0 };
        let mut total = Shade::default();
        for part in gather(self.object.detail, fragment, sampling).iter() {
            let normal = match self.object.detail {
                Detail::Smooth => Vec3::Z,
                _ => Normal::<crate::normal::Tangent>::new_or(part.sum, Normal::Z).vec(),
            } * side;
            let material = &self.object.materials[usize::from(part.material)];
            let mut shade = ambient(material, self.lighting.ambient);
            for (i, light) in self.lighting.lights.iter().enumerate() {
                let Rotated { light: l, half: h } = vectors(i);
                let products = Vec2::new(normal.dot(l), normal.dot(h));
                add_light(&mut shade, material, light.color_at(fragment.position), products);
            }
            total = total.add_weighted(shade, part.weight);
        }
        total
    }
}

/// Whether light and half vectors are all that a material needs.
pub(super) fn supported(material: &Material) -> bool {
    material.layers().iter().all(|layer| {
        matches!(
            layer.model,
            LightingModel::Ambient { .. } | LightingModel::Lambert { .. } | LightingModel::BlinnPhong { .. }
        )
    })
}

/// What the material makes of light from everywhere.
pub(super) fn ambient(material: &Material, light: LinearRgb) -> Shade {
    material.layers().iter().fold(Shade::default(), |shade, layer| match layer.model {
        LightingModel::Ambient { color } => Shade { diffuse: shade.diffuse + light * color * layer.weight, ..shade },
        _ => shade,
    })
}

/// Adds what the material makes of one light, from n·L' and n·H': as [`crate::light::shade`] does.
fn add_light(shade: &mut Shade, material: &Material, light: LinearRgb, products: Vec2) {
    let Vec2 { x: cosine, y: half } = products;
    if cosine <= 0.0 {
        return;
    }
    for layer in material.layers() {
        match layer.model {
            LightingModel::Lambert { color } => shade.diffuse += light * color * (cosine * layer.weight),
            LightingModel::BlinnPhong { color, shininess } => {
                shade.specular += light * color * (half.max(0.0).powf(shininess) * layer.weight);
            }
            _ => {}
        }
    }
}
