// Light and half vectors in the frame of the surface, interpolated over the screen: linear, normalised by the pixel, or
// quadratic through the vertices and the middles of the edges (Hast, Barrera, Bengtsson).
//
// Whole triangles are needed for the middles, so the mesh is read from textures and not from vertex buffers. Over the
// screen means: without perspective. Values are multiplied by w at the vertex and by 1/w at the pixel, which undoes the
// rasteriser's correction. The quadratic polynomial is the linear one and three bends, each of an edge:
// sum of s_i f_i + 4 s_i s_j (f_ij - (f_i + f_j)/2), with the pixel's weights s.

const LINEAR = 0u;
const NORMALIZED = 1u;
const QUADRATIC = 2u;

const NEW_FRAMES = 0u;
const AVERAGED_VECTORS = 1u;

struct Interpolated {
    @builtin(position) clip: vec4f,
    // Texture coordinates, and the weights of corners 0 and 1 times w.
    @location(0) uv: vec4f,
    // And that of corner 2.
    @location(1) position: vec4f,
    // L' and H' times w of both lights.
    @location(2) light_0: vec3f,
    @location(3) half_0: vec3f,
    @location(4) light_1: vec3f,
    @location(5) half_1: vec3f,
    // Bends of both lights, each three times L' and H', in pairs of 16 bits.
    @location(6) @interpolate(flat, either) bend_0: vec4u,
    @location(7) @interpolate(flat, either) bend_1: vec4u,
    @location(8) @interpolate(flat, either) bend_2: vec4u,
    @location(9) @interpolate(flat, either) bend_3: vec4u,
    @location(10) @interpolate(flat, either) bend_4: vec2u,
}

struct Frame {
    position: vec3f,
    normal: vec3f,
    tangent: vec4f,
}

struct Rotated {
    light: vec3f,
    halfway: vec3f,
}

fn corner_texel(vertex: u32, k: u32) -> vec4f {
    return textureLoad(corners, vec2u((vertex & 255u) * 3u + k, vertex >> 8u), 0);
}

fn orthogonal(n: vec3f, t: vec3f) -> vec3f {
    let axis = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(n.x) > 0.7);
    return unit_or(t - n * dot(n, t), normalize(axis - n * dot(n, axis)));
}

// L' and H' of a light at a point with a frame.
fn rotated(frame: Frame, i: u32) -> Rotated {
    let l = lamp(i, frame.position).toward;
    if dot(l, l) == 0.0 {
        return Rotated(vec3f(0.0), vec3f(0.0));
    }
    let view = unit_or(u.eye.xyz - frame.position, vec3f(0.0));
    let h = unit_or(l + view, vec3f(0.0));
    let t = frame.tangent.xyz;
    let b = cross(frame.normal, t) * frame.tangent.w;
    return Rotated(vec3f(dot(t, l), dot(b, l), dot(frame.normal, l)), vec3f(dot(t, h), dot(b, h), dot(frame.normal, h)));
}

// A frame of its own for the middle of an edge.
fn middle(a: Frame, b: Frame, way: u32) -> Frame {
    let normal = unit_or(a.normal + b.normal, a.normal);
    let sum = a.tangent.xyz + b.tangent.xyz;
    let right = orthogonal(normal, sum);
    let tangent = select(right, unit_or(sum, a.tangent.xyz), way == NEW_FRAMES);
    return Frame((a.position + b.position) * 0.5, normal, vec4f(tangent, a.tangent.w));
}

// What the vectors in the middle of an edge are beyond the mean of its ends.
fn bend(a: Frame, b: Frame, at_a: Rotated, at_b: Rotated, i: u32) -> Rotated {
    let way = u.variant >> 8u;
    let mean = Rotated((at_a.light + at_b.light) * 0.5, (at_a.halfway + at_b.halfway) * 0.5);
    var there = Rotated(unit_or(mean.light, vec3f(0.0)), unit_or(mean.halfway, vec3f(0.0)));
    if way != AVERAGED_VECTORS {
        there = rotated(middle(a, b, way), i);
    }
    return Rotated(there.light - mean.light, there.halfway - mean.halfway);
}

struct Bends {
    first: Rotated,
    second: Rotated,
    third: Rotated,
}

fn bends(frames: ptr<function, array<Frame, 3>>, at: ptr<function, array<Rotated, 3>>, i: u32) -> Bends {
    return Bends(
        bend((*frames)[0], (*frames)[1], (*at)[0], (*at)[1], i),
        bend((*frames)[0], (*frames)[2], (*at)[0], (*at)[2], i),
        bend((*frames)[1], (*frames)[2], (*at)[1], (*at)[2], i),
    );
}

fn pack(b: Bends) -> array<u32, 9> {
    return array<u32, 9>(
        pack2x16snorm(b.first.light.xy),
        pack2x16snorm(vec2f(b.first.light.z, b.first.halfway.x)),
        pack2x16snorm(b.first.halfway.yz),
        pack2x16snorm(b.second.light.xy),
        pack2x16snorm(vec2f(b.second.light.z, b.second.halfway.x)),
        pack2x16snorm(b.second.halfway.yz),
        pack2x16snorm(b.third.light.xy),
        pack2x16snorm(vec2f(b.third.light.z, b.third.halfway.x)),
        pack2x16snorm(b.third.halfway.yz),
    );
}

@vertex fn vertex_vectors(@builtin(vertex_index) number: u32) -> Interpolated {
    let triangle = number / 3u;
    let own = number % 3u;
    let vertices = textureLoad(triangles, vec2u(triangle & 255u, triangle >> 8u), 0).xyz;
    var frames: array<Frame, 3>;
    var uv = vec2f(0.0);
    for (var k = 0u; k < 3u; k++) {
        let place = corner_texel(vertices[k], 0u);
        let normal = corner_texel(vertices[k], 1u);
        frames[k] = Frame(place.xyz, normal.xyz, corner_texel(vertices[k], 2u));
        if k == own {
            uv = vec2f(place.w, normal.w);
        }
    }
    // A mesh without tangents: frames of the triangle's own, as alike as its normals let them be.
    if frames[0].tangent.w == 0.0 {
        let n = unit_or(frames[0].normal + frames[1].normal + frames[2].normal, frames[0].normal);
        let shared_axis = orthogonal(n, vec3f(0.36, 0.48, 0.8));
        for (var k = 0u; k < 3u; k++) {
            frames[k].tangent = vec4f(orthogonal(frames[k].normal, shared_axis), 1.0);
        }
    }
    var v: Interpolated;
    v.clip = to_screen(frames[own].position);
    let w = v.clip.w;
    let weights = select(vec3f(0.0), vec3f(w), vec3u(0u, 1u, 2u) == vec3u(own));
    v.uv = vec4f(uv, weights.xy);
    v.position = vec4f(frames[own].position, weights.z);
    if u.lights > 0u {
        var at: array<Rotated, 3>;
        for (var k = 0u; k < 3u; k++) {
            at[k] = rotated(frames[k], 0u);
        }
        v.light_0 = at[own].light * w;
        v.half_0 = at[own].halfway * w;
        if (u.variant & 255u) == QUADRATIC {
            let words = pack(bends(&frames, &at, 0u));
            v.bend_0 = vec4u(words[0], words[1], words[2], words[3]);
            v.bend_1 = vec4u(words[4], words[5], words[6], words[7]);
            v.bend_4.x = words[8];
        }
    }
    if u.lights > 1u {
        var at: array<Rotated, 3>;
        for (var k = 0u; k < 3u; k++) {
            at[k] = rotated(frames[k], 1u);
        }
        v.light_1 = at[own].light * w;
        v.half_1 = at[own].halfway * w;
        if (u.variant & 255u) == QUADRATIC {
            let words = pack(bends(&frames, &at, 1u));
            v.bend_2 = vec4u(words[0], words[1], words[2], words[3]);
            v.bend_3 = vec4u(words[4], words[5], words[6], words[7]);
            v.bend_4.y = words[8];
        }
    }
    return v;
}

// Three words of a bend.
fn unbent(a: u32, b: u32, c: u32, weight: f32) -> Rotated {
    let low = unpack2x16snorm(a);
    let between = unpack2x16snorm(b);
    let high = unpack2x16snorm(c);
    return Rotated(vec3f(low, between.x) * weight, vec3f(between.y, high) * weight);
}

// The vectors of a light at a pixel.
fn vectors_of(v: Interpolated, i: u32) -> Rotated {
    let inverse_w = v.clip.w;
    var at = Rotated(v.light_0 * inverse_w, v.half_0 * inverse_w);
    var first = v.bend_0;
    var second = v.bend_1;
    var last = v.bend_4.x;
    if i == 1u {
        at = Rotated(v.light_1 * inverse_w, v.half_1 * inverse_w);
        first = v.bend_2;
        second = v.bend_3;
        last = v.bend_4.y;
    }
    switch u.variant & 255u {
        case NORMALIZED: {
            return Rotated(unit_or(at.light, vec3f(0.0)), unit_or(at.halfway, vec3f(0.0)));
        }
        case QUADRATIC: {
            let s = vec3f(v.uv.zw, v.position.w) * inverse_w;
            let a = unbent(first.x, first.y, first.z, 4.0 * s.x * s.y);
            let b = unbent(first.w, second.x, second.y, 4.0 * s.x * s.z);
            let c = unbent(second.z, second.w, last, 4.0 * s.y * s.z);
            return Rotated(at.light + a.light + b.light + c.light, at.halfway + a.halfway + b.halfway + c.halfway);
        }
        default: {
            return at;
        }
    }
}

@fragment fn fragment_vectors(v: Interpolated, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let footprint = footprint_of(v.uv.xy, v.clip.w);
    let side = select(-1.0, 1.0, front);
    var parts = gather(footprint);
    var total = dark();
    for (var i = 0u; i < parts.count; i++) {
        let part = parts.sums[i];
        let n = unit_or(part.xyz, vec3f(0.0, 0.0, 1.0)) * side;
        total = plus(total, by_vectors(u32(part.w), n, v), parts.weights[i]);
    }
    return leave(total, footprint);
}

// Ambient, Lambert and Blinn-Phong layers by n·L' and n·H'.
fn by_vectors(material: u32, n: vec3f, v: Interpolated) -> Shade {
    let layers = layers_of(material);
    var sum = dark();
    for (var i = 0u; i < u.lights; i++) {
        let at = vectors_of(v, i);
        let cosine = dot(n, at.light);
        if !(cosine > 0.0) {
            continue;
        }
        let color = lamp(i, v.position.xyz).color;
        let half_cosine = max(dot(n, at.halfway), 0.0);
        var place = layers.x;
        for (var k = 0u; k < layers.y; k++) {
            let layer = layer_at(place);
            let reflected = material_texel(place + 1u).rgb * color * layer.weight;
            if layer.kind == LAMBERT {
                sum.diffuse += reflected * cosine;
            } else if layer.kind == BLINN_PHONG {
                sum.specular += reflected * power(half_cosine, layer.first);
            }
            place += layer.texels;
        }
    }
    return plus(sum, ambient_of(layers), 1.0);
}
