//! Maps as sixteen lanes read them: words, all levels one after the other.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16, u32x16};
use glam::Vec2;

use crate::color::LinearRgb;
use crate::grid::{Edges, Grid};
use crate::mip::MipChain;
use crate::normal::{Normal, Space, decode_u8, encode_u8};
use crate::raster::texture::TextureFilter;
use crate::simd::{gather, gather_u16, log2, recip};

/// Words of a level in [`Texture::levels`]: where it begins, its width, its height.
const LEVEL_WORDS: u32 = 3;

/// Texels of `per` half-words or words each, all levels one after the other.
#[derive(Debug)]
pub(super) struct Texture {
    words: Vec<u32>,
    /// For each level: the number of its first texel, width, height.
    levels: Vec<u32>,
    format: Format,
}

/// What the words of a texel are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    /// Half a word: an index.
    Index,
    /// A word of bytes: a normal's 8-bit code.
    Code8,
    /// Two words of 16 bits each: x, y, z of a normal, or r, g, b of a colour, and nothing.
    Code16,
}

/// Where a pixel looks a map up: texture coordinates, and their change to the next pixel to the right and below.
#[derive(Clone, Copy)]
pub(super) struct Footprint<S: Simd> {
    pub(super) uv: [f32x16<S>; 2],
    pub(super) dx: [f32x16<S>; 2],
    pub(super) dy: [f32x16<S>; 2],
}

/// How a map is looked up.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look {
    pub(super) filter: TextureFilter,
    pub(super) edges: Edges,
    pub(super) repeat: Vec2,
}

impl Texture {
    /// Of indices.
    pub(super) fn of_indices(chain: &MipChain<u16>, filter: TextureFilter) -> Self {
        let texels = levels(chain, filter).iter().flat_map(Grid::texels);
        let halves: Vec<u16> = texels.copied().collect();
        let words = halves.chunks(2).map(|pair| u32::from(pair[0]) | u32::from(*pair.last().unwrap_or(&0)) << 16);
        Self { words: words.collect(), levels: layout(chain, filter), format: Format::Index }
    }

    /// Of normals: 8-bit codes where they are exact and no smaller level is looked at, 16 bits a component elsewhere.
    pub(super) fn of_normals<S: Space>(chain: &MipChain<Normal<S>>, filter: TextureFilter) -> Self {
        let levels_in_use = levels(chain, filter);
        let is_code = |n: &Normal<S>| decode_u8::<S>(encode_u8(*n)) == *n;
        let (words, format) = if levels_in_use.len() == 1 && chain.base().texels().iter().all(is_code) {
            let code = |n: &Normal<S>| {
                let [x, y, z] = encode_u8(*n);
                u32::from_le_bytes([x, y, z, 0])
            };
            (chain.base().texels().iter().map(code).collect(), Format::Code8)
        } else {
            let code = |v: f32| ((v + 1.0) * (0.5 * 65_535.0) + 0.5) as u32;
            let texels = levels_in_use.iter().flat_map(Grid::texels).map(|n| n.vec());
            (texels.flat_map(|n| [code(n.x) | code(n.y) << 16, code(n.z)]).collect(), Format::Code16)
        };
        Self { words, levels: layout(chain, filter), format }
    }

    /// Of colours from 0 to 1.
    pub(super) fn of_colors(chain: &MipChain<LinearRgb>, filter: TextureFilter) -> Self {
        let code = |v: f32| (v.clamp(0.0, 1.0) * 65_535.0 + 0.5) as u32;
        let texels = levels(chain, filter).iter().flat_map(Grid::texels);
        let words = texels.flat_map(|c| [code(c.r) | code(c.g) << 16, code(c.b)]).collect();
        Self { words, levels: layout(chain, filter), format: Format::Code16 }
    }

    /// The index at texel number `at`.
    #[inline(always)]
    pub(super) fn index<S: Simd>(&self, simd: S, at: u32x16<S>) -> u32x16<S> {
        gather_u16(simd, &self.words, at)
    }

    /// The three components at texel number `at`: from −1 to 1 if `signed`, from 0 to 1 otherwise. Not normalised.
    #[inline(always)]
    pub(super) fn vector<S: Simd>(&self, simd: S, at: u32x16<S>, signed: bool) -> [f32x16<S>; 3] {
        let (codes, most) = match self.format {
            Format::Code8 => {
                let word = gather(simd, &self.words, at);
                ([word & 0xff, (word >> 8) & 0xff, (word >> 16) & 0xff], 255.0)
            }
            _ => {
                let [xy, z] = [0, 1].map(|k| gather(simd, &self.words, (at << 1) + k));
                ([xy & 0xffff, xy >> 16, z], 65_535.0)
            }
        };
        let (scale, offset) = if signed { (2.0 / most, -1.0) } else { (1.0 / most, 0.0) };
        let (scale, offset) = (f32x16::splat(simd, scale), f32x16::splat(simd, offset));
        codes.map(|c| c.bitcast::<i32x16<S>>().to_float::<f32x16<S>>().mul_add(scale, offset))
    }

    /// Calls `tap(texel number, weight)` for each texel that a pixel sees; the weights sum to 1.
    #[inline(always)]
    pub(super) fn taps<S: Simd>(
        &self,
        simd: S,
        look: &Look,
        at: &Footprint<S>,
        mut tap: impl FnMut(u32x16<S>, f32x16<S>),
    ) {
        let splat = |v| f32x16::splat(simd, v);
        let repeat = [look.repeat.x, look.repeat.y];
        let place = [0, 1].map(|k| place_in_copy(simd, at.uv[k], repeat[k], look.edges));
        let base = [self.levels[1] as f32, self.levels[2] as f32].map(splat);
        let first = u32x16::splat(simd, 0);
        match look.filter {
            TextureFilter::Nearest => {
                let [x, y] = [0, 1].map(|k| resolve(simd, (place[k] * base[k]).to_int(), base[k], look.edges));
                tap(texel(first, base[0], x, y), splat(1.0));
            }
            TextureFilter::Bilinear => bilinear(simd, place, (first, base), look.edges, splat(1.0), &mut tap),
            TextureFilter::Trilinear => {
                let last = (self.levels.len() as u32 / LEVEL_WORDS - 1) as f32;
                let lod = level_of_detail(simd, at, [0, 1].map(|k| base[k] * repeat[k]));
                let lod = lod.max(splat(0.0)).min(splat(last));
                let level = lod.floor();
                let mix = lod - level;
                let whole = level.to_int::<u32x16<S>>();
                bilinear(simd, place, self.level(simd, whole), look.edges, 1.0 - mix, &mut tap);
                if mix.simd_gt(splat(0.0)).any_true() {
                    let next = (whole + 1).min(u32x16::splat(simd, last as u32));
                    bilinear(simd, place, self.level(simd, next), look.edges, mix, &mut tap);
                }
            }
        }
    }

    /// First texel and size of a level.
    #[inline(always)]
    fn level<S: Simd>(&self, simd: S, level: u32x16<S>) -> (u32x16<S>, [f32x16<S>; 2]) {
        let word = |k: u32| gather(simd, &self.levels, level * LEVEL_WORDS + k);
        let float = |w: u32x16<S>| w.bitcast::<i32x16<S>>().to_float::<f32x16<S>>();
        (word(0), [float(word(1)), float(word(2))])
    }
}

/// The levels that a filter looks at.
fn levels<T>(chain: &MipChain<T>, filter: TextureFilter) -> &[Grid<T>] {
    if filter == TextureFilter::Trilinear { chain.levels() } else { &chain.levels()[..1] }
}

fn layout<T>(chain: &MipChain<T>, filter: TextureFilter) -> Vec<u32> {
    let mut first = 0;
    let level = |level: &Grid<T>| {
        let words = [first, level.width(), level.height()];
        first += level.width() * level.height();
        words
    };
    levels(chain, filter).iter().flat_map(level).collect()
}

/// Where coordinate `t` lies in its copy of the map, 0 … 1: as [`crate::raster::texture`] has it.
#[inline(always)]
fn place_in_copy<S: Simd>(simd: S, t: f32x16<S>, repeat: f32, edges: Edges) -> f32x16<S> {
    let splat = |v| f32x16::splat(simd, v);
    let fraction = |t: f32x16<S>| t - t.floor();
    let square = match edges {
        Edges::Wrap => t,
        Edges::Clamp => t.max(splat(0.0)).min(splat(1.0)),
        Edges::Mirror => 1.0 - (1.0 - (t - (t * 0.5).floor() * 2.0)).abs(),
    };
    let mut inside = fraction(square * repeat);
    if edges != Edges::Wrap {
        // The far rim is the end of the last copy, not the start of one more.
        let rim = inside.simd_eq(splat(0.0)) & square.simd_gt(splat(0.0));
        inside = rim.select(splat(1.0), inside);
    }
    // What is no number any more lies at 0: max gives the other one.
    inside.max_precise(splat(0.0)).min(splat(1.0))
}

/// Texel numbers that are at most one beyond a side of length `size`, within it.
#[inline(always)]
fn resolve<S: Simd>(simd: S, i: i32x16<S>, size: f32x16<S>, edges: Edges) -> i32x16<S> {
    let (zero, size) = (i32x16::splat(simd, 0), size.to_int::<i32x16<S>>());
    if edges == Edges::Wrap {
        let i = i.simd_lt(zero).select(i + size, i);
        return i.simd_ge(size).select(i - size, i);
    }
    // One beyond the border is the border, mirrored or clamped.
    i.max(zero).min(size - 1)
}

/// The number of a texel.
#[inline(always)]
fn texel<S: Simd>(first: u32x16<S>, width: f32x16<S>, x: i32x16<S>, y: i32x16<S>) -> u32x16<S> {
    let width = width.to_int::<i32x16<S>>();
    (y * width + x).bitcast::<u32x16<S>>() + first
}

#[inline(always)]
fn bilinear<S: Simd>(
    simd: S,
    place: [f32x16<S>; 2],
    (first, size): (u32x16<S>, [f32x16<S>; 2]),
    edges: Edges,
    share: f32x16<S>,
    tap: &mut impl FnMut(u32x16<S>, f32x16<S>),
) {
    // Texel centres lie at (i + ½) / size.
    let p = [0, 1].map(|k| place[k] * size[k] - 0.5);
    let corner = p.map(|v| v.floor());
    let f = [0, 1].map(|k| p[k] - corner[k]);
    let low = corner.map(|v| v.to_int::<i32x16<S>>());
    let ends = [0, 1].map(|k| [low[k], low[k] + 1].map(|i| resolve(simd, i, size[k], edges)));
    let weights = [[1.0 - f[0], f[0]], [(1.0 - f[1]) * share, f[1] * share]];
    for k in 0..4 {
        let (i, j) = (k % 2, k / 2);
        tap(texel(first, size[0], ends[0][i], ends[1][j]), weights[0][i] * weights[1][j]);
    }
}

/// log2 of the longer side of the pixel's footprint in texels of the full-size level.
#[inline(always)]
fn level_of_detail<S: Simd>(simd: S, at: &Footprint<S>, size: [f32x16<S>; 2]) -> f32x16<S> {
    let squared = |d: [f32x16<S>; 2]| {
        let [u, v] = [d[0] * size[0], d[1] * size[1]];
        u.mul_add(u, v * v)
    };
    let longest = squared(at.dx).max(squared(at.dy)).max(f32x16::splat(simd, 1e-30)).min(f32x16::splat(simd, 1e30));
    log2(simd, longest) * 0.5
}

/// A footprint from planes: u/w, v/w and 1/w, as attributes of that order from `first` on.
#[inline(always)]
pub(super) fn footprint<S: Simd, const N: usize>(
    simd: S,
    planes: &super::planes::Planes<N>,
    first: usize,
    x: f32x16<S>,
    y: f32x16<S>,
) -> (Footprint<S>, f32x16<S>) {
    let [u, v, w] = [0, 1, 2].map(|i| planes.get(first + i));
    let inv_w = w.at(simd, x, y);
    let depth = recip(inv_w);
    let uv = [u, v].map(|p| p.at(simd, x, y) * depth);
    // d(a / b) = (da − a / b · db) / b, at the pixel itself.
    let change = |k: usize, d: f32, dw: f32| (f32x16::splat(simd, d) - uv[k] * dw) * depth;
    let footprint = Footprint {
        uv,
        dx: [change(0, u.dx, w.dx), change(1, v.dx, w.dx)],
        dy: [change(0, u.dy, w.dy), change(1, v.dy, w.dy)],
    };
    (footprint, depth)
}
