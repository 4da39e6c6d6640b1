//! Choices by name.

use clap::ValueEnum;
use rilievo::height::Filter;
use rilievo::light::Blend;
use rilievo::polar::{UnitKind, Width};
use rilievo::quantize::{Dither, Effort};
use rilievo::raster::vectors::{Midpoints, Order};
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
    MethodArg => MethodKind {
        /// Look-up in a lit table of normals.
        Table => MethodKind::Table,
        /// Per-pixel frames and full normalisation: the reference for the others.
        Exact => MethodKind::Exact,
        /// A light map, baked once under the light of the first frame.
        Static => MethodKind::Static,
        /// Light and half vectors of the vertices, interpolated and left as short as they become.
        Linear => MethodKind::Vectors,
        /// The same, normalised in every pixel.
        Normalized => MethodKind::Vectors,
        /// The vectors interpolated quadratically (see --order and --midpoints).
        Quadratic => MethodKind::Vectors,
        /// An integer model of a bump unit in hardware, to the bit (see --unit and --table-bits).
        Polar => MethodKind::Polar(UnitKind::E3),
    }
);
choice!(
    /// The degree of the quadratic method's polynomials.
    OrderArg => Order {
        /// Linear on triangles over which the vectors hardly turn.
        Auto => Order::Auto,
        /// Linear on all triangles.
        Linear => Order::Linear,
        /// Quadratic on all triangles.
        Quadratic => Order::Quadratic,
    }
);
choice!(
    /// Where the quadratic method's vectors in the middle of an edge come from.
    MidpointsArg => Midpoints {
        /// A frame of their own, its tangent made orthogonal to the normal.
        GramSchmidt => Midpoints::GramSchmidt,
        /// A frame of their own, from the means of normals and tangents.
        Frames => Midpoints::NewFrames,
        /// The normalised means of the vectors at the ends.
        Averaged => Midpoints::AveragedVectors,
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
choice!(
    /// How light meets the base colour.
    BlendArg => Blend {
        /// Light adds up: colour x diffuse + specular.
        Add => Blend::Add,
        /// Highlights cover what they lie on: eq. (1) of the source.
        Exact => Blend::Exact,
        /// The same more cheaply; white things have no highlights: eq. (2).
        Approximate => Blend::Approximate,
        /// The colour is the material's; --color plays no part.
        Material => Blend::Material,
    }
);

/// A method by what it needs of an object's normals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MethodKind {
    /// A quantised object-space map.
    Table,
    /// Whatever there is.
    Exact,
    /// An object-space map, quantised or not, which is lit once.
    Static,
    /// A tangent-space map, or the mesh's own normals.
    Vectors,
    /// A map in the words of a unit, made of whatever there is.
    Polar(UnitKind),
}

impl MethodArg {
    /// The method, with the choices that are the quadratic method's and the polar method's.
    pub(crate) fn with(self, (order, midpoints): (OrderArg, MidpointsArg), (unit, width): (UnitKind, Width)) -> Method {
        match self {
            Self::Table => Method::Table,
            Self::Exact => Method::Exact,
            Self::Static => Method::Static,
            Self::Linear => Method::Linear,
            Self::Normalized => Method::Normalized,
            Self::Quadratic => Method::Quadratic { midpoints: midpoints.into(), order: order.into() },
            Self::Polar => Method::Polar { unit, width },
        }
    }

    /// Its name on the command line and in reports.
    pub(crate) fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |v| v.get_name().to_owned())
    }
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

/// What goes round in an animation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Turn {
    /// All objects, about the vertical axis through their middle.
    Object,
    /// All lights and the environment.
    Light,
    /// The camera, about what it looks at.
    Camera,
}
