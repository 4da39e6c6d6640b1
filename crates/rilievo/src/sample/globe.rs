//! A map of a world that is not ours.

use super::covering::{Covering, blend};
use super::noise::{smoothstep, solid};
use super::turn;
use crate::color::LinearRgb;
use crate::{Error, Result};

/// From the sea to the top of what 1 stands for, as a share of the equator.
const DEPTH: f32 = 0.02;
/// How much of the noise is sea.
const SEA: f32 = 0.03;

/// A map of a made-up world in equirectangular projection, `width` × ½ `width` texels: flat seas, continents with
/// mountains, ice at the poles. It is made of noise in space, so that u wraps and the poles have no seam. The heights are the
/// same bits on every machine.
///
/// # Errors
/// [`Error::Parameter`] for a width below 64, [`Error::Size`] for one that is too large.
///
/// ```
/// let world = rilievo::sample::globe(128)?;
/// assert_eq!((world.height.heights().size(), world.color.size()), ((128, 64), (128, 64)));
/// # Ok::<(), rilievo::Error>(())
/// ```
pub fn globe(width: u32) -> Result<Covering> {
    if width < 64 {
        return Err(Error::parameter("map width", width, "at least 64 texels"));
    }
    let [abyss, shelf, green, dry, rock, ice] =
        [[16, 38, 84], [48, 104, 146], [64, 102, 48], [178, 148, 96], [120, 100, 84], [236, 240, 244]]
            .map(LinearRgb::from_srgb);
    let texel = std::f32::consts::TAU / width as f32;
    Covering::paint((width, width / 2), DEPTH, |u, v| {
        let ((sin_u, cos_u), (sin_v, cos_v)) = (turn::sin_cos(u.into()), turn::sin_cos(f64::from(v) * 0.5));
        let p = [sin_v * sin_u, cos_v, sin_v * cos_u];
        let land = solid(p, 0.9, 8, texel, 21) - SEA;
        // Ranges stand where a second noise crosses zero.
        let ridge = (1.0 - 3.0 * solid(p, 0.5, 6, texel, 22).abs()).max(0.0);
        let inland = smoothstep(0.0, 0.12, land);
        let height = if land > 0.0 { inland * (0.10 + 0.35 * land + 0.55 * ridge * ridge) } else { 0.0 };
        let latitude = cos_v.abs() + 0.15 * solid(p, 0.4, 4, texel, 23);
        let warm = smoothstep(0.75, 0.45, latitude) * smoothstep(0.05, 0.25, latitude);
        let ground = blend(green, dry, (warm * (0.55 + 1.2 * solid(p, 0.6, 5, texel, 24))).clamp(0.0, 1.0));
        let ground = blend(ground, rock, smoothstep(0.25, 0.5, height));
        let sea = blend(abyss, shelf, smoothstep(-0.22, 0.0, land));
        let open = blend(sea, ground, smoothstep(-0.004, 0.004, land));
        (height, blend(open, ice, smoothstep(0.84, 0.92, latitude + 0.35 * height)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_world_has_seas_and_land_and_closes_around() {
        let world = globe(256).unwrap();
        let heights = world.height.heights();
        let sea = heights.texels().iter().filter(|&&h| h == 0.0).count() as f32 / heights.texels().len() as f32;
        assert!((0.35..0.75).contains(&sea), "{sea}");
        let step = |a: u32, b: u32| (0..128).map(|y| (heights[(a, y)] - heights[(b, y)]).abs()).sum::<f32>();
        assert!(step(255, 0) <= (0..255).map(|x| step(x, x + 1)).fold(0.0, f32::max));
        // Around a pole everything is near everything.
        let row = heights.row(0);
        let (low, high) = row.iter().fold((1.0f32, 0.0f32), |(l, h), &x| (l.min(x), h.max(x)));
        assert!(high - low < 0.25, "{low} {high}");
        assert!(globe(63).is_err());
    }
}
