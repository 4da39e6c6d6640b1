//! 16-bit heights to packed 8-bit normals, into memory that is there.

use fearless_simd::{Level, dispatch};

use super::lanes::{Slopes, code};
use super::plane::PlaneFit;
use super::{Filter, MAX_HEIGHT};
use crate::error::{Error, Result};
use crate::grid::{Edges, Grid};
use crate::par;

/// The height of full white in 16 bits.
const WHITE: f32 = 65_535.0;

/// Normals of 16-bit `heights` as 8-bit colours, red = x, green = y (up), blue = z, alpha = 255, into `out`.
///
/// What [`super::to_normals`] and [`crate::normal::encode_u8`] do with heights in steps of 1/65 535, in one pass and
/// without memory of its own, for tools that convert whole folders. Differences of heights are exact integers here.
///
/// - **Units:** `depth` is how far white (65 535) lies above black, as a fraction of the map's width, as in
///   [`super::HeightMap`].
/// - **Space:** tangent; +Y up the picture.
/// - **Determinism:** class A. To the bit the codes of
///   `to_normals(&HeightMap::new(heights.map(|&h| h.into()), depth / 65_535.0)?, …)` (`tests/height_packed.rs`). Against
///   heights that were first scaled to 0 … 1 and rounded to f32, codes differ by one at most in rare texels.
///
/// # Errors
/// [`Error::SizeMismatch`] if `out` is not as large as `heights`; [`Error::Parameter`] for a depth that is not finite,
/// or a relief beyond [`MAX_HEIGHT`] texels.
///
/// ```
/// use rilievo::height::{Filter, pack_normals};
/// use rilievo::{Edges, Grid};
///
/// let flat = Grid::filled(8, 4, 1234u16)?;
/// let mut out = Grid::filled(8, 4, [0; 4])?;
/// pack_normals(&flat, 0.1, Filter::Sobel, Edges::Wrap, &mut out)?;
/// assert!(out.texels().iter().all(|&c| c == [128, 128, 255, 255]));
/// # Ok::<(), rilievo::Error>(())
/// ```
pub fn pack_normals(
    heights: &Grid<u16>,
    depth: f32,
    filter: Filter,
    edges: Edges,
    out: &mut Grid<[u8; 4]>,
) -> Result<()> {
    pack_with(Level::new(), heights, depth, filter, edges, out)
}

fn pack_with(
    level: Level,
    heights: &Grid<u16>,
    depth: f32,
    filter: Filter,
    edges: Edges,
    out: &mut Grid<[u8; 4]>,
) -> Result<()> {
    heights.expect_same_size("the map of packed normals", out)?;
    let (width, height) = heights.size();
    if !depth.is_finite() || depth.abs() > MAX_HEIGHT / width as f32 {
        return Err(Error::parameter("depth", depth, format_args!("at most {MAX_HEIGHT:e} texels of relief")));
    }
    let fit = PlaneFit::of(heights, depth / WHITE, filter, edges);
    let slopes = Slopes::new(filter, fit.scale());
    par::for_each_row(out.texels_mut(), width as usize, |y, row| {
        // Clamped rows have no neighbours on one side: another filter.
        let clamped = edges == Edges::Clamp && (y == 0 || y + 1 == height as usize);
        let done = slopes.filter(|_| !clamped).is_some_and(|slopes| {
            let at = |y: i64| heights.row(edges.resolve(y, height));
            let rows = [at(y as i64 - 1), at(y as i64), at(y as i64 + 1)];
            dispatch!(level, simd => slopes.interior(simd, rows, row))
        });
        let put = |x: usize, [right, up]: [f32; 2]| row[x] = code(right, up);
        if done { fit.ends(y, put) } else { fit.row(y, put) }
    });
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::Random;

    const FILTERS: [Filter; 4] = [Filter::Plane4, Filter::Plane8, Filter::Sobel, Filter::Scharr];

    #[test]
    fn every_instruction_set_gives_the_same_codes() {
        let mut random = Random::new(7);
        let heights = Grid::from_fn(301, 40, |x, _| (random.unit() * 900.0) as u16 + 5 * x as u16).unwrap();
        for filter in FILTERS {
            for depth in [0.001, 0.05, -0.7, 20.0] {
                let packed = |level| {
                    let mut out = Grid::filled(301, 40, [0; 4]).unwrap();
                    pack_with(level, &heights, depth, filter, Edges::Mirror, &mut out).unwrap();
                    out
                };
                assert!(packed(Level::new()) == packed(Level::baseline()), "{filter:?} {depth}");
                #[cfg(target_arch = "x86_64")]
                if let Some(avx2) = Level::new().as_avx2() {
                    assert!(packed(Level::Avx2(avx2)) == packed(Level::baseline()), "{filter:?} {depth}");
                }
            }
        }
    }

    #[test]
    fn refuses_other_sizes_and_impossible_depths() {
        let heights = Grid::filled(4, 4, 0u16).unwrap();
        let pack = |depth, size| {
            let mut out = Grid::filled(size, 4, [0; 4]).unwrap();
            pack_normals(&heights, depth, Filter::Plane4, Edges::Wrap, &mut out)
        };
        assert!(matches!(pack(0.1, 5), Err(Error::SizeMismatch { .. })));
        for depth in [f32::NAN, f32::INFINITY, 1e18] {
            assert!(matches!(pack(depth, 4), Err(Error::Parameter { name: "depth", .. })), "{depth}");
        }
        assert!(pack(2e17, 4).is_ok());
    }
}
