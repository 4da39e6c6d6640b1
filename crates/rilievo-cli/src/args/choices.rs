//! Choices by name.

use clap::ValueEnum;
use rilievo::height::Filter;
use rilievo::quantize::{Dither, Effort};
use rilievo::raster::{Method, TextureFilter};
use rilievo::{Convention, Edges};
use rilievo_io::{EmbeddedMaterials, SpaceKind};

/// Declares a command-line choice and what it stands for in the library.
macro_rules! choice {
    ($(#[$doc:meta])* $name:ident => $target:ty { $($(#[$variant_doc:meta])* $variant:ident => $value:expr,)* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
        pub(crate) enum $name {
            $($(#[$variant_doc])* $variant,)*
        }

        impl From<$name> for $target {
            fn from(choice: $name) -> Self {
                match choice {
                    $($name::$variant => $value,)*
                }
            }
        }
    };
}

choice!(
    /// Which way green points.
    ConventionArg => Convention {
        /// +Y up: OpenGL, glTF, Blender, Godot, Bevy.
        Gl => Convention::Gl,
        /// +Y down: DirectX, Unreal.
        Dx => Convention::Dx,
    }
);
choice!(
    /// What lies beyond the border of a map.
    EdgesArg => Edges {
        /// The map repeats: tiling textures.
        Wrap => Edges::Wrap,
        /// The border goes on: terrain, scans.
        Clamp => Edges::Clamp,
        /// The map is mirrored.
        Mirror => Edges::Mirror,
    }
);
choice!(
    /// How slopes are estimated.
    FilterArg => Filter {
        /// Least-squares plane over 4 neighbours: the sharpest.
        Plane4 => Filter::Plane4,
        /// Least-squares plane over 8 neighbours: less noise.
        Plane8 => Filter::Plane8,
        /// Sobel, 3 x 3.
        Sobel => Filter::Sobel,
        /// Scharr, 3 x 3: the most even in all directions.
        Scharr => Filter::Scharr,
    }
);
choice!(
    /// The space normals are in.
    SpaceArg => SpaceKind {
        /// The surface's own frame: tiling maps, flat things.
        Tangent => SpaceKind::Tangent,
        /// The mesh's space: maps made for one mesh.
        Object => SpaceKind::Object,
    }
);
choice!(
    /// How hard the quantiser tries.
    EffortArg => Effort {
        Fast => Effort::Fast,
        Normal => Effort::Normal,
        Best => Effort::Best,
    }
);
choice!(
    /// Where a normal map's colours hold materials.
    MaterialsInArg => EmbeddedMaterials {
        /// Alpha is the number of the material.
        Alpha => EmbeddedMaterials::Alpha,
        /// The top bits of red and green are the number; blue's top bit makes their sum even.
        SubCubes => EmbeddedMaterials::SubCubes,
    }
);
choice!(
    /// How texels choose their entries.
    DitherArg => Dither {
        /// The nearest.
        None => Dither::None,
        /// Error diffusion: the least error over an area.
        Diffusion => Dither::Diffusion,
        /// A fixed mask: each texel by itself, no worms, all cores.
        BlueNoise => Dither::BlueNoise,
    }
);
choice!(
    /// How normals become colours.
    MethodArg => Method {
        /// Look-up in a lit table of normals.
        Table => Method::Table,
        /// Per-pixel frames and full normalisation: the reference.
        Exact => Method::Exact,
    }
);
choice!(
    /// How a pixel gathers texels.
    SamplingArg => TextureFilter {
        Nearest => TextureFilter::Nearest,
        Bilinear => TextureFilter::Bilinear,
        /// Bilinear on two mip levels.
        Trilinear => TextureFilter::Trilinear,
    }
);

/// How surfaces answer light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ModelArg {
    /// Ambient and diffuse.
    Lambert,
    /// Ambient, diffuse and highlights.
    BlinnPhong,
}

impl ConventionArg {
    /// How generated names say it.
    pub(crate) fn suffix(self) -> &'static str {
        match self {
            Self::Gl => "gl",
            Self::Dx => "dx",
        }
    }
}

/// Bits per component of written normal maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Bits {
    #[value(name = "8")]
    Eight,
    #[value(name = "16")]
    Sixteen,
}
