// Shading by table: look up, then filter. Indices are never averaged (Tarini et al. 2000, section 5).

// Six square roots of ten bits, and a common power of two in the two bits on top of each word.
fn unpack(word: vec2u) -> Shade {
    let exponent = (word.x >> 30u) | ((word.y >> 30u) << 2u);
    let scale = exp2(f32(exponent)) / (1023.0 * 1023.0);
    let diffuse = vec3f(vec3u(word.x, word.x >> 10u, word.x >> 20u) & vec3u(1023u));
    let specular = vec3f(vec3u(word.y, word.y >> 10u, word.y >> 20u) & vec3u(1023u));
    return Shade(diffuse * diffuse * scale, specular * specular * scale);
}

fn entry(texel: vec2i, level: i32, first: u32) -> Shade {
    let index = textureLoad(indices, texel, level).x + first;
    return unpack(textureLoad(table, vec2u(index & 255u, index >> 8u), 0).xy);
}

fn level_by_table(uv: vec2f, level: i32, first: u32) -> Shade {
    let size = vec2i(textureDimensions(indices, level));
    let corner = corner_of(uv, size);
    var sum = dark();
    for (var tap = 0u; tap < 4u; tap++) {
        sum = plus(sum, entry(texel_of(corner, tap, size), level, first), weight_of(corner, tap));
    }
    return sum;
}

@fragment fn fragment_table(v: Textured, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let footprint = footprint_of(v.uv, v.clip.w);
    let at = in_copy(footprint, vec2f(1.0));
    let size = vec2i(textureDimensions(indices, 0));
    let first = select(u.back, 0u, front);
    if u.filtering == NEAREST {
        return leave(entry(nearest(at, size), 0, first), footprint);
    }
    let lod = lod_of(size, at, u.levels);
    var shade = dark();
    for (var level = 0; level < levels_to_walk(); level++) {
        let share = share_of_level(lod, level);
        if share > 0.0 {
            shade = plus(shade, level_by_table(at.uv, level, first), share);
        }
    }
    return leave(shade, footprint);
}
