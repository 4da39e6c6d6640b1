// What all methods share: a frame's numbers, maps, vertices, and how a pixel's light leaves.
//
// Everything is in object space. Textures instead of storage buffers: WebGL2 has none.

struct Uniforms {
    to_clip: mat4x4f,
    // Where the eye is.
    eye: vec4f,
    ambient: vec4f,
    // Rotation to the space of the surroundings, where +Y is up.
    to_sky: mat3x3f,
    // Width and height of the picture in pixels.
    viewport: vec4f,
    // Copies of the map on the texture square, and of the base colour.
    repeat: vec4f,
    lights: u32,
    // Mip levels of the map, and of the base colour; 0 where there is none.
    levels: u32,
    base_levels: u32,
    filtering: u32,
    edges: u32,
    blend: u32,
    detail: u32,
    // Entries of the table before those of back faces; 0 if back faces have none of their own.
    back: u32,
    // Whether there is a material per texel.
    kinds: u32,
    // Blurred copies of the surroundings, the sharp one first; 0 without surroundings.
    sky_levels: u32,
    // Whether the surroundings are a matcap.
    matcap: u32,
    // What else a method has to be told.
    variant: u32,
    // Of each copy of the surroundings: first row in the texture, width and height without the border.
    sky: array<vec4u, 5>,
}

const NEAREST = 0u;
const BILINEAR = 1u;
const TRILINEAR = 2u;

const WRAP = 0u;
const CLAMP = 1u;
const MIRROR = 2u;

const SMOOTH = 0u;
const TANGENT = 1u;
const OBJECT = 2u;
const INDEXED = 3u;

@group(0) @binding(0) var<uniform> u: Uniforms;
// Indices into the table, or the words of a bump-vector map.
@group(0) @binding(1) var indices: texture_2d<u32>;
// Shades of the table, or the tables of a polar unit.
@group(0) @binding(2) var table: texture_2d<u32>;
// Two texels a light.
@group(0) @binding(3) var lights: texture_2d<f32>;
// Materials and their layers.
@group(0) @binding(4) var materials: texture_2d<f32>;
// Normals, or the diffuse light of a light map.
@group(0) @binding(5) var relief: texture_2d<f32>;
// The specular light of a light map.
@group(0) @binding(6) var gloss: texture_2d<f32>;
@group(0) @binding(7) var base: texture_2d<f32>;
// The copies of the surroundings, one below the other.
@group(0) @binding(8) var surroundings: texture_2d<f32>;
// A material per texel.
@group(0) @binding(9) var kinds: texture_2d<u32>;
// Normal and material of each entry of the table.
@group(0) @binding(10) var normals: texture_2d<f32>;
@group(0) @binding(11) var sampling: sampler;
// Three texels a vertex, and one a triangle: for methods that need all corners of a triangle.
@group(0) @binding(12) var corners: texture_2d<f32>;
@group(0) @binding(13) var triangles: texture_2d<u32>;

struct Vertex {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
}

// A pixel of a method that looks at the map alone.
struct Textured {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
}

// A pixel with the mesh's own frame, interpolated and not normalised.
struct Surface {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
    @location(1) position: vec3f,
    @location(2) normal: vec3f,
    @location(3) tangent: vec4f,
}

// Vertices stand on a grid of 1/256 of a pixel before anything is interpolated. Rasterisers snap them to it anyway, but
// some interpolate from where they stood before; this way the picture is the CPU's, texel for texel.
fn to_screen(p: vec3f) -> vec4f {
    let clip = u.to_clip * vec4f(p, 1.0);
    let scale = u.viewport.xy * 128.0;
    let grid = clip.xy / clip.w * scale;
    if !(clip.w > 0.0 && all(abs(grid) < vec2f(4194304.0))) {
        return clip;
    }
    return vec4f(round(grid) / scale * clip.w, clip.zw);
}

@vertex fn vertex_textured(v: Vertex) -> Textured {
    return Textured(to_screen(v.position), v.uv);
}

@vertex fn vertex_surface(v: Vertex) -> Surface {
    return Surface(to_screen(v.position), v.uv, v.position, v.normal, v.tangent);
}

// Light for the base colour to tint, and light that goes on top.
struct Shade {
    diffuse: vec3f,
    specular: vec3f,
}

fn dark() -> Shade {
    return Shade(vec3f(0.0), vec3f(0.0));
}

fn plus(a: Shade, b: Shade, weight: f32) -> Shade {
    return Shade(a.diffuse + b.diffuse * weight, a.specular + b.specular * weight);
}

// The light that leaves a surface of base colour `c` (Tarini et al. 2000, section 7).
fn over(shade: Shade, c: vec3f) -> vec3f {
    switch u.blend {
        // Eq. (1).
        case 1u: {
            let tinted = shade.diffuse * c;
            return tinted + max(1.0 - tinted, vec3f(0.0)) * shade.specular;
        }
        // Eq. (2).
        case 2u: {
            return shade.diffuse * c + max(1.0 - c, vec3f(0.0)) * shade.specular;
        }
        case 3u: {
            return shade.diffuse + shade.specular;
        }
        default: {
            return shade.diffuse * c + shade.specular;
        }
    }
}

// The pixel's colour: encoded here, as no surface format does it on every API.
fn leave(shade: Shade, footprint: Footprint) -> vec4f {
    let light = clamp(over(shade, base_color(footprint)), vec3f(0.0), vec3f(1.0));
    let bright = 1.055 * pow(light, vec3f(1.0 / 2.4)) - 0.055;
    return vec4f(select(bright, light * 12.92, light <= vec3f(0.0031308)), 1.0);
}
