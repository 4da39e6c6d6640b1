//! Sine and cosine with the same bits on every machine, because the maps end up in files.

/// (sin, cos) of `turns` full turns. Class A: Taylor series within an eighth of a turn, error below 1e-9.
pub(crate) fn sin_cos(turns: f64) -> (f32, f32) {
    let quarter = (turns * 4.0).round();
    let x = (turns - quarter * 0.25) * std::f64::consts::TAU;
    let q = x * x;
    let sin = x * (1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0))));
    let cos = 1.0 - q / 2.0 * (1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0 * (1.0 - q / 90.0))));
    let (sin, cos) = match quarter.rem_euclid(4.0) as u32 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    };
    (sin as f32, cos as f32)
}

#[cfg(test)]
mod tests {
    #[test]
    fn agrees_with_the_platform() {
        for i in -1000..1000 {
            let turns = f64::from(i) / 371.0;
            let (sin, cos) = super::sin_cos(turns);
            let expected = (turns * std::f64::consts::TAU).sin_cos();
            assert!((f64::from(sin) - expected.0).abs() < 6e-8 && (f64::from(cos) - expected.1).abs() < 6e-8, "{i}");
        }
        assert_eq!(
            [0.0, 0.25, 0.5, 0.75, 1.0].map(super::sin_cos)[1..],
            [(1.0, 0.0), (0.0, -1.0), (-1.0, 0.0), (0.0, 1.0)].map(|(s, c): (f32, f32)| (s + 0.0, c + 0.0))
        );
    }
}
