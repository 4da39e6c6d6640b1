//! What surfaces are made of.

use rilievo::light::{LightingModel, Material};

use crate::args::{Finish, ModelArg};
use crate::exit;

/// Materials by number, before it is known how many the maps name.
#[derive(Debug, Clone)]
pub(crate) struct MaterialSpec {
    /// Numbers with their materials; of several the last counts.
    pub(crate) given: Vec<(u8, Material)>,
    /// How the materials that are not given answer light; their colours are those that go with the surface.
    pub(crate) models: Vec<ModelArg>,
    /// How messages call the given ones.
    pub(crate) called: String,
}

impl MaterialSpec {
    /// Materials `0 … count − 1`: those that were given, and the surface's own for the rest.
    pub(crate) fn resolve(&self, count: usize, default: impl Fn(usize) -> Material) -> Vec<Material> {
        for (absent, _) in self.given.iter().filter(|(n, _)| usize::from(*n) >= count.max(1)) {
            exit::warn(&self.called, &format!("there is no material {absent}: the maps name {count}"));
        }
        let given = |n: usize| self.given.iter().rev().find(|(number, _)| usize::from(*number) == n);
        let own = |n: usize| Finish::of(&default(n)).with(&self.models);
        (0..count.max(1)).map(|n| given(n).map_or_else(|| own(n), |(_, material)| material.clone())).collect()
    }

    /// Whether any of them shows the environment.
    pub(crate) fn mirrors(&self) -> bool {
        self.models.iter().any(|m| m.mirrors()) || self.given.iter().any(|(_, material)| mirrors(material))
    }
}

fn mirrors(material: &Material) -> bool {
    let shows =
        |m: &LightingModel| matches!(m, LightingModel::Environment { .. } | LightingModel::MetallicRoughness { .. });
    material.layers().iter().any(|layer| shows(&layer.model))
}

/// Whether interpolated light and half vectors are all that a material needs.
pub(crate) fn takes_vectors(material: &Material) -> bool {
    material.layers().iter().all(|layer| {
        matches!(
            layer.model,
            LightingModel::Ambient { .. } | LightingModel::Lambert { .. } | LightingModel::BlinnPhong { .. }
        )
    })
}

#[cfg(test)]
mod tests {
    use rilievo::LinearRgb;

    use super::*;

    #[test]
    fn the_last_material_of_a_number_counts_and_the_rest_are_the_surfaces_own() {
        let (first, last) = (Material::matte(LinearRgb::BLACK), Material::matte(LinearRgb::WHITE));
        let spec = MaterialSpec {
            given: vec![(1, first), (1, last.clone())],
            models: vec![ModelArg::DEFAULT],
            called: String::new(),
        };
        let all = spec.resolve(3, |_| Material::default());
        assert_eq!(all, [Material::default(), last, Material::default()]);
        assert!(!spec.mirrors() && all.iter().all(takes_vectors));
    }

    #[test]
    fn mirrors_are_known_by_their_layers() {
        let mirror = Material::new([LightingModel::Environment { color: LinearRgb::WHITE, roughness: 0.0 }]);
        let given = vec![(0, mirror.clone())];
        let spec = MaterialSpec { given, models: vec![ModelArg::DEFAULT], called: String::new() };
        assert!(spec.mirrors() && !takes_vectors(&mirror));
    }
}
