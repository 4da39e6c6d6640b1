//! Maps as sixteen lanes read them: words, all levels one after the other.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16, u32x16};
use glam::Vec2;

use super::batch::Part;
use super::planes::Planes;
use crate::color::LinearRgb;
use crate::grid::{Edges, Grid};
use crate::light::Shade;
use crate::mip::MipChain;
use crate::normal::{Normal, Space, decode_u8, encode_u8};
use crate::raster::texture::TextureFilter;
use crate::simd::{Vec3x16, gather, gather_u16, log2, prefetch, recip, splat, splat3, three, two};

/// Words of a level in [`Texture::levels`]: where it begins, its width, its height.
const LEVEL_WORDS: u32 = 3;

/// Texels of `per` half-words or words each, all levels one after the other.
#[derive(Debug)]
pub(super) struct Texture {
    words: Vec<u32>,
    /// For each level: the number of its first texel, width, height.
    levels: Vec<u32>,
    format: Format,
    /// Logarithms of width and height where both are powers of two: most maps, and wrapping is then a matter of bits.
    powers: Option<[u32; 2]>,
    /// What the largest code of shades stands for.
    largest: f32,
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
    /// Three words, see [`shade_words`].
    Shade,
}

/// Where a pixel looks a map up.
#[derive(Clone, Copy)]
pub(super) struct Footprint<S: Simd> {
    pub(super) uv: [f32x16<S>; 2],
    pub(super) w: f32x16<S>,
    pub(super) inv_w: f32x16<S>,
    /// Changes of u/w, v/w and 1/w to the next pixel to the right and below; for mip levels.
    slopes: [Vec3x16<S>; 2],
}

/// Up to eight texels a pixel, and how much of each: two levels of four.
struct Taps<S: Simd> {
    texels: [u32x16<S>; 8],
    weights: [f32x16<S>; 8],
    count: usize,
}

impl<S: Simd> Taps<S> {
    #[inline(always)]
    fn push(&mut self, texel: u32x16<S>, weight: f32x16<S>) {
        self.texels[self.count] = texel;
        self.weights[self.count] = weight;
        self.count += 1;
    }
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
        Self {
            words: words.collect(),
            levels: layout(chain, filter),
            format: Format::Index,
            powers: powers(chain),
            largest: 1.0,
        }
    }

    /// Of material numbers, read as indices are.
    pub(super) fn of_materials(chain: &MipChain<u8>, filter: TextureFilter) -> Self {
        let levels = levels(chain, filter).iter().map(|level| level.map(|&m| u16::from(m))).collect();
        let chain = MipChain::from_levels(levels).expect("invariant: sizes are those of a chain");
        Self::of_indices(&chain, filter)
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
        Self { words, levels: layout(chain, filter), format, powers: powers(chain), largest: 1.0 }
    }

    /// Of colours from 0 to 1.
    pub(super) fn of_colors(chain: &MipChain<LinearRgb>, filter: TextureFilter) -> Self {
        let code = |v: f32| (v.clamp(0.0, 1.0) * 65_535.0 + 0.5) as u32;
        let texels = levels(chain, filter).iter().flat_map(Grid::texels);
        let words = texels.flat_map(|c| [code(c.r) | code(c.g) << 16, code(c.b)]).collect();
        Self { words, levels: layout(chain, filter), format: Format::Code16, powers: powers(chain), largest: 1.0 }
    }

    /// Of light.
    pub(super) fn of_shades(chain: &MipChain<Shade>, filter: TextureFilter) -> Self {
        let texels = || levels(chain, filter).iter().flat_map(Grid::texels);
        let largest = largest(texels());
        let words = texels().flat_map(|shade| shade_words(shade, largest)).collect();
        Self { words, levels: layout(chain, filter), format: Format::Shade, powers: powers(chain), largest }
    }

    /// Diffuse and specular light of texel number `at`.
    #[inline(always)]
    pub(super) fn shade<S: Simd>(&self, simd: S, at: u32x16<S>) -> [f32x16<S>; 6] {
        read_shade(simd, &self.words, at, self.largest)
    }

    /// The index at texel number `at`.
    #[inline(always)]
    pub(super) fn index<S: Simd>(&self, simd: S, at: u32x16<S>) -> u32x16<S> {
        gather_u16(simd, &self.words, at)
    }

    /// The three components at texel number `at`: from −1 to 1 if `signed`, from 0 to 1 otherwise. Not normalised.
    #[inline(always)]
    pub(super) fn vector<S: Simd>(&self, simd: S, at: u32x16<S>, signed: bool) -> [f32x16<S>; 3] {
        let (codes, most) = if self.format == Format::Code8 {
            let word = gather(simd, &self.words, at);
            ([word & 0xff, (word >> 8) & 0xff, (word >> 16) & 0xff], 255.0)
        } else {
            let first = at << 1;
            let (xy, z) = (gather(simd, &self.words, first), gather(simd, &self.words, first + 1));
            ([xy & 0xffff, xy >> 16, z], 65_535.0)
        };
        let (scale, offset) = if signed { (2.0 / most, -1.0) } else { (1.0 / most, 0.0) };
        let (scale, offset) = (f32x16::splat(simd, scale), f32x16::splat(simd, offset));
        three!(k => float(codes[k]).mul_add(scale, offset))
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
        if look.filter == TextureFilter::Nearest {
            return tap(self.nearest(simd, look, at), splat(simd, 1.0));
        }
        // Not inlined into every shader, and one place where a texel is read: eighteen of them for each shader and
        // instruction set take the compiler minutes.
        let taps = simd.vectorize(
            #[inline(always)]
            || self.filtered(simd, look, at),
        );
        for k in 0..taps.count {
            tap(taps.texels[k], taps.weights[k]);
        }
    }

    /// The texel under each pixel, its words sent for.
    #[inline(always)]
    pub(super) fn send_for<S: Simd>(&self, simd: S, look: &Look, at: &Footprint<S>) -> u32x16<S> {
        let texel = self.nearest(simd, look, at);
        let word = match self.format {
            Format::Index => texel >> 1,
            Format::Code8 => texel,
            Format::Code16 => texel << 1,
            Format::Shade => texel * 3,
        };
        prefetch(&self.words, word);
        texel
    }

    /// The texel under each pixel.
    #[inline(always)]
    fn nearest<S: Simd>(&self, simd: S, look: &Look, at: &Footprint<S>) -> u32x16<S> {
        let repeat = [look.repeat.x, look.repeat.y];
        if let (Some(powers), Edges::Wrap) = (self.powers, look.edges) {
            let [x, y] = two!(k => {
                let side = 1u32 << powers[k];
                let whole = (at.uv[k] * (repeat[k] * side as f32)).floor().to_int::<i32x16<S>>();
                whole.bitcast::<u32x16<S>>() & (side - 1)
            });
            return (y << powers[0]) | x;
        }
        let base = two!(k => splat(simd, self.levels[k + 1] as f32));
        let [x, y] = two!(k => {
            let place = place_in_copy(simd, at.uv[k], repeat[k], look.edges);
            resolve(simd, (place * base[k]).to_int(), base[k], look.edges)
        });
        texel(u32x16::splat(simd, 0), base[0], x, y)
    }

    /// The texels about each pixel, of one level or of two.
    #[inline(always)]
    fn filtered<S: Simd>(&self, simd: S, look: &Look, at: &Footprint<S>) -> Taps<S> {
        let mut taps = Taps { texels: [u32x16::splat(simd, 0); 8], weights: [splat(simd, 0.0); 8], count: 0 };
        let repeat = [look.repeat.x, look.repeat.y];
        if let (Some(powers), Edges::Wrap, TextureFilter::Bilinear) = (self.powers, look.edges, look.filter) {
            bilinear_wrapped(simd, at.uv, repeat, powers, &mut taps);
            return taps;
        }
        let place = two!(k => place_in_copy(simd, at.uv[k], repeat[k], look.edges));
        let base = two!(k => splat(simd, self.levels[k + 1] as f32));
        if look.filter == TextureFilter::Bilinear {
            bilinear(simd, place, (u32x16::splat(simd, 0), base), look.edges, splat(simd, 1.0), &mut taps);
            return taps;
        }
        let last = (self.levels.len() as u32 / LEVEL_WORDS - 1) as f32;
        let lod = level_of_detail(simd, at, two!(k => base[k] * repeat[k]));
        let lod = lod.max(splat(simd, 0.0)).min(splat(simd, last));
        let level = lod.floor();
        let mix = lod - level;
        let whole = level.to_int::<u32x16<S>>();
        bilinear(simd, place, self.level(simd, whole), look.edges, 1.0 - mix, &mut taps);
        if mix.simd_gt(splat(simd, 0.0)).any_true() {
            let next = (whole + 1).min(u32x16::splat(simd, last as u32));
            bilinear(simd, place, self.level(simd, next), look.edges, mix, &mut taps);
        }
        taps
    }

    /// First texel and size of a level.
    #[inline(always)]
    fn level<S: Simd>(&self, simd: S, level: u32x16<S>) -> (u32x16<S>, [f32x16<S>; 2]) {
        let [first, width, height] = three!(k => gather(simd, &self.levels, level * LEVEL_WORDS + k as u32));
        (first, [float(width), float(height)])
    }
}

/// The largest component of any of some shades.
pub(super) fn largest<'a>(shades: impl Iterator<Item = &'a Shade>) -> f32 {
    let components = |s: &Shade| [s.diffuse, s.specular].map(|c| c.r.max(c.g).max(c.b));
    shades.flat_map(components).fold(1e-6, f32::max)
}

/// A shade as lanes read it, 16 bits of `largest` a component: diffuse red and green, diffuse blue and specular red, specular
/// green and blue.
pub(super) fn shade_words(shade: &Shade, largest: f32) -> [u32; 3] {
    let code = |v: f32| (v.max(0.0) / largest * 65_535.0 + 0.5) as u32;
    let (d, s) = (shade.diffuse, shade.specular);
    [[d.r, d.g], [d.b, s.r], [s.g, s.b]].map(|[low, high]| code(low) | code(high) << 16)
}

/// Shade number `at` of a table of them: diffuse red, green and blue, then specular.
#[inline(always)]
pub(super) fn read_shade<S: Simd>(simd: S, words: &[u32], at: u32x16<S>, largest: f32) -> [f32x16<S>; 6] {
    let first = at * 3;
    let [a, b, c] = three!(k => gather(simd, words, first + k as u32));
    let scale = largest / 65_535.0;
    let low = three!(k => float([a, b, c][k] & 0xffff) * scale);
    let high = three!(k => float([a, b, c][k] >> 16) * scale);
    [low[0], high[0], low[1], high[1], low[2], high[2]]
}

/// Whole numbers below 2³¹ as floats.
#[inline(always)]
pub(super) fn float<S: Simd>(v: u32x16<S>) -> f32x16<S> {
    v.bitcast::<i32x16<S>>().to_float()
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

fn powers<T>(chain: &MipChain<T>) -> Option<[u32; 2]> {
    let (width, height) = chain.base().size();
    (width.is_power_of_two() && height.is_power_of_two()).then(|| [width, height].map(u32::trailing_zeros))
}

/// The four texels about each pixel, of a map that wraps after powers of two.
#[inline(always)]
fn bilinear_wrapped<S: Simd>(simd: S, uv: [f32x16<S>; 2], repeat: [f32; 2], powers: [u32; 2], taps: &mut Taps<S>) {
    let sides = powers.map(|p| 1u32 << p);
    let p = two!(k => (uv[k] * (repeat[k] * sides[k] as f32)) - 0.5);
    let corner = two!(k => p[k].floor());
    let f = two!(k => p[k] - corner[k]);
    let low = two!(k => corner[k].to_int::<i32x16<S>>().bitcast::<u32x16<S>>());
    let xs = two!(i => (low[0] + i as u32) & (sides[0] - 1));
    let ys = two!(i => ((low[1] + i as u32) & (sides[1] - 1)) << powers[0]);
    let (one, mut weights) = (splat(simd, 1.0), [f; 2]);
    weights[0] = two!(k => one - f[k]);
    for k in 0..4 {
        let (i, j) = (k % 2, k / 2);
        taps.push(ys[j] | xs[i], weights[i][0] * weights[j][1]);
    }
}

/// Where coordinate `t` lies in its copy of the map, 0 … 1: as [`crate::raster::texture`] has it.
#[inline(always)]
fn place_in_copy<S: Simd>(simd: S, t: f32x16<S>, repeat: f32, edges: Edges) -> f32x16<S> {
    let (zero, one) = (splat(simd, 0.0), splat(simd, 1.0));
    let square = match edges {
        Edges::Wrap => t,
        Edges::Clamp => t.max(zero).min(one),
        Edges::Mirror => 1.0 - (1.0 - (t - (t * 0.5).floor() * 2.0)).abs(),
    };
    let inside = square * repeat;
    let mut inside = inside - inside.floor();
    if edges != Edges::Wrap {
        // The far rim is the end of the last copy, not the start of one more.
        let rim = inside.simd_eq(zero) & square.simd_gt(zero);
        inside = rim.select(one, inside);
    }
    // What is no number any more lies at 0: max gives the other one.
    inside.max_precise(zero).min(one)
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
    taps: &mut Taps<S>,
) {
    // Texel centres lie at (i + ½) / size.
    let p = two!(k => place[k] * size[k] - 0.5);
    let corner = two!(k => p[k].floor());
    let f = two!(k => p[k] - corner[k]);
    let low = two!(k => corner[k].to_int::<i32x16<S>>());
    let ends = two!(k => two!(i => resolve(simd, low[k] + i as i32, size[k], edges)));
    let weights = [[1.0 - f[0], f[0]], [(1.0 - f[1]) * share, f[1] * share]];
    for k in 0..4 {
        let (i, j) = (k % 2, k / 2);
        taps.push(texel(first, size[0], ends[0][i], ends[1][j]), weights[0][i] * weights[1][j]);
    }
}

/// log2 of the longer side of the pixel's footprint in texels of the full-size level.
#[inline(always)]
fn level_of_detail<S: Simd>(simd: S, at: &Footprint<S>, size: [f32x16<S>; 2]) -> f32x16<S> {
    // d(a / b) = (da − a / b · db) / b, at the pixel itself.
    let change = two!(i => two!(k => (at.slopes[i][k] - at.uv[k] * at.slopes[i][2]) * at.w * size[k]));
    let [dx, dy] = change;
    let longest = dx[0].mul_add(dx[0], dx[1] * dx[1]).max(dy[0].mul_add(dy[0], dy[1] * dy[1]));
    let longest = longest.max(splat(simd, 1e-30)).min(splat(simd, 1e30));
    log2(simd, longest) * 0.5
}

/// The footprints of a block, put together part by part.
pub(super) struct Footprints<S: Simd> {
    /// u/w, v/w and 1/w.
    at: Vec3x16<S>,
    slopes: [Vec3x16<S>; 2],
}

impl<S: Simd> Footprints<S> {
    #[inline(always)]
    pub(super) fn new(simd: S) -> Self {
        Self { at: splat3(simd, [0.0; 3]), slopes: [splat3(simd, [0.0; 3]); 2] }
    }

    /// Enters a part, by its first three planes: u/w, v/w and 1/w. Slopes are only wanted `with_levels`.
    #[inline(always)]
    pub(super) fn add<const N: usize, U>(
        &mut self,
        simd: S,
        planes: &Planes<N>,
        part: &Part<'_, S, U>,
        with_levels: bool,
    ) {
        planes.enter(simd, part, 0, &mut self.at);
        if with_levels {
            for k in 0..3 {
                let plane = planes.get(k);
                self.slopes[0][k] = part.lanes.select(splat(simd, plane.dx), self.slopes[0][k]);
                self.slopes[1][k] = part.lanes.select(splat(simd, plane.dy), self.slopes[1][k]);
            }
        }
    }

    #[inline(always)]
    pub(super) fn get(self) -> Footprint<S> {
        let [u, v, inv_w] = self.at;
        let w = recip(inv_w);
        Footprint { uv: [u * w, v * w], w, inv_w, slopes: self.slopes }
    }
}
