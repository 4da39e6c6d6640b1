//! Comparing a picture with its golden one.

use rilievo::color::Picture;
use rilievo::{Grid, Rgba8};

/// How far a picture may be from its golden one: one number alone either lets faults pass or cries wolf.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// A channel may differ by so much, in 1/255, without being counted.
    pub per_channel: u8,
    /// The share of pixels in which a channel may differ by more.
    pub share_over: f64,
    /// No channel of any pixel may differ by more than this.
    pub hard_cap: u8,
}

impl Tolerance {
    /// Not a bit may differ.
    pub const EXACT: Self = Self { per_channel: 0, share_over: 0.0, hard_cap: 0 };
}

/// How far two pictures are apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// The largest difference of a channel (alpha is one), in 1/255.
    pub largest: u8,
    /// How many pixels have a channel that differs by more than [`Tolerance::per_channel`].
    pub pixels_over: usize,
    /// Pixels compared.
    pub pixels: usize,
}

impl Difference {
    /// Compares pixel by pixel; `None` if the sizes differ.
    pub fn between(expected: &Picture, actual: &Picture, tolerance: &Tolerance) -> Option<Self> {
        if expected.size() != actual.size() {
            return None;
        }
        let largest = |(a, b): (&Rgba8, &Rgba8)| distances(*a, *b).into_iter().fold(0, u8::max);
        let pairs = expected.texels().iter().zip(actual.texels());
        let each: Vec<u8> = pairs.map(largest).collect();
        Some(Self {
            largest: each.iter().copied().fold(0, u8::max),
            pixels_over: each.iter().filter(|&&d| d > tolerance.per_channel).count(),
            pixels: each.len(),
        })
    }

    /// Whether all three numbers hold.
    pub fn is_within(&self, tolerance: &Tolerance) -> bool {
        let allowed = tolerance.share_over * self.pixels as f64;
        self.pixels_over as f64 <= allowed && self.largest <= tolerance.hard_cap
    }
}

/// Expected | difference | actual, for the eye. Differences are shown 8 times as large; a picture of another size is
/// shown with no difference beside it.
pub fn side_by_side(expected: Option<&Picture>, actual: &Picture) -> Picture {
    let empty = actual.map(|_| Rgba8::new(0, 0, 0, 255));
    let expected = expected.unwrap_or(&empty);
    let difference = if expected.size() == actual.size() { amplified(expected, actual) } else { empty.clone() };
    let parts = [expected, &difference, actual];
    let height = parts.iter().map(|p| p.height()).max().unwrap_or(1);
    let row = |y: u32| parts.iter().flat_map(move |p| (0..p.width()).map(move |x| p.get(x, y).copied()));
    let pixels: Vec<Rgba8> = (0..height).flat_map(row).map(Option::unwrap_or_default).collect();
    let width = parts.iter().map(|p| p.width()).sum();
    Grid::new(width, height, pixels).expect("invariant: the rows are as long as the parts together")
}

fn amplified(a: &Picture, b: &Picture) -> Picture {
    let shown = |(a, b): (&Rgba8, &Rgba8)| {
        let [r, g, b, a] = distances(*a, *b).map(|d| d.saturating_mul(8));
        Rgba8::new(r.max(a), g.max(a), b.max(a), 255)
    };
    let pixels = a.texels().iter().zip(b.texels()).map(shown).collect();
    Grid::new(a.width(), a.height(), pixels).expect("invariant: same size as a")
}

fn distances(a: Rgba8, b: Rgba8) -> [u8; 4] {
    [a.r.abs_diff(b.r), a.g.abs_diff(b.g), a.b.abs_diff(b.b), a.a.abs_diff(b.a)]
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOLERANCE: Tolerance = Tolerance { per_channel: 2, share_over: 0.01, hard_cap: 20 };

    /// A gray picture of 100 pixels, some of which are off.
    fn judge(off: &[(usize, u8)]) -> bool {
        let expected = Grid::filled(10, 10, Rgba8::new(100, 100, 100, 255)).unwrap();
        let mut actual = expected.clone();
        off.iter().for_each(|&(at, by)| actual.texels_mut()[at].g += by);
        Difference::between(&expected, &actual, &TOLERANCE).unwrap().is_within(&TOLERANCE)
    }

    #[test]
    fn each_of_the_three_numbers_can_fail() {
        let all_by = |by| (0..100).map(|i| (i, by)).collect::<Vec<_>>();
        assert!(judge(&all_by(2)) && !judge(&all_by(3)));
        assert!(judge(&[(7, 20)]) && !judge(&[(7, 20), (8, 3)]));
        assert!(!judge(&[(7, 21)]));
    }

    #[test]
    fn exact_is_exact_and_sizes_must_agree() {
        let one = Grid::filled(3, 1, Rgba8::new(1, 2, 3, 255)).unwrap();
        let mut other = one.clone();
        let within =
            |o: &Picture| Difference::between(&one, o, &Tolerance::EXACT).map(|d| d.is_within(&Tolerance::EXACT));
        assert_eq!(within(&other), Some(true));
        other[(2, 0)].a = 254;
        assert_eq!(within(&other), Some(false));
        assert_eq!(within(&Grid::filled(1, 3, Rgba8::default()).unwrap()), None);
    }

    #[test]
    fn sheets_show_all_three() {
        let (a, b) = (Grid::filled(2, 1, Rgba8::new(10, 10, 10, 255)), Grid::filled(2, 1, Rgba8::new(13, 10, 10, 255)));
        let sheet = side_by_side(Some(&a.unwrap()), &b.unwrap());
        assert_eq!(sheet.size(), (6, 1));
        assert_eq!([0, 2, 4].map(|x| sheet[(x, 0)].r), [10, 24, 13]);
        assert_eq!(side_by_side(None, &Grid::filled(2, 3, Rgba8::default()).unwrap()).size(), (6, 3));
    }
}
