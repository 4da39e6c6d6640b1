//! Blinn's method, eq. (1): the normal is perturbed in object space, `N' = N + [Bu(N × Pv) − Bv(N × Pu)]/‖N‖`.
//!
//! N, Pu and Pv come as unit vectors T, B, N of an orthonormal frame, so ‖N‖ is 1 and Bu, Bv are slopes. The text says twenty
//! multiplications and eight additions; the equation has eighteen and twelve (two cross products, two scaled vectors, two
//! sums), which is what is counted, with the normalisation of N' that it needs.
//!
//! | stage | word | rounding | overflow |
//! |---|---|---|---|
//! | N × Pv, N × Pu | Q2.14 | each product down | a few units past ±1 |
//! | Bu·, Bv· (Q4.12) | Q5.14 | product down | none |
//! | N' | Q2.14 | root down, quotient towards zero | a few units past ±1 |
//! | inner product | Q4.28 to Q2.14 | sum exact, then down | a few units past ±1 |

use alloc::vec::Vec;

use super::port::cartesian_ports;
use super::{Bump, Lit, Pixel, Port, Unit, Vector};
use crate::logic::{Logic, dot, narrow, normalize};
use crate::rom::Rom;

/// Blinn's perturbation with Ernst's illumination.
#[derive(Debug)]
pub(crate) struct Blinn;

/// Fractional bits of slopes, Q4.12.
const SLOPE_FRACTION: u32 = 12;

impl Unit for Blinn {
    const PORTS: &'static [Port] = cartesian_ports![Bump::Slope(0), Bump::Slope(1)];
    type Fetched<V: Copy> = [V; 3];
    type Rotated<V: Copy> = [V; 3];

    #[inline(always)]
    fn fetch<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>) -> [L::Value; 3] {
        let [tangent, bitangent, normal] = [6, 9, 12].map(|port| pixel.words(l, port));
        let [bu, bv] = [15, 16].map(|port| pixel.word(l, port));
        let along_u = cross(l, normal, bitangent).map(|part| l.multiply(part, bu, SLOPE_FRACTION));
        let along_v = cross(l, normal, tangent).map(|part| l.multiply(part, bv, SLOPE_FRACTION));
        normalize(l, [0, 1, 2].map(|k| l.sub(l.add(normal[k], along_u[k]), along_v[k])))
    }

    #[inline(always)]
    fn rotate<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>, vector: Lit) -> [L::Value; 3] {
        // The light stays where it is.
        pixel.words(l, 3 * vector as usize)
    }

    #[inline(always)]
    fn product<L: Logic>(&self, l: &L, bump: [L::Value; 3], vector: [L::Value; 3], _: Lit) -> L::Value {
        narrow(l, dot(l, bump, vector))
    }

    fn roms(&self) -> Vec<&Rom> {
        Vec::new()
    }
}

#[inline(always)]
fn cross<L: Logic>(l: &L, a: [L::Value; 3], b: [L::Value; 3]) -> [L::Value; 3] {
    let minor = |i: usize, j: usize| l.sub(l.multiply(a[i], b[j], 14), l.multiply(a[j], b[i], 14));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}
