//! Whether stored vectors look like normals.

use rilievo::{Space, Tangent};

use super::raster::Depth;

/// What the lengths and signs of the stored vectors say about the file.
#[derive(Debug, Default)]
pub(super) struct Lengths {
    /// Texels more than 10 % off unit length: count and first. Rounding to 8 bits gives below 1 %, JPEG a few.
    off: (usize, usize),
    /// Texels that point into the surface: count and first.
    backward: (usize, usize),
    any_negative: bool,
    any_different: bool,
}

impl Lengths {
    /// Takes texels in, of which the first is number `first_texel`; those that are not covered do not count.
    pub(super) fn measure<T: Copy>(
        &mut self,
        samples: &[T],
        channels: usize,
        first_texel: usize,
        covered: Option<&[bool]>,
        component: impl Fn(T) -> f32,
    ) {
        let note = |(count, first): &mut (usize, usize), i| {
            *first = if *count == 0 { first_texel + i } else { *first };
            *count += 1;
        };
        for (i, t) in samples.chunks_exact(channels).enumerate() {
            if covered.is_some_and(|c| !c[i]) {
                continue;
            }
            let [x, y, z] = [t[0], t[1], t[2]].map(&component);
            let squared = x * x + y * y + z * z;
            if !(0.81..=1.21).contains(&squared) {
                note(&mut self.off, i);
            }
            if z < 0.0 {
                note(&mut self.backward, i);
            }
            self.any_negative |= x < 0.0 || y < 0.0 || z < 0.0;
            self.any_different |= x != y || y != z;
        }
    }

    pub(super) fn warnings<S: Space>(&self, depth: Depth, place: impl Fn(usize) -> String) -> Vec<String> {
        let mut warnings = Vec::new();
        let (off, first) = self.off;
        if off > 0 {
            let place = place(first);
            warnings.push(format!(
                "{off} texels are more than 10 % off unit length, the first one {place}; they were renormalised: \
                 is this a normal map?"
            ));
        }
        let (backward, first) = self.backward;
        if backward > 0 && S::NAME == Tangent::NAME {
            let place = place(first);
            warnings.push(format!(
                "{backward} texels point into the surface, the first one {place}; is this an object-space map?"
            ));
        }
        if !self.any_different {
            warnings.push("red, green and blue are equal everywhere: this looks like a height map".to_owned());
        }
        if depth == Depth::F32 && !self.any_negative && self.any_different && off > 0 {
            warnings.push("no component is negative: floats are taken as −1 … 1, these look like 0 … 1".to_owned());
        }
        warnings
    }
}
