//! The maps of the vase, texel by texel.

use super::layout::{Ground, Layout, Zone, circumference, map_length};
use super::profile::Profile;
use super::{CLAY, GLAZE, handle};
use crate::color::LinearRgb;
use crate::height::HeightMap;
use crate::sample::noise::{brush, mix, smoothstep, solid, surface_noise};
use crate::sample::turn;
use crate::{Error, Grid, MaterialMap, Result, Rgba8, par};

/// The maps of the vase, all of one size.
#[derive(Debug, Clone, PartialEq)]
pub struct VaseMaps {
    /// Engraved ornament, brush marks, the wheel's grooves and the grain of the clay.
    pub height: HeightMap,
    /// [`CLAY`] or [`GLAZE`].
    pub materials: MaterialMap,
    /// sRGB base colour, opaque.
    pub color: Grid<Rgba8>,
}

/// Fired clay, and the black glaze where it is thick.
pub(super) const CLAY_SRGB: [u8; 3] = [204, 122, 74];
pub(super) const GLAZE_SRGB: [u8; 3] = [30, 26, 25];
/// Clay with more iron; the slip where it is thin; the painters' added red.
const RED_CLAY_SRGB: [u8; 3] = [172, 86, 48];
const THIN_SRGB: [u8; 3] = [92, 48, 30];
const ADDED_RED_SRGB: [u8; 3] = [112, 38, 34];

// Heights in lengths of the vase (which is 2 high), before the map's scale is taken out.
const LOWEST: f32 = -0.020;
const HIGHEST: f32 = 0.026;
/// Thickness of the glaze: many times the real one, so that it catches the light.
const PAINT: f32 = 0.0085;
/// How far figures reserved in the black lie below painted clay.
const CARVED: f32 = 0.0055;
/// How deep lines are engraved.
const ENGRAVED: f32 = 0.0085;
/// Half the width of the slope at an edge of the glaze.
const BEVEL: f32 = 0.0042;
/// Distances are needed no further than this.
const REACH: f32 = 0.045;

/// The maps of the vase, `width` × ¾ `width` texels; u wraps without a seam.
///
/// Texels are about square on the widest part of the body. Heights of 0 … 1 come with the depth that makes them fit
/// [`super::mesh`]. The heights and materials are the same bits on every machine.
///
/// # Errors
/// [`Error::Parameter`] for a width below 64, [`Error::Size`] for one that is too large.
pub fn maps(width: u32) -> Result<VaseMaps> {
    if width < 64 {
        return Err(Error::parameter("map width", width, "at least 64 texels"));
    }
    let rows = (u64::from(width) * 3 / 4) as u32;
    let blank = Texel { height: 0.0, material: CLAY, color: Rgba8::default() };
    let mut texels = Grid::filled(width, rows, blank)?;
    let painter = Painter::new(width);
    par::for_each_row(texels.texels_mut(), width as usize, |y, row| {
        let s = (y as f32 + 0.5) / rows as f32 * map_length();
        painter.paint_row(s, row);
    });
    Ok(VaseMaps {
        height: HeightMap::new(texels.map(|t| t.height), (HIGHEST - LOWEST) / circumference())?,
        materials: texels.map(|t| t.material),
        color: texels.map(|t| t.color),
    })
}

#[derive(Debug, Clone, Copy)]
struct Texel {
    height: f32,
    material: u8,
    color: Rgba8,
}

/// Colours in linear light.
struct Palette {
    clay: LinearRgb,
    red_clay: LinearRgb,
    glaze: LinearRgb,
    thin: LinearRgb,
    added_red: LinearRgb,
}

struct Painter {
    layout: Layout,
    palette: Palette,
    /// Length of a texel on the vase.
    texel: f32,
    /// Length of the map's width on the vase.
    around_length: f32,
    bevel: f32,
    /// Sine and cosine of each column's place around the axis.
    around: Vec<[f32; 2]>,
}

/// What a whole row of the map has in common.
struct Ring<'a> {
    zone: &'a Zone,
    /// Signed distance to the black ground, positive inside.
    black: f32,
    /// Amount of added red.
    red: f32,
    /// Height of the raised rings.
    relief: f32,
    /// Part of the light that reaches it.
    light: f32,
}

/// A place on the map.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// 0 … 1 around.
    u: f32,
    /// Map length from the top.
    s: f32,
    /// Where it cuts the solid that the clay's grain is made of.
    solid: [f32; 3],
}

/// Accidents of the material.
struct Marks {
    /// Brush marks in the glaze, about [−1, 1].
    streaks: f32,
    /// Grain of bare clay, about [−1, 1].
    grain: f32,
    /// Amount of pits in bare clay.
    pits: f32,
    /// Amount of engraving.
    groove: f32,
}

/// The paint at one place, before it becomes height and colour.
struct Paint {
    /// Signed distance to the black, positive inside.
    black: f32,
    /// Signed distance to engraved lines, positive inside.
    engraving: f32,
    /// Amount of added red.
    red: f32,
    /// The clay around here is carved away.
    carved: bool,
}

impl Painter {
    fn new(width: u32) -> Self {
        let texel = circumference() / width as f32;
        let [clay, red_clay, glaze, thin, added_red] =
            [CLAY_SRGB, RED_CLAY_SRGB, GLAZE_SRGB, THIN_SRGB, ADDED_RED_SRGB].map(LinearRgb::from_srgb);
        Self {
            layout: Layout::new(REACH),
            palette: Palette { clay, red_clay, glaze, thin, added_red },
            texel,
            around_length: circumference(),
            bevel: BEVEL.max(texel),
            around: (0..width).map(|x| turn::sin_cos((f64::from(x) + 0.5) / f64::from(width)).into()).collect(),
        }
    }

    fn paint_row(&self, s: f32, row: &mut [Texel]) {
        let profile = Profile::get();
        let (point, strip) = (profile.at(s), (s - profile.length()) / handle::STRIP);
        // Light does not reach the bottom of the mouth.
        let depth = smoothstep(profile.end(1) + 0.02, profile.start(1) * 0.6, s);
        let zone = self.layout.zone(s);
        let ring = Ring {
            zone,
            black: self.layout.black(s),
            red: if zone.ground == Ground::Red {
                smoothstep(0.5, 1.5, (s - zone.from).min(zone.to - s) / self.texel)
            } else {
                0.0
            },
            relief: self.layout.relief(s),
            light: 1.0 - 0.93 * depth,
        };
        let width = row.len() as f32;
        for (x, (out, [sin, cos])) in row.iter_mut().zip(&self.around).enumerate() {
            let u = (x as f32 + 0.5) / width;
            *out = if strip < 0.0 {
                self.body(Place { u, s, solid: [point.radius * sin, point.y, point.radius * cos] }, &ring)
            } else {
                self.handle(Place { u, s, solid: [u, s, 10.0] }, strip)
            };
        }
    }

    /// A place on the vase itself.
    fn body(&self, at: Place, ring: &Ring) -> Texel {
        let mut paint = self.paint(at, ring);
        // A hand drew this: edges waver by half a hair.
        paint.black += 0.0011 * solid(at.solid, 0.025, 2, self.texel, 1);
        self.finish(at, &paint, ring.relief, ring.light)
    }

    fn handle(&self, at: Place, strip: f32) -> Texel {
        let paint = Paint { black: REACH, engraving: -REACH, red: 0.0, carved: false };
        self.finish(at, &paint, 0.016 * (handle::reeds(strip) - 0.8), 1.0)
    }

    fn paint(&self, at: Place, ring: &Ring) -> Paint {
        let Some(frieze) = &ring.zone.frieze else {
            return Paint { black: ring.black, engraving: -REACH, red: ring.red, carved: false };
        };
        let drawn = frieze.draw(at.u, ring.zone.to - at.s, REACH);
        if ring.zone.ground == Ground::Clay {
            let red = if drawn.red { smoothstep(0.0, self.texel, drawn.figure - 0.002) } else { 0.0 };
            // Lines are cut into the figure only.
            let engraving = drawn.engraving.min(drawn.figure - 0.5 * self.texel);
            Paint { black: ring.black.max(drawn.figure), engraving, red, carved: false }
        } else {
            Paint { black: ring.black.min(-drawn.figure), engraving: drawn.engraving, red: 0.0, carved: true }
        }
    }

    fn finish(&self, at: Place, paint: &Paint, relief: f32, light: f32) -> Texel {
        let of_size = |size, octaves, seed| solid(at.solid, size, octaves, self.texel, seed);
        let mut black = paint.black;
        if black > -0.02 {
            // Chips: rare, and likelier at edges, where the glaze lets go first.
            let wear = of_size(0.035, 4, 2) - 0.63 + 0.09 * smoothstep(0.012, 0.0, black.abs());
            black = black.min(-wear * 0.10);
        }
        // Engraved lines cut through the glaze to the clay.
        let ink = black.min(-paint.engraving);
        let coat = smoothstep(-self.bevel, self.bevel, black);
        let groove = smoothstep(-0.003 - self.texel, 0.004, paint.engraving);
        let bare = coat < 1.0 || groove > 0.0;
        let marks = Marks {
            streaks: if coat > 0.0 { brush(at.u, at.s / self.around_length, 5, 26.0, 4, 31) } else { 0.0 },
            grain: if bare { of_size(0.0085, 3, 3) } else { 0.0 },
            pits: if bare { smoothstep(0.26, 0.52, of_size(0.014, 2, 4)) } else { 0.0 },
            groove,
        };

        let cushion = smoothstep(0.0, 0.03, black);
        let (below, rough) = if paint.carved { (CARVED, 1.6) } else { (0.0, 0.8 + 0.8 * groove) };
        let wheel =
            surface_noise(at.u * 3.0, at.s * 70.0, 3, 41) * 0.7 + surface_noise(at.u * 5.0, at.s * 190.0, 5, 42) * 0.3;
        let clay = -below + rough * (0.0024 * marks.grain - 0.0022 * marks.pits);
        let glaze = PAINT * (0.72 + 0.28 * cushion) + 0.0016 * marks.streaks;
        let height = mix(clay, glaze, coat) - ENGRAVED * groove + 0.0012 * wheel + relief;

        let cover = (ink / self.texel + 0.5).clamp(0.0, 1.0);
        let color = self.color(at, paint.red, black, cover, &marks) * light;
        Texel {
            height: ((height - LOWEST) / (HIGHEST - LOWEST)).clamp(0.0, 1.0),
            material: if ink > 0.0 { GLAZE } else { CLAY },
            color: color.to_srgb(),
        }
    }

    fn color(&self, at: Place, red: f32, black: f32, cover: f32, marks: &Marks) -> LinearRgb {
        let p = &self.palette;
        let blend = |a: LinearRgb, b: LinearRgb, t: f32| a * (1.0 - t) + b * t;
        let cloud = solid(at.solid, 0.7, 4, self.texel, 5);
        // Dust and shade gather at the foot of the glaze and in the lines.
        let corner = smoothstep(0.012, 0.0, -black) * (1.0 - cover);
        let shade = 1.0 - 0.30 * corner - 0.22 * marks.pits - 0.18 * marks.groove;
        let clay = blend(p.clay, p.red_clay, (0.38 + 1.0 * cloud).clamp(0.0, 1.0));
        let clay = clay * (shade * (1.0 + 0.16 * marks.grain));
        // The slip turns brown where it ran thin: at its edges and between brush marks.
        let thin = 0.55 * smoothstep(0.007, 0.0, black) + 0.26 * smoothstep(0.10, 0.75, 0.5 * cloud - marks.streaks);
        let glaze = blend(p.glaze, p.thin, thin.clamp(0.0, 0.7));
        let glaze = blend(glaze, p.added_red * (1.0 + 0.3 * marks.streaks), red * 0.9);
        blend(clay, glaze, cover)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn u_wraps_without_a_seam() {
        let maps = maps(512).unwrap();
        let heights = maps.height.heights();
        let step = |a: u32, b: u32| {
            let rows = heights.rows().map(|r| f64::from((r[a as usize] - r[b as usize]).abs()));
            rows.sum::<f64>() / f64::from(heights.height())
        };
        let usual = (0..511).map(|x| step(x, x + 1)).fold(0.0, f64::max);
        let seam = step(511, 0);
        assert!(seam <= usual, "{seam} across the seam, at most {usual} elsewhere");
        let changes = |a: u32, b: u32| maps.materials.rows().filter(|r| r[a as usize] != r[b as usize]).count();
        let most = (0..511).map(|x| changes(x, x + 1)).max().unwrap();
        assert!(changes(511, 0) <= most);
    }

    #[test]
    fn heights_fill_the_range_without_touching_its_ends() {
        let maps = maps(512).unwrap();
        let (low, high) =
            maps.height.heights().texels().iter().fold((1.0f32, 0.0f32), |(l, h), &x| (l.min(x), h.max(x)));
        assert!(maps.height.heights().texels().iter().all(|h| h.is_finite()));
        // A height of exactly 0 or 1 would have been cut off.
        assert!(low > 0.0 && high < 1.0 && high - low > 0.5, "{low} … {high}");
        assert!(maps.height.depth() > 0.005 && maps.height.depth() < 0.03);
    }

    #[test]
    fn both_materials_have_their_share() {
        let maps = maps(256).unwrap();
        let count = |m: u8| maps.materials.texels().iter().filter(|&&x| x == m).count() as f32;
        let all = maps.materials.texels().len() as f32;
        assert_eq!(count(CLAY) + count(GLAZE), all);
        let share = count(GLAZE) / all;
        assert!((0.5..0.75).contains(&share), "{share}");
    }

    #[test]
    fn glaze_is_dark_and_lies_above_the_clay() {
        let maps = maps(512).unwrap();
        let mut sums = [[0.0f64; 3]; 2];
        // The main frieze: rows where no raised ring disturbs.
        for y in 150..210 {
            for x in 0..512 {
                let sum = &mut sums[usize::from(maps.materials[(x, y)])];
                let color = maps.color[(x, y)];
                assert_eq!(color.a, 255);
                sum[0] += 1.0;
                sum[1] += f64::from(maps.height.heights()[(x, y)]);
                sum[2] += f64::from(color.r);
            }
        }
        let [clay, glaze] = sums.map(|s| [s[1] / s[0], s[2] / s[0]]);
        assert!(glaze[0] > clay[0] + 0.05 && glaze[1] < 0.4 * clay[1], "{clay:?} {glaze:?}");
    }

    #[test]
    fn sizes_scale_and_small_ones_work() {
        for width in [64, 65, 67, 100] {
            let maps = maps(width).unwrap();
            assert_eq!(maps.height.heights().size(), (width, width * 3 / 4));
            assert_eq!(maps.materials.size(), maps.color.size());
        }
        assert!(maps(63).is_err() && maps(0).is_err() && maps(u32::MAX).is_err());
    }

    #[test]
    fn maps_are_the_same_every_time() {
        // FNV-1a over heights and materials, which no libm touches: the same figure on every machine.
        let sum = |maps: &VaseMaps| {
            let heights = maps.height.heights().texels().iter().flat_map(|h| h.to_bits().to_le_bytes());
            let bytes = heights.chain(maps.materials.texels().iter().copied());
            bytes.fold(0xcbf2_9ce4_8422_2325u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x100_0000_01b3))
        };
        let first = maps(512).unwrap();
        assert_eq!(first, maps(512).unwrap());
        assert_eq!(sum(&first), 0x1e9d_2514_2703_9af2);
    }
}
