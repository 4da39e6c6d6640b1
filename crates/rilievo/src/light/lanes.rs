//! The lighting models sixteen normals at a time: what [`super::shade`] says, for shade tables and for tiles of pixels.
//!
//! A material is prepared for its light once ([`Prepared::new`]): constant terms are added up, the products of light and
//! material are made, and the models sorted by what they need, so that nothing is asked for each normal.
//!
//! - **Determinism:** class C: within 2·10⁻⁴ · (1 + exponent) of the scalar definition, relative to the shade or to 1
//!   (reciprocal roots have 13 bits); a step or a band may begin that much earlier or later. Held by
//!   `lane_tests::lanes_are_the_scalar_definition` at every instruction set of the machine.

use std::sync::Arc;

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16};
use glam::{Mat3, Vec3};

use crate::color::LinearRgb;
use crate::light::lane_environment::{mirrored, reflected};
use crate::light::microfacet::{ALBEDO, DIELECTRIC, LEAST_COSINE, Microfacet};
use crate::light::scalar::luminance;
use crate::light::{Bands, Environment, Landscape, Light, Lighting, LightingModel, Material};
use crate::normal::Space;
use crate::simd::{Power, Vec3x16, cross, dot, exp2, recip, rsqrt, scale, splat, splat3};

/// Powers below this are taken for none, so that products with them are no denormal numbers.
const LEAST_POWER: f32 = 1e-30;
/// The least squared length that has a direction: what is shorter becomes shorter still, and no number stays no number.
const LEAST_SQUARE: f32 = 1e-20;

/// Diffuse red, green, blue and specular red, green, blue in each lane: sixteen [`super::Shade`]s.
pub(crate) type Shades<S> = [f32x16<S>; 6];

/// A material under some light.
#[derive(Debug, Clone)]
pub(crate) struct Prepared<Sp> {
    lights: Vec<Light<Sp>>,
    /// Light that is the same for all normals.
    even: LinearRgb,
    lambert: LinearRgb,
    steps: Vec<(LinearRgb, f32)>,
    highlights: Vec<Highlight>,
    facets: Vec<(f32, Microfacet)>,
    cartoons: Vec<(f32, Bands)>,
    chromes: Vec<(f32, Landscape)>,
    mirrors: Vec<(LinearRgb, f32)>,
    ambient: LinearRgb,
    environment: Option<Arc<Environment>>,
    to_sky: Mat3,
    up: Vec3,
}

#[derive(Debug, Clone, Copy)]
struct Highlight {
    kind: Kind,
    color: LinearRgb,
    power: Power,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Mirrored,
    Half,
    Doubled,
}

impl<Sp: Space> Prepared<Sp> {
    /// Prepares `material` under `lighting`.
    pub(crate) fn new(material: &Material, lighting: &Lighting<Sp>) -> Self {
        let mut prepared = Self {
            lights: lighting.lights.clone(),
            even: LinearRgb::BLACK,
            lambert: LinearRgb::BLACK,
            steps: Vec::new(),
            highlights: Vec::new(),
            facets: Vec::new(),
            cartoons: Vec::new(),
            chromes: Vec::new(),
            mirrors: Vec::new(),
            ambient: lighting.ambient,
            environment: lighting.environment.clone(),
            to_sky: Mat3::from_quat(lighting.to_sky),
            up: lighting.up(),
        };
        for layer in material.layers() {
            let weight = layer.weight;
            let highlight = |kind, color: LinearRgb, shininess| Highlight {
                kind,
                color: color * weight,
                power: Power::new(shininess),
            };
            match layer.model {
                LightingModel::Ambient { color } => prepared.even += lighting.ambient * color * weight,
                LightingModel::Lambert { color } => prepared.lambert += color * weight,
                LightingModel::Steps { color, steps } => {
                    prepared.steps.push((color * weight, f32::from(steps.max(1))));
                }
                LightingModel::Cartoon { bands } => prepared.cartoons.push((weight, bands)),
                LightingModel::Phong { color, shininess } => {
                    prepared.highlights.push(highlight(Kind::Mirrored, color, shininess));
                }
                LightingModel::BlinnPhong { color, shininess } => {
                    prepared.highlights.push(highlight(Kind::Half, color, shininess));
                }
                LightingModel::DoubledAngle { color, shininess } => {
                    prepared.highlights.push(highlight(Kind::Doubled, color, shininess));
                }
                LightingModel::Chrome { landscape } => prepared.chromes.push((weight, landscape)),
                LightingModel::Environment { color, roughness } => prepared.mirrors.push((color * weight, roughness)),
                LightingModel::MetallicRoughness { base_color, metallic, roughness } => {
                    prepared.facets.push((weight, Microfacet::new(base_color, metallic, roughness)));
                }
            }
        }
        // What mirrors nothing adds nothing, and its powers would still be taken.
        prepared.highlights.retain(|h| h.color != LinearRgb::BLACK);
        prepared
    }

    /// Whether shades hang on where the surface is, or on directions only.
    pub(crate) fn needs_position(&self) -> bool {
        self.lights.iter().any(|l| matches!(l, Light::Point { .. }))
    }

    /// What sixteen surfaces with unit normals `n` at `position` show to eyes in the unit directions `view`.
    #[inline(always)]
    pub(crate) fn shade<S: Simd>(&self, simd: S, n: Vec3x16<S>, view: Vec3x16<S>, position: Vec3x16<S>) -> Shades<S> {
        let mut sum = Sum { diffuse: splat3(simd, array(self.even)), specular: splat3(simd, [0.0; 3]) };
        let mut brightness = splat(simd, 0.0);
        for light in &self.lights {
            let ray = Ray::new(simd, light, position);
            let cosine = dot(n, ray.toward);
            let lit = cosine.simd_gt(splat(simd, 0.0));
            if !lit.any_true() {
                continue;
            }
            let cosine = lit.select(cosine, splat(simd, 0.0));
            // Colours are multiplied before the lanes are: a light far away has the same in all of them.
            let strength = ray.strength.map_or(cosine, |s| cosine * s);
            add(&mut sum.diffuse, simd, ray.color * self.lambert, strength);
            brightness = strength.mul_add(splat(simd, luminance(ray.color)), brightness);
            for &(color, steps) in &self.steps {
                let step = (cosine.mul_add(splat(simd, steps), splat(simd, 0.5))).floor() * (1.0 / steps);
                add(&mut sum.diffuse, simd, ray.color * color, ray.strength.map_or(step, |s| step * s));
            }
            if self.highlights.is_empty() && self.facets.is_empty() {
                continue;
            }
            self.gloss(simd, &mut sum, &ray, n, view, cosine, lit);
        }
        self.surroundings(simd, &mut sum, n, view, brightness);
        let ([a, b, c], [d, e, f]) = (sum.diffuse, sum.specular);
        [a, b, c, d, e, f]
    }

    /// Highlights and microfacets under one light.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "all of it is at hand where it is called, and this is inlined there")]
    fn gloss<S: Simd>(
        &self,
        simd: S,
        sum: &mut Sum<S>,
        ray: &Ray<S>,
        n: Vec3x16<S>,
        view: Vec3x16<S>,
        cosine: f32x16<S>,
        lit: mask32x16<S>,
    ) {
        let between = [0, 1, 2].map(|i| ray.toward[i] + view[i]);
        let squared = dot(between, between);
        let h = scale(between, rsqrt(simd, squared.max(splat(simd, LEAST_SQUARE))));
        let nh = dot(n, h);
        for highlight in &self.highlights {
            let base = match highlight.kind {
                Kind::Half => nh,
                // r·l = 2 (n·v)(n·l) − v·l
                Kind::Mirrored => mirrored_cosine(n, view, ray.toward, cosine),
                Kind::Doubled => {
                    let c = mirrored_cosine(n, view, ray.toward, cosine);
                    (c * c).mul_sub(splat(simd, 2.0), splat(simd, 1.0))
                }
            };
            let power = highlight.power.of(simd, base);
            let seen = lit & power.simd_gt(splat(simd, LEAST_POWER));
            let power = seen.select(power, splat(simd, 0.0));
            add(&mut sum.specular, simd, ray.color * highlight.color, ray.strength.map_or(power, |s| power * s));
        }
        // Light from straight behind the surface's eye has no h, and nothing shows.
        let seen = lit & squared.simd_gt(splat(simd, LEAST_SQUARE));
        for &(weight, facet) in &self.facets {
            let parts = facet_by_light(simd, &facet, n, h, view, cosine, nh);
            let strength = ray.strength.map_or(splat(simd, weight), |s| s * weight);
            sum.facet(simd, &facet, ray.color, parts.map(|p| seen.select(p * strength, splat(simd, 0.0))));
        }
    }

    /// What does not hang on a single light.
    #[inline(always)]
    fn surroundings<S: Simd>(&self, simd: S, sum: &mut Sum<S>, n: Vec3x16<S>, view: Vec3x16<S>, brightness: f32x16<S>) {
        for (weight, bands) in &self.cartoons {
            let (first, rest) = bands.bands().split_first().expect("invariant: bands are never empty");
            let mut color = splat3(simd, array(first.1));
            for (threshold, next) in rest {
                let reached = brightness.simd_ge(splat(simd, *threshold));
                color = choose(simd, reached, array(*next), color);
            }
            add_lanes(&mut sum.diffuse, simd, color, [*weight; 3]);
        }
        for (weight, landscape) in &self.chromes {
            let elevation = dot(mirrored(simd, n, view), splat3(simd, self.up.to_array()));
            let color = landscape_at(simd, landscape, elevation);
            add_lanes(&mut sum.specular, simd, color, [*weight; 3]);
        }
        for &(color, roughness) in &self.mirrors {
            let seen = self.reflected(simd, n, view, roughness);
            add_lanes(&mut sum.specular, simd, seen, array(color));
        }
        for &(weight, facet) in &self.facets {
            let nv = dot(n, view).max(splat(simd, LEAST_COSINE));
            let [scale, bias] = lane_albedo(simd, facet.roughness, nv);
            let dielectric = scale.mul_add(splat(simd, DIELECTRIC), bias);
            let zero = splat(simd, 0.0);
            sum.facet(simd, &facet, self.ambient * weight, [1.0 - dielectric, zero, zero, zero]);
            let seen = self.reflected(simd, n, view, facet.roughness);
            sum.facet_mirror(simd, &facet, seen, [dielectric, scale, bias].map(|p| p * weight));
        }
    }

    #[inline(always)]
    fn reflected<S: Simd>(&self, simd: S, n: Vec3x16<S>, view: Vec3x16<S>, roughness: f32) -> Vec3x16<S> {
        match &self.environment {
            Some(environment) => reflected(simd, environment, &self.to_sky, n, view, roughness),
            None => splat3(simd, array(self.ambient)),
        }
    }
}

/// The light of a [`Light`] at each of sixteen places.
struct Ray<S: Simd> {
    toward: Vec3x16<S>,
    color: LinearRgb,
    /// What the colour is multiplied by, if not 1.
    strength: Option<f32x16<S>>,
}

impl<S: Simd> Ray<S> {
    #[inline(always)]
    fn new<Sp: Space>(simd: S, light: &Light<Sp>, position: Vec3x16<S>) -> Self {
        match *light {
            Light::Directional { toward, color } => {
                Self { toward: splat3(simd, toward.vec().to_array()), color, strength: None }
            }
            Light::Point { position: place, color, reference_distance } => {
                let place = place.to_array();
                let to = [0, 1, 2].map(|i| splat(simd, place[i]) - position[i]);
                let squared = dot(to, to).max(splat(simd, LEAST_SQUARE));
                let toward = scale(to, rsqrt(simd, squared));
                let strength = reference_distance.map(|reference| {
                    let falloff = splat(simd, reference * reference) / squared;
                    falloff.min(splat(simd, super::lights::BRIGHTEST))
                });
                Self { toward, color, strength }
            }
        }
    }
}

struct Sum<S: Simd> {
    diffuse: Vec3x16<S>,
    specular: Vec3x16<S>,
}

impl<S: Simd> Sum<S> {
    /// Adds `Microfacet::split`'s mix of the four parts under a light of one colour.
    #[inline(always)]
    fn facet(&mut self, simd: S, facet: &Microfacet, light: LinearRgb, parts: [f32x16<S>; 4]) {
        let [diffuse, dielectric, tinted, white] = parts;
        let (metal, other) = (splat(simd, facet.metallic), splat(simd, 1.0 - facet.metallic));
        add(&mut self.diffuse, simd, light * facet.base, other.mul_add(diffuse, metal * tinted));
        add(&mut self.specular, simd, light, other.mul_add(dielectric, metal * white));
    }

    /// The same for what is mirrored, a colour in each lane, which has no diffuse part.
    #[inline(always)]
    fn facet_mirror(&mut self, simd: S, facet: &Microfacet, seen: Vec3x16<S>, parts: [f32x16<S>; 3]) {
        let [dielectric, tinted, white] = parts;
        let tinted = tinted * facet.metallic;
        let white = dielectric.mul_add(splat(simd, 1.0 - facet.metallic), white * facet.metallic);
        let base = array(facet.base);
        for i in 0..3 {
            self.diffuse[i] = (seen[i] * base[i]).mul_add(tinted, self.diffuse[i]);
            self.specular[i] = seen[i].mul_add(white, self.specular[i]);
        }
    }
}

/// `color` times `amount` onto `sum`.
#[inline(always)]
fn add<S: Simd>(sum: &mut Vec3x16<S>, simd: S, color: LinearRgb, amount: f32x16<S>) {
    let color = array(color);
    for i in 0..3 {
        sum[i] = amount.mul_add(splat(simd, color[i]), sum[i]);
    }
}

/// `color` in each lane times `by` onto `sum`.
#[inline(always)]
fn add_lanes<S: Simd>(sum: &mut Vec3x16<S>, simd: S, color: Vec3x16<S>, by: [f32; 3]) {
    for i in 0..3 {
        sum[i] = color[i].mul_add(splat(simd, by[i]), sum[i]);
    }
}

/// `then` where the mask is set.
#[inline(always)]
fn choose<S: Simd>(simd: S, mask: mask32x16<S>, then: [f32; 3], otherwise: Vec3x16<S>) -> Vec3x16<S> {
    [0, 1, 2].map(|i| mask.select(splat(simd, then[i]), otherwise[i]))
}

#[inline(always)]
fn array(c: LinearRgb) -> [f32; 3] {
    [c.r, c.g, c.b]
}

/// r·l for the mirrored eye r.
#[inline(always)]
fn mirrored_cosine<S: Simd>(n: Vec3x16<S>, view: Vec3x16<S>, l: Vec3x16<S>, nl: f32x16<S>) -> f32x16<S> {
    (dot(n, view) * 2.0).mul_sub(nl, dot(view, l))
}

/// [`Microfacet::by_light`]: diffuse, dielectric, tinted and white parts.
#[inline(always)]
fn facet_by_light<S: Simd>(
    simd: S,
    facet: &Microfacet,
    n: Vec3x16<S>,
    h: Vec3x16<S>,
    view: Vec3x16<S>,
    nl: f32x16<S>,
    nh: f32x16<S>,
) -> [f32x16<S>; 4] {
    let a = facet.alpha;
    let nv = dot(n, view).max(splat(simd, LEAST_COSINE));
    let vh = dot(view, h).max(splat(simd, 0.0)).min(splat(simd, 1.0));
    let across = cross(n, h);
    let anh = nh.max(splat(simd, 0.0)) * a;
    let k = splat(simd, a) / anh.mul_add(anh, dot(across, across));
    let root = |c: f32x16<S>| (c * c).mul_add(splat(simd, 1.0 - a * a), splat(simd, a * a)).sqrt();
    let visibility = 0.5 * recip(nv.mul_add(root(nl), nl * root(nv)));
    let glossy = k * k * visibility * nl;
    let t = 1.0 - vh;
    let t2 = t * t;
    let s = t2 * t2 * t;
    let dielectric = s.mul_add(splat(simd, 1.0 - DIELECTRIC), splat(simd, DIELECTRIC));
    [nl * (1.0 - dielectric), glossy * dielectric, glossy * (1.0 - s), glossy * s]
}

/// [`super::microfacet::albedo`].
#[inline(always)]
fn lane_albedo<S: Simd>(simd: S, roughness: f32, nv: f32x16<S>) -> [f32x16<S>; 2] {
    let r = ALBEDO.map(|[slope, offset]| roughness * slope + offset);
    let a004 = exp2(simd, nv * -9.28).min(splat(simd, r[0] * r[0])).mul_add(splat(simd, r[0]), splat(simd, r[1]));
    [a004.mul_add(splat(simd, -1.04), splat(simd, r[2])), a004.mul_add(splat(simd, 1.04), splat(simd, r[3]))]
}

/// `Landscape::at`.
#[inline(always)]
fn landscape_at<S: Simd>(simd: S, landscape: &Landscape, elevation: f32x16<S>) -> Vec3x16<S> {
    let unit = |v: f32x16<S>| v.max(splat(simd, 0.0)).min(splat(simd, 1.0));
    let (up, down) = (unit(elevation), unit(-elevation));
    let share = unit(elevation.mul_add(splat(simd, 0.5 / Landscape::HAZE), splat(simd, 0.5)));
    let [zenith, sky, ground, nadir] = [landscape.zenith, landscape.sky, landscape.ground, landscape.nadir].map(array);
    [0, 1, 2].map(|i| {
        let above = up.mul_add(splat(simd, zenith[i] - sky[i]), splat(simd, sky[i]));
        let below = down.mul_add(splat(simd, nadir[i] - ground[i]), splat(simd, ground[i]));
        share.mul_add(above - below, below)
    })
}
