//! What there is to look at without a file.

use rilievo::height::HeightMap;
use rilievo::light::Material;
use rilievo::sample::{Covering, bricks, globe, planks, vase};
use rilievo::surface::{Mesh, shapes};
use rilievo::{Grid, LinearRgb, MaterialMap, Result, Rgba8};

/// A built-in subject, made by code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Sample {
    /// A Greek vase, of clay and glaze.
    #[default]
    Vase,
    /// A wall.
    Bricks,
    /// A floor.
    Planks,
    /// A world.
    Globe,
}

/// Everything of a sample before it is bent and quantised.
pub(super) struct Parts {
    pub(super) mesh: Mesh,
    pub(super) height: HeightMap,
    pub(super) color: Grid<Rgba8>,
    pub(super) kinds: Option<MaterialMap>,
    pub(super) materials: Vec<Material>,
}

impl Sample {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Vase, Self::Bricks, Self::Planks, Self::Globe];

    /// Its name, for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Vase => "Vase",
            Self::Bricks => "Bricks",
            Self::Planks => "Planks",
            Self::Globe => "Globe",
        }
    }

    /// Draws its maps; `width` is that of the map in texels.
    pub(super) fn parts(self, width: u32) -> Result<Parts> {
        let covered = |mesh, covering: Covering, highlight: f32| Parts {
            mesh,
            height: covering.height,
            color: covering.color,
            kinds: None,
            materials: vec![Material::blinn_phong(LinearRgb::WHITE, LinearRgb::gray(highlight), 24.0)],
        };
        Ok(match self {
            Self::Vase => {
                let maps = vase::maps(width)?;
                Parts {
                    mesh: vase::mesh(vase::DEFAULT_SEGMENTS)?,
                    height: maps.height,
                    color: maps.color,
                    kinds: Some(maps.materials),
                    materials: vase::materials_over_color().to_vec(),
                }
            }
            Self::Bricks => covered(shapes::plane(1.0)?, bricks(width)?, 0.02),
            Self::Planks => covered(shapes::plane(1.0)?, planks(width)?, 0.06),
            Self::Globe => covered(shapes::sphere(128, 64)?, globe(width)?, 0.0),
        })
    }
}
