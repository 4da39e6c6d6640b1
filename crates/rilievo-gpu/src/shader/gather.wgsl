// The normals of a map under a pixel, summed for each material by itself.

struct Parts {
    // Sum of the normals, and the material.
    sums: array<vec4f, 8>,
    weights: array<f32, 8>,
    count: u32,
}

// Normal and material of a texel.
fn tap(texel: vec2i, level: i32) -> vec4f {
    if u.detail == INDEXED {
        let index = textureLoad(indices, texel, level).x;
        return textureLoad(normals, vec2u(index & 255u, index >> 8u), 0);
    }
    return vec4f(textureLoad(relief, texel, level).xyz, f32(textureLoad(kinds, texel, level).x));
}

fn map_size(level: i32) -> vec2i {
    if u.detail == INDEXED {
        return vec2i(textureDimensions(indices, level));
    }
    return vec2i(textureDimensions(relief, level));
}

fn add(parts: ptr<function, Parts>, tap: vec4f, weight: f32) {
    var i = 0u;
    while i < (*parts).count && (*parts).sums[i].w != tap.w {
        i++;
    }
    if i == (*parts).count {
        (*parts).sums[i] = vec4f(0.0, 0.0, 0.0, tap.w);
        (*parts).weights[i] = 0.0;
        (*parts).count++;
    }
    (*parts).sums[i] += vec4f(tap.xyz * weight, 0.0);
    (*parts).weights[i] += weight;
}

fn gather(footprint: Footprint) -> Parts {
    var parts: Parts;
    parts.count = 0u;
    if u.detail == SMOOTH {
        add(&parts, vec4f(0.0, 0.0, 1.0, 0.0), 1.0);
        return parts;
    }
    let at = in_copy(footprint, u.repeat.xy);
    if u.detail != INDEXED && u.kinds == 0u {
        add(&parts, vec4f(sample_relief(at), 0.0), 1.0);
        return parts;
    }
    let size = map_size(0);
    if u.filtering == NEAREST {
        add(&parts, tap(nearest(at, size), 0), 1.0);
        return parts;
    }
    let lod = lod_of(size, at, u.levels);
    for (var level = 0; level < levels_to_walk(); level++) {
        let share = share_of_level(lod, level);
        if share > 0.0 {
            let level_size = map_size(level);
            let corner = corner_of(at.uv, level_size);
            for (var k = 0u; k < 4u; k++) {
                add(&parts, tap(texel_of(corner, k, level_size), level), weight_of(corner, k) * share);
            }
        }
    }
    return parts;
}
