// The scene's shaders, as one would write them for a GPU. Light is linear; the target encodes it.

struct Uniforms {
    view_projection: mat4x4f,
    eye: vec4f,
    // A position (w = 1), or a direction towards a light far away (w = 0).
    light: vec4f,
    ambient: vec4f,
    diffuse: vec4f,
    specular: vec4f,
    // Repeats of the tangent-space map; side of the index map.
    repeat: vec4f,
}

@group(0) @binding(0) var<uniform> u: Uniforms;
@group(0) @binding(1) var normal_map: texture_2d<f32>;
@group(0) @binding(2) var normal_sampler: sampler;
@group(0) @binding(3) var indices: texture_2d<u32>;
@group(0) @binding(4) var colors: texture_2d<f32>;

struct Vertex {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
}

struct Plain {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
}

struct Framed {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
    @location(1) position: vec3f,
    @location(2) tangent: vec3f,
    @location(3) bitangent: vec3f,
    @location(4) normal: vec3f,
}

struct Turned {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
    @location(1) light: vec3f,
    @location(2) half_way: vec3f,
}

fn to_clip(p: vec3f) -> vec4f {
    return u.view_projection * vec4f(p, 1.0);
}

fn toward_light(p: vec3f) -> vec3f {
    return normalize(u.light.xyz - u.light.w * p);
}

@vertex fn vertex_plain(v: Vertex) -> Plain {
    return Plain(to_clip(v.position), v.uv);
}

@vertex fn vertex_exact(v: Vertex) -> Framed {
    let bitangent = cross(v.normal, v.tangent.xyz) * v.tangent.w;
    return Framed(to_clip(v.position), v.uv * u.repeat.xy, v.position, v.tangent.xyz, bitangent, v.normal);
}

// Light and half-way vectors in the vertex's frame.
@vertex fn vertex_normalized(v: Vertex) -> Turned {
    let bitangent = cross(v.normal, v.tangent.xyz) * v.tangent.w;
    let l = toward_light(v.position);
    let h = normalize(l + normalize(u.eye.xyz - v.position));
    let turned_l = vec3f(dot(v.tangent.xyz, l), dot(bitangent, l), dot(v.normal, l));
    let turned_h = vec3f(dot(v.tangent.xyz, h), dot(bitangent, h), dot(v.normal, h));
    return Turned(to_clip(v.position), v.uv * u.repeat.xy, turned_l, turned_h);
}

// Ambient, Lambert and Blinn-Phong with exponent 32, the highlight only where there is light.
fn lit(cosine: f32, half_cosine: f32) -> vec4f {
    // Below 2^(-126/32) the power would be a denormal number.
    let s = max(half_cosine, 0.0652);
    let s2 = s * s;
    let s4 = s2 * s2;
    let s8 = s4 * s4;
    let s16 = s8 * s8;
    let highlight = select(0.0, s16 * s16, cosine > 0.0);
    return vec4f(u.ambient.rgb + max(cosine, 0.0) * u.diffuse.rgb + highlight * u.specular.rgb, 1.0);
}

@fragment fn fragment_exact(v: Framed) -> @location(0) vec4f {
    let m = textureSample(normal_map, normal_sampler, v.uv).xyz * 2.0 - 1.0;
    let n = normalize(v.tangent * m.x + v.bitangent * m.y + v.normal * m.z);
    let l = toward_light(v.position);
    let h = normalize(l + normalize(u.eye.xyz - v.position));
    return lit(dot(n, l), dot(n, h));
}

@fragment fn fragment_normalized(v: Turned) -> @location(0) vec4f {
    let m = textureSample(normal_map, normal_sampler, v.uv).xyz * 2.0 - 1.0;
    return lit(dot(m, normalize(v.light)), dot(m, normalize(v.half_way)));
}

@fragment fn fragment_index(v: Plain) -> @location(0) vec4f {
    // The side is a power of two: the mask wraps.
    let side = vec2i(i32(u.repeat.z));
    let texel = vec2i(floor(v.uv * u.repeat.z)) & (side - 1);
    let index = textureLoad(indices, texel, 0).x;
    return textureLoad(colors, vec2u(index & 127u, index >> 7u), 0);
}

@fragment fn fragment_flat() -> @location(0) vec4f {
    return vec4f(u.diffuse.rgb, 1.0);
}
