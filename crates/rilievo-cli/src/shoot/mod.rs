//! Taking the pictures: what was asked for is read once, and each frame is drawn from it.

mod painter;

use std::path::Path;

use anyhow::{Context, Result};
use glam::Vec3;
use rilievo::light::{Material, Shade};
use rilievo::raster::{Detail, Object, Scene, bake_light_map};
use rilievo::{MipChain, Pose};

use crate::args::{MethodArg, MethodKind, Turn};
use crate::batch::named;
use crate::exit::{remark, usage};
use crate::relief::Relief;
use crate::scene::{ObjectSpec, SceneSpec, Surroundings, takes_vectors};

pub(crate) use painter::{Painter, Painting, check_size};

/// Everything that stays from frame to frame.
pub(crate) struct Stage<'s> {
    spec: &'s SceneSpec,
    props: Vec<Prop>,
    around: Surroundings,
    /// About all objects, in the world.
    sphere: (Vec3, f32),
}

/// An object as it was read.
pub(crate) struct Prop {
    pub(crate) relief: Relief,
    materials: Vec<Material>,
}

impl<'s> Stage<'s> {
    /// Reads everything and makes the tables.
    ///
    /// # Errors
    /// Usage errors where the method cannot draw what is given, errors of files and of the library; they name the object.
    pub(crate) fn load(spec: &'s SceneSpec) -> Result<Self> {
        let kind = spec.picture.kind();
        if let MethodKind::Polar(unit) = kind
            && unit.is_distant()
            && spec.light.has_near_lamps()
        {
            return Err(usage(format!(
                "the {unit} unit holds directions of light in tables; give it directional lights, or take another unit"
            )));
        }
        let load = |object: &ObjectSpec| {
            let relief = object.relief.load(kind, &object.given)?;
            let default = |m| relief.default_materials.material(m);
            let materials = object.materials.resolve(relief.material_count(), default);
            let of_vectors = matches!(kind, MethodKind::Vectors | MethodKind::Polar(_));
            if of_vectors && !materials.iter().all(takes_vectors) {
                let method = spec.picture.method.name();
                return Err(usage(format!(
                    "the {method} method lights materials of ambient, Lambert and Blinn-Phong layers only; \
                     use the exact or the table method for other models"
                )));
            }
            if let Some(made) = &relief.quantized {
                let rms = made.error.rms_rad.to_degrees();
                remark(format!("{}: {} entries, {rms:.3} degrees RMS", object.name, made.entries));
            }
            Ok(Prop { relief, materials })
        };
        let told = |object: &ObjectSpec, error: anyhow::Error| match spec.file {
            // Where in the scene it is, whatever it is.
            Some(_) => error.context(object.name.clone()),
            None => named(error, Path::new(&object.name)),
        };
        let props = spec.objects.iter().map(|o| load(o).map_err(|e| told(o, e)));
        let props: Vec<Prop> = props.collect::<Result<_>>()?;
        let around = spec.light.surroundings(spec.mirrors())?;
        let spheres = spec.objects.iter().zip(&props).map(|(object, prop)| {
            let (middle, radius) = prop.relief.mesh.bounding_sphere();
            (object.pose.point_to_world(middle), radius * object.pose.scale)
        });
        let sphere = around_all(&spheres.collect::<Vec<_>>());
        Ok(Self { spec, props, around, sphere })
    }

    /// The objects as they were read.
    pub(crate) fn props(&self) -> &[Prop] {
        &self.props
    }

    /// Frame number `frame`; `baked` are the light maps of the objects, if they are drawn so.
    pub(crate) fn scene<'a>(&'a self, frame: u32, baked: &'a [MipChain<Shade>]) -> Result<Scene<'a>> {
        let picture = &self.spec.picture;
        let turn = frame as f32 / picture.frames as f32 * std::f32::consts::TAU;
        let turn_of = |what: Turn| if picture.turn == what { turn } else { 0.0 };
        // About the middle of everything, not about an object's origin.
        let table = Pose::turned_about(self.sphere.0, turn_of(Turn::Object));
        let object = |(i, (object, prop)): (usize, (&'a ObjectSpec, &'a Prop))| {
            let relief = &prop.relief;
            let detail = baked.get(i).map_or_else(|| relief.detail(), Detail::Baked);
            Object {
                pose: after(&table, &object.pose),
                base_color: relief.base_color(),
                blend: object.blend,
                double_sided: object.double_sided,
                edges: object.relief.edges(),
                ..Object::new(&relief.mesh, detail, &prop.materials)
            }
        };
        let aspect = picture.size.width as f32 / picture.size.height as f32;
        let camera = self.spec.camera.resolve(self.sphere, aspect, turn_of(Turn::Camera));
        Ok(Scene {
            objects: self.spec.objects.iter().zip(&self.props).enumerate().map(object).collect(),
            lighting: self.spec.light.lighting(&self.around, self.sphere, turn_of(Turn::Light)),
            camera: camera.with_context(|| format!("{}: camera", self.spec.called()))?,
        })
    }

    /// The light maps of all objects under the first frame's light, if that is how they are drawn; none otherwise.
    pub(crate) fn bake(&self) -> Result<Vec<MipChain<Shade>>> {
        let picture = &self.spec.picture;
        if picture.method != MethodArg::Static {
            return Ok(Vec::new());
        }
        if picture.frames > 1 {
            remark(match picture.turn {
                Turn::Light => "the light map is that of the first frame: the light that turns is not seen to turn",
                Turn::Object => "the light map is that of the first frame: its light turns with the object",
                Turn::Camera => "the light map is that of the first frame: its highlights stay where they are",
            });
        }
        let scene = self.scene(0, &[])?;
        let bake = |object| bake_light_map(object, &scene.lighting, scene.camera.eye()).map_err(anyhow::Error::from);
        scene.objects.iter().map(bake).collect()
    }
}

/// What `first` does, and then `then`.
fn after(then: &Pose, first: &Pose) -> Pose {
    Pose {
        rotation: then.rotation * first.rotation,
        scale: then.scale * first.scale,
        translation: then.point_to_world(first.translation),
    }
}

/// A sphere about spheres: exactly the one if there is one.
fn around_all(spheres: &[(Vec3, f32)]) -> (Vec3, f32) {
    if let [only] = spheres {
        return *only;
    }
    let low = spheres.iter().map(|(m, r)| *m - Vec3::splat(*r)).fold(Vec3::INFINITY, Vec3::min);
    let high = spheres.iter().map(|(m, r)| *m + Vec3::splat(*r)).fold(Vec3::NEG_INFINITY, Vec3::max);
    let middle = (low + high) * 0.5;
    (middle, spheres.iter().map(|(m, r)| middle.distance(*m) + r).fold(0.0, f32::max))
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;

    #[test]
    fn one_pose_after_another_is_both() {
        let first = Pose { rotation: Quat::from_rotation_x(0.4), scale: 2.0, translation: Vec3::new(1.0, -2.0, 0.5) };
        let then = Pose::turned_about(Vec3::new(0.3, 0.0, 4.0), 1.1);
        let p = Vec3::new(0.2, 0.7, -0.9);
        let both = then.point_to_world(first.point_to_world(p));
        assert!((after(&then, &first).point_to_world(p) - both).length() < 1e-5);
    }

    #[test]
    fn the_sphere_about_spheres_holds_them() {
        let one = (Vec3::new(1.0, 2.0, 3.0), 0.7);
        assert_eq!(around_all(&[one]), one);
        let spheres = [one, (Vec3::new(-4.0, 0.0, 1.0), 0.2), (Vec3::new(0.0, 5.0, -1.0), 1.5)];
        let (middle, radius) = around_all(&spheres);
        assert!(spheres.iter().all(|(m, r)| middle.distance(*m) + r <= radius + 1e-5));
        assert!(radius < 6.0, "{radius}");
    }
}
