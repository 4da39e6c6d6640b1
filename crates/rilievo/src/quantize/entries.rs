//! The table while it is being shaped.

use std::ops::Range;

/// Entries by group of points (see [`super::points::Group`]): group g owns `directions[spans[g]]`.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Entries {
    pub directions: Vec<[f32; 3]>,
    pub spans: Vec<Range<usize>>,
}

impl Entries {
    /// Joins the entries of all groups.
    pub(super) fn from_groups(groups: impl IntoIterator<Item = Vec<[f32; 3]>>) -> Self {
        let mut all = Self::default();
        for group in groups {
            let first = all.directions.len();
            all.directions.extend(group);
            all.spans.push(first..all.directions.len());
        }
        all
    }

    /// The group (material) of each entry.
    pub(super) fn groups(&self) -> Vec<u8> {
        let group = |(span, group): (&Range<usize>, u8)| span.clone().map(move |_| group);
        self.spans.iter().zip(0u8..=255).flat_map(group).collect()
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.directions.len()
    }
}

/// A vector made unit length; `None` if it is too short to have a direction.
pub(super) fn unit([x, y, z]: [f64; 3]) -> Option<[f32; 3]> {
    let length = (x * x + y * y + z * z).sqrt();
    (length > 1e-30).then(|| [x, y, z].map(|c| (c / length) as f32))
}

/// A vector that is not zero at unit length, in f64.
pub(super) fn normalized([x, y, z]: [f64; 3]) -> [f64; 3] {
    let length = (x * x + y * y + z * z).sqrt();
    [x / length, y / length, z / length]
}

/// Squared distance in f64: what "nearest" means everywhere in this folder.
pub(super) fn squared_f64(a: [f64; 3], b: [f32; 3]) -> f64 {
    let [x, y, z] = [a[0] - f64::from(b[0]), a[1] - f64::from(b[1]), a[2] - f64::from(b[2])];
    x * x + y * y + z * z
}
