//! The metallic-roughness BRDF of glTF 2.0.

use glam::Vec3;

use crate::color::LinearRgb;
use crate::light::Shade;

/// Reflectance of dielectrics at right angles (glTF 2.0, appendix B.2).
pub(super) const DIELECTRIC: f32 = 0.04;
/// The least α: below it highlights of directional lights would be points of unbounded brightness.
const LEAST_ALPHA: f32 = 0.002;
/// The least n·v: normals of maps may turn away from the eye, where the BRDF is not defined.
pub(super) const LEAST_COSINE: f32 = 1e-4;

/// Parameters in the form the equations take them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Microfacet {
    pub(super) base: LinearRgb,
    pub(super) metallic: f32,
    pub(super) roughness: f32,
    pub(super) alpha: f32,
}

impl Microfacet {
    /// Parameters outside of 0 … 1 are clamped.
    pub(super) fn new(base: LinearRgb, metallic: f32, roughness: f32) -> Self {
        let (metallic, roughness) = (metallic.clamp(0.0, 1.0), roughness.clamp(0.0, 1.0));
        Self { base, metallic, roughness, alpha: (roughness * roughness).max(LEAST_ALPHA) }
    }

    /// π · BRDF · n·l: what shows by a white light in direction `l`, with `nl` n·l > 0.
    pub(super) fn by_light(&self, n: Vec3, l: Vec3, view: Vec3, nl: f32) -> Shade {
        // Light from straight behind: nothing lies halfway, and Fresnel leaves no diffuse light either.
        let Some(h) = (l + view).try_normalize() else { return Shade::default() };
        let (nv, nh, vh) = (n.dot(view).max(LEAST_COSINE), n.dot(h).max(0.0), view.dot(h).clamp(0.0, 1.0));
        let a = self.alpha;
        // D of GGX (Walter et al. 2007, eq. 33) with sin² = |n×h|², which does not cancel near the highlight's middle:
        // π D = (α / (|n×h|² + (α n·h)²))².
        let k = a / (n.cross(h).length_squared() + (a * nh) * (a * nh));
        // G of Smith, correlated by height, over 4 n·l n·v (Heitz 2014, eq. 99; glTF 2.0, appendix B.3.2).
        let towards = |c: f32, other: f32| other * (a * a + (1.0 - a * a) * c * c).sqrt();
        let visibility = 0.5 / (towards(nl, nv) + towards(nv, nl));
        let glossy = k * k * visibility * nl;
        // Schlick's Fresnel (1994): F = F₀ + (1 − F₀) s, of the dielectric and of the metal.
        let s = (1.0 - vh).powi(5);
        let dielectric = DIELECTRIC + (1.0 - DIELECTRIC) * s;
        self.split(nl * (1.0 - dielectric), glossy * dielectric, glossy * (1.0 - s), glossy * s)
    }

    /// What shows by light from all sides: `ambient` for the diffuse part, `mirrored` for the specular one.
    pub(super) fn by_all(&self, ambient: LinearRgb, mirrored: LinearRgb, nv: f32) -> Shade {
        let (a, b) = albedo(self.roughness, nv.max(LEAST_COSINE));
        let dielectric = DIELECTRIC * a + b;
        let specular = self.split(0.0, dielectric, a, b);
        let diffuse = self.split(1.0 - dielectric, 0.0, 0.0, 0.0);
        Shade {
            diffuse: diffuse.diffuse * ambient + specular.diffuse * mirrored,
            specular: specular.specular * mirrored,
        }
    }

    /// The mix of dielectric and metal: `diffuse` and `dielectric` light of the one, `tinted` and `white` specular light of
    /// the other.
    fn split(&self, diffuse: f32, dielectric: f32, tinted: f32, white: f32) -> Shade {
        let m = self.metallic;
        Shade {
            diffuse: self.base * ((1.0 - m) * diffuse + m * tinted),
            specular: LinearRgb::gray((1.0 - m) * dielectric + m * white),
        }
    }
}

/// Scale of F₀ and bias that make the share of even light which GGX mirrors: `F₀ · scale + bias`.
///
/// Off by up to 0.06 at grazing angles, for F₀ = 0.04; held by `tests::the_albedo_is_near_the_integral`.
///
/// **Source:** Karis 2014, "Physically Based Shading on Mobile", EnvBRDFApprox.
pub(super) fn albedo(roughness: f32, nv: f32) -> (f32, f32) {
    let r = ALBEDO.map(|[slope, offset]| roughness * slope + offset);
    let a004 = (r[0] * r[0]).min((-9.28 * nv).exp2()) * r[0] + r[1];
    (-1.04 * a004 + r[2], 1.04 * a004 + r[3])
}

/// Slopes and offsets of [`albedo`].
pub(super) const ALBEDO: [[f32; 2]; 4] = [[-1.0, 1.0], [-0.0275, 0.0425], [-0.572, 1.04], [0.022, -0.04]];

#[cfg(test)]
mod tests {
    use super::*;

    fn direction(polar: f64, azimuth: f64) -> Vec3 {
        let (s, c) = polar.sin_cos();
        Vec3::new((s * azimuth.cos()) as f32, (s * azimuth.sin()) as f32, c as f32)
    }

    /// Share of an even sky that a material mirrors to an eye at `polar`: an integral over the hemisphere, the middle of the
    /// highlight finely.
    fn furnace(facet: &Microfacet, polar: f64, pick: impl Fn(Shade) -> f32) -> f64 {
        let view = direction(polar, 0.0);
        let (rings, sectors) = (600, 720);
        let mut sum = 0.0;
        for i in 0..rings {
            // Equal steps of angle, weighted by the sphere's own measure.
            let theta = (f64::from(i) + 0.5) / f64::from(rings) * std::f64::consts::FRAC_PI_2;
            let area = theta.sin() * std::f64::consts::FRAC_PI_2 / f64::from(rings) * std::f64::consts::TAU
                / f64::from(sectors);
            for j in 0..sectors {
                let phi = (f64::from(j) + 0.5) / f64::from(sectors) * std::f64::consts::TAU;
                let l = direction(theta, phi);
                // by_light is π · f · cos.
                sum += f64::from(pick(facet.by_light(Vec3::Z, l, view, l.z))) * area / std::f64::consts::PI;
            }
        }
        sum
    }

    #[test]
    fn no_roughness_mirrors_more_than_falls_on_it() {
        // By another way: half-vectors drawn at random from D, weighted by G; 10⁵ of them, in f64. What is missing to 1 is
        // light that would have bounced twice.
        let sampled = [
            (0.15f32, [0.999, 0.999, 0.999]),
            (0.3, [0.990, 0.989, 0.971]),
            (0.5, [0.916, 0.899, 0.847]),
            (0.75, [0.625, 0.630, 0.669]),
            (1.0, [0.308, 0.346, 0.473]),
        ];
        for (roughness, shares) in sampled {
            let metal = Microfacet::new(LinearRgb::WHITE, 1.0, roughness);
            for (polar, sampled) in [0.1, 0.6, 1.1].into_iter().zip(shares) {
                let share = furnace(&metal, polar, |s| s.diffuse.g + s.specular.g);
                assert!(share < 1.0, "{share}");
                assert!((share - sampled).abs() < 0.01, "metal of {roughness} at {polar}: {share} for {sampled}");
                // Dielectrics: glTF takes from the diffuse light what Fresnel mirrors at the half-vector, not at the normal, and
                // so gives back up to 5 % too much towards the rim.
                let white = Microfacet::new(LinearRgb::WHITE, 0.0, roughness);
                let share = furnace(&white, polar, |s| s.diffuse.g + s.specular.g);
                assert!((0.9..=1.05).contains(&share), "dielectric of {roughness} at {polar}: {share}");
            }
        }
    }

    #[test]
    fn the_albedo_is_near_the_integral() {
        for roughness in [0.2f32, 0.4, 0.6, 0.8, 1.0] {
            for polar in [0.0f64, 0.5, 1.0, 1.3] {
                let (scale, bias) = albedo(roughness, polar.cos() as f32);
                // F₀ = 0.04: the share of the dielectric's specular light.
                let facet = Microfacet::new(LinearRgb::WHITE, 0.0, roughness);
                let exact = furnace(&facet, polar, |s| s.specular.g);
                let near = f64::from(0.04 * scale + bias);
                assert!((near - exact).abs() < 0.06, "{roughness} at {polar}: {near} for {exact}");
            }
        }
    }

    #[test]
    fn light_and_eye_can_change_places() {
        let n = Vec3::Z;
        for i in 0..200 {
            let at = |k: f64| direction(((f64::from(i) * k).sin() * 0.5 + 0.5) * 1.5, f64::from(i) * 2.3 * k);
            let (a, b) = (at(0.37), at(1.91));
            for metallic in [0.0, 0.4, 1.0] {
                let facet = Microfacet::new(LinearRgb::new(0.9, 0.5, 0.2), metallic, 0.1 + (i % 9) as f32 * 0.1);
                // Without the cosine of the light the BRDF is symmetric.
                let there = facet.by_light(n, a, b, a.z).specular.g / a.z;
                let back = facet.by_light(n, b, a, b.z).specular.g / b.z;
                assert!((there - back).abs() <= 1e-3 * there.abs(), "{there} and {back}");
            }
        }
    }

    /// The equations of glTF 2.0, appendix B, as they are printed, in f64.
    #[test]
    fn values_are_those_of_the_printed_equations() {
        let base = [0.9f64, 0.5, 0.2];
        for i in 0..500 {
            let at = |k: f64| direction(((f64::from(i) * k).sin() * 0.5 + 0.5) * 1.45, f64::from(i) * 1.7 * k);
            let (l, v, n) = (at(0.53).as_dvec3(), at(1.37).as_dvec3(), glam::DVec3::Z);
            let (metallic, roughness) = (f64::from(i % 5) / 4.0, 0.1 + f64::from(i % 7) * 0.15);
            let h = (l + v).normalize();
            let a2 = roughness.powi(4);
            let (nl, nv, nh, vh) = (n.dot(l), n.dot(v), n.dot(h), v.dot(h));
            let d = a2 / (std::f64::consts::PI * (nh * nh * (a2 - 1.0) + 1.0).powi(2));
            let root = |c: f64| (a2 + (1.0 - a2) * c * c).sqrt();
            let specular = 0.5 / (nl * root(nv) + nv * root(nl)) * d;
            let schlick = |f0: f64| f0 + (1.0 - f0) * (1.0 - vh).powi(5);
            let facet = Microfacet::new(LinearRgb::new(0.9, 0.5, 0.2), metallic as f32, roughness as f32);
            let shade = facet.by_light(n.as_vec3(), l.as_vec3(), v.as_vec3(), nl as f32);
            let total = shade.diffuse + shade.specular;
            for (found, base) in [total.r, total.g, total.b].into_iter().zip(base) {
                let f = schlick(0.04);
                let dielectric = (1.0 - f) * base / std::f64::consts::PI + f * specular;
                let metal = specular * schlick(base);
                let exact = (dielectric * (1.0 - metallic) + metal * metallic) * nl * std::f64::consts::PI;
                assert!((f64::from(found) - exact).abs() < 2e-4 * exact + 1e-6, "{found} for {exact}");
            }
        }
    }
}
