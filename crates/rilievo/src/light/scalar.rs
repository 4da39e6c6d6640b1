//! The definition of all lighting models, one normal at a time.

use glam::Vec3;

use crate::color::LinearRgb;
use crate::light::microfacet::Microfacet;
use crate::light::{Lighting, LightingModel, Material, Shade};
use crate::normal::{Normal, Space};

/// Powers below this are taken for none: nobody sees them, and denormal numbers cost a hundred times as much as others.
const LEAST_POWER: f32 = 1e-30;

/// What a surface of `material` with normal `n` at `position` shows to an eye in direction `view` (surface → eye).
///
/// The scalar definition: shade tables and pixels are lit by it or held against it. Light from behind the surface
/// (n·l ≤ 0) gives neither diffuse light nor a highlight. `position` counts for point lights only.
///
/// - **Determinism:** class C (`powf` is the system's).
/// - **Source:** Tarini et al. 2000, § 5.1; each model names its own.
pub fn shade<S: Space>(
    material: &Material,
    lighting: &Lighting<S>,
    n: Normal<S>,
    view: Normal<S>,
    position: Vec3,
) -> Shade {
    let (n, view) = (n.vec(), view.vec());
    let mut total = Shade::default();
    let mut brightness = 0.0;
    for light in &lighting.lights {
        let Some(l) = light.toward(position) else { continue };
        let cosine = n.dot(l);
        if cosine <= 0.0 {
            continue;
        }
        let light = light.color_at(position);
        brightness += luminance(light) * cosine;
        for layer in material.layers() {
            let shade = by_light(&layer.model, n, l, view, cosine);
            let weighted = light * layer.weight;
            total.diffuse += shade.diffuse * weighted;
            total.specular += shade.specular * weighted;
        }
    }
    for layer in material.layers() {
        total = total.add_weighted(by_all(&layer.model, lighting, n, view, brightness), layer.weight);
    }
    total
}

/// The answer to a single white light in direction `l`, with `cosine` n·l > 0.
fn by_light(model: &LightingModel, n: Vec3, l: Vec3, view: Vec3, cosine: f32) -> Shade {
    let tinted = |color: LinearRgb, amount: f32| Shade { diffuse: color * amount, ..Shade::default() };
    let on_top = |color: LinearRgb, amount: f32| Shade { specular: color * amount, ..Shade::default() };
    match *model {
        LightingModel::Ambient { .. }
        | LightingModel::Cartoon { .. }
        | LightingModel::Chrome { .. }
        | LightingModel::Environment { .. } => Shade::default(),
        LightingModel::Lambert { color } => tinted(color, cosine),
        LightingModel::Steps { color, steps } => {
            let steps = f32::from(steps.max(1));
            tinted(color, (cosine * steps + 0.5).floor() / steps)
        }
        LightingModel::Phong { color, shininess } => on_top(color, power(mirrored(n, view).dot(l), shininess)),
        LightingModel::BlinnPhong { color, shininess } => {
            // A light straight behind the eye's opposite gives h = 0 and no highlight.
            let h = (l + view).normalize_or_zero();
            on_top(color, power(n.dot(h), shininess))
        }
        LightingModel::DoubledAngle { color, shininess } => {
            let c = mirrored(n, view).dot(l);
            // cos 2θ = 2 cos² θ − 1
            on_top(color, power(2.0 * c * c - 1.0, shininess))
        }
        LightingModel::MetallicRoughness { base_color, metallic, roughness } => {
            Microfacet::new(base_color, metallic, roughness).by_light(n, l, view, cosine)
        }
    }
}

/// The answer to what comes from all sides, or hangs on the light of all lights together.
fn by_all<S: Space>(model: &LightingModel, lighting: &Lighting<S>, n: Vec3, view: Vec3, brightness: f32) -> Shade {
    let tinted = |diffuse: LinearRgb| Shade { diffuse, ..Shade::default() };
    let on_top = |specular: LinearRgb| Shade { specular, ..Shade::default() };
    match *model {
        LightingModel::Lambert { .. }
        | LightingModel::Steps { .. }
        | LightingModel::Phong { .. }
        | LightingModel::BlinnPhong { .. }
        | LightingModel::DoubledAngle { .. } => Shade::default(),
        LightingModel::Ambient { color } => tinted(lighting.ambient * color),
        LightingModel::Cartoon { bands } => tinted(bands.at(brightness)),
        LightingModel::Chrome { landscape } => on_top(landscape.at(mirrored(n, view).dot(lighting.up()))),
        LightingModel::Environment { color, roughness } => on_top(lighting.reflected(n, view, roughness) * color),
        LightingModel::MetallicRoughness { base_color, metallic, roughness } => {
            let mirrored = lighting.reflected(n, view, roughness);
            Microfacet::new(base_color, metallic, roughness).by_all(lighting.ambient, mirrored, n.dot(view))
        }
    }
}

/// `v` mirrored at the normal.
pub(super) fn mirrored(n: Vec3, v: Vec3) -> Vec3 {
    n * (2.0 * n.dot(v)) - v
}

/// How bright a colour looks (ITU-R BT.709).
pub(super) fn luminance(c: LinearRgb) -> f32 {
    0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b
}

/// `base` to the power, 0 for what is below 0 or too dark to see.
fn power(base: f32, exponent: f32) -> f32 {
    let power = base.max(0.0).powf(exponent);
    if power < LEAST_POWER { 0.0 } else { power }
}
