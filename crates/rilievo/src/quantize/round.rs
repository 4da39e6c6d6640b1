//! Table entries are what files can hold.

use glam::Vec3;

use crate::normal::{Bare, decode_u16, encode_u16};

/// The 16-bit normal nearest to a unit vector that encodes and decodes to itself.
///
/// Rounding alone is not enough: decoding makes the vector unit length again, which may push a component over to the
/// next code, so that a table written, read and written again would creep. Then one of the neighbouring codes is taken
/// (that there always is one is held by `every_direction_has_a_stable_code`).
pub(super) fn storable(unit: [f32; 3]) -> Bare {
    let wanted = Bare::from_unit(Vec3::from_array(unit));
    let code = encode_u16(wanted);
    let simple = decode_u16(code);
    if simple == wanted || is_stable(code) {
        return simple;
    }
    let neighbour = |step: i32| {
        let steps = [step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1];
        let moved = [0, 1, 2].map(|k| (i32::from(code[k]) + steps[k]).clamp(0, 65_535) as u16);
        let candidate = decode_u16(moved);
        let distance = (candidate.vec().as_dvec3() - wanted.vec().as_dvec3()).length_squared();
        // Close to the axes there may be none but those at the border of their cell.
        (encode_u16(candidate) == moved).then_some((!is_stable(moved), distance, candidate))
    };
    let best = (0..27).filter_map(neighbour).min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    best.map_or(simple, |(_, _, normal)| normal)
}

/// Whether making the code's vector unit length leaves every component in its cell, clear of the border by more than the
/// roundings of f32.
fn is_stable(code: [u16; 3]) -> bool {
    let [x, y, z] = code.map(|c| f64::from(2 * i32::from(c) - 65_535));
    let stretch = (65_535.0 / (x * x + y * y + z * z).sqrt() - 1.0).abs();
    // Half a step of the code is 1 on this scale.
    [x, y, z].iter().all(|c| c.abs() * stretch < 0.98)
}

#[cfg(test)]
mod tests {
    use super::super::testing::scattered;
    use super::*;
    use crate::{Normal, Object};

    #[test]
    fn every_direction_has_a_stable_code() {
        let points = scattered(400_000, 1);
        let (mut worst, mut moved) = (0.0f64, 0);
        for i in 0..points.len() {
            let wanted = Normal::<Object>::new(Vec3::from_array(points.at(i))).unwrap();
            let stored = storable(points.at(i));
            assert_eq!(decode_u16::<Object>(encode_u16(stored)), stored);
            assert_eq!(storable(stored.vec().to_array()), stored);
            worst = worst.max(stored.angle_to(wanted));
            moved += u32::from(stored != decode_u16::<Object>(encode_u16(wanted)));
        }
        // A step of the code is 2 / 65535; nothing is moved by more than the diagonal of 1½ of them.
        assert!(worst < 1.5 * 3f64.sqrt() * 2.0 / 65_535.0, "{worst}");
        assert!(moved > 0, "the search is needed");
    }
}
