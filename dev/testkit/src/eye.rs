//! What an eye would say of pictures of a window.

use std::ops::Range;

use rilievo::Rgba8;
use rilievo::color::Picture;

/// A part of a window, in pixels.
#[derive(Debug, Clone)]
pub struct Part {
    /// Columns, from the left.
    pub across: Range<u32>,
    /// Rows, from the top.
    pub down: Range<u32>,
}

impl Part {
    fn pixels(&self) -> impl Iterator<Item = (u32, u32)> {
        let across = self.across.clone();
        self.down.clone().flat_map(move |y| across.clone().map(move |x| (x, y)))
    }

    /// Where it shows something warm: clay or bricks, not the gray ground.
    pub fn warm(&self, picture: &Picture) -> Vec<(u32, u32)> {
        self.pixels().filter(|&at| i32::from(picture[at].r) > i32::from(picture[at].b) + 24).collect()
    }

    /// Pixels that differ by more than rounding.
    pub fn changed(&self, a: &Picture, b: &Picture) -> usize {
        let off = |a: Rgba8, b: Rgba8| a.rgb().iter().zip(b.rgb()).any(|(&a, b)| a.abs_diff(b) > 6);
        self.pixels().filter(|&at| off(a[at], b[at])).count()
    }
}
