//! Light that leaves a surface, and how it meets a base colour.

use bytemuck::{Pod, Zeroable};

use crate::color::LinearRgb;

/// What a material says of one normal: light for the base colour to tint, and light that goes on top.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct Shade {
    /// Ambient, diffuse and metallic light, already times the material's own colour.
    pub diffuse: LinearRgb,
    /// Specular light; not tinted by the base colour.
    pub specular: LinearRgb,
}

/// How shades meet the base colour `c₀`: `α` is the diffuse light, `s` the specular light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Blend {
    /// `c = c₀·α + s`: light adds up, as it does in nature.
    #[default]
    Add,
    /// `c = c₀·α + (1 − c₀·α)·s`: highlights cover what they lie on, so that full diffuse light and a full highlight stay in
    /// range. No light is taken away where `c₀·α` is more than 1.
    ///
    /// **Source:** Tarini et al. 2000, § 7.1, eq. (1), with a colour for `α`.
    Exact,
    /// `c = c₀·α + (1 − c₀)·s`: the same in one pass of fixed-function hardware; white surfaces have no highlights.
    ///
    /// **Source:** Tarini et al. 2000, § 7.2, eq. (2).
    Approximate,
    /// `c = α + s`: the colour is the material's, and a base colour plays no part.
    ///
    /// **Source:** Tarini et al. 2000, § 7.3.
    Material,
}

impl Shade {
    /// The light that leaves a surface of the given base colour.
    pub fn over(self, base: LinearRgb, blend: Blend) -> LinearRgb {
        let rest = |c: LinearRgb| {
            let left = |v: f32| (1.0 - v).max(0.0);
            LinearRgb::new(left(c.r), left(c.g), left(c.b))
        };
        match blend {
            Blend::Add => self.diffuse * base + self.specular,
            Blend::Exact => self.diffuse * base + rest(self.diffuse * base) * self.specular,
            Blend::Approximate => self.diffuse * base + rest(base) * self.specular,
            Blend::Material => self.diffuse + self.specular,
        }
    }

    /// `self` and `weight` times `other`, for filtering.
    pub fn add_weighted(self, other: Self, weight: f32) -> Self {
        Self { diffuse: self.diffuse + other.diffuse * weight, specular: self.specular + other.specular * weight }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blends_follow_their_equations() {
        let shade = Shade { diffuse: LinearRgb::gray(0.5), specular: LinearRgb::new(0.25, 0.5, 1.0) };
        let over = |base: f32, blend| shade.over(LinearRgb::gray(base), blend);
        assert_eq!(over(0.5, Blend::Add), LinearRgb::new(0.5, 0.75, 1.25));
        assert_eq!(over(0.5, Blend::Exact), LinearRgb::new(0.4375, 0.625, 1.0));
        assert_eq!(over(0.5, Blend::Approximate), LinearRgb::new(0.375, 0.5, 0.75));
        assert_eq!(over(0.5, Blend::Material), LinearRgb::new(0.75, 1.0, 1.5));
        // Black paint: all the same but the last, which has no paint.
        for blend in [Blend::Add, Blend::Exact, Blend::Approximate] {
            assert_eq!(over(0.0, blend), shade.specular, "{blend:?}");
        }
        // White: eq. (2) loses the highlight.
        assert_eq!(over(1.0, Blend::Approximate), shade.diffuse);
        // Overexposed: nothing is subtracted.
        assert_eq!(over(4.0, Blend::Exact), LinearRgb::gray(2.0));
    }
}
