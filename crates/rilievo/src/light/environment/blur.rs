//! Surroundings as rough mirrors show them.

use glam::{Vec2, Vec3};

use super::{Level, octahedral};
use crate::color::LinearRgb;
use crate::error::Result;

/// Sides of the blurred copies, for roughness ¼, ½, ¾ and 1: GGX of roughness ¼ is 7° wide, and a texel of 64 is 3°.
const SIDES: [u32; 4] = [64, 32, 32, 32];

/// The sharp copy and its blurred ones.
pub(super) fn levels(sharp: Level) -> Result<Vec<Level>> {
    let mut levels = vec![sharp];
    for (i, side) in SIDES.into_iter().enumerate() {
        let roughness = (i + 1) as f32 / SIDES.len() as f32;
        let blurred = blur(&levels[0], side, roughness * roughness)?;
        levels.push(blurred);
    }
    Ok(levels)
}

/// A copy of `side` texels, weighted by GGX of `alpha` seen from straight ahead (n = v = r).
///
/// The chance of a direction l is D(n·h) / 4, and it counts by its cosine n·l (Karis 2013).
fn blur(sharp: &Level, side: u32, alpha: f32) -> Result<Level> {
    let sources = sources(sharp, side);
    Level::octahedral(side, |n| {
        let (mut sum, mut total) = (LinearRgb::BLACK, 0.0);
        for source in &sources {
            let cosine = n.dot(source.direction);
            if cosine > 0.0 {
                // cos² of half the angle between n and l.
                let nh2 = (1.0 + cosine) * 0.5;
                let d = alpha / ((1.0 - nh2) + alpha * alpha * nh2);
                let weight = d * d * cosine * source.solid_angle;
                sum += source.color * weight;
                total += weight;
            }
        }
        sum * (1.0 / total)
    })
}

/// A patch of the surroundings.
struct Source {
    direction: Vec3,
    color: LinearRgb,
    solid_angle: f32,
}

/// The sharp copy averaged to `side` texels, a power of two not above its own.
fn sources(sharp: &Level, side: u32) -> Vec<Source> {
    let step = sharp.width / side;
    let to_unit = |i: f32| i / side as f32 * 2.0 - 1.0;
    let mut sources = Vec::with_capacity((side * side) as usize);
    for row in 0..side {
        for column in 0..side {
            let (mut sum, mut total) = (LinearRgb::BLACK, 0.0);
            for y in row * step..(row + 1) * step {
                for x in column * step..(column + 1) * step {
                    let place = |i: u32| to_unit((i as f32 + 0.5) / step as f32);
                    // A texel's share of the sphere falls with the cube of its distance on the octahedron.
                    let p = octahedral::to_direction(Vec2::new(place(x), -place(y)));
                    let area = p.length().powi(-3);
                    sum += sharp.texels[((y + 1) * sharp.stride() + x + 1) as usize] * area;
                    total += area;
                }
            }
            let at = |i: u32| to_unit(i as f32 + 0.5);
            let direction = octahedral::to_direction(Vec2::new(at(column), -at(row))).normalize();
            sources.push(Source { direction, color: sum * (1.0 / total), solid_angle: total });
        }
    }
    sources
}
