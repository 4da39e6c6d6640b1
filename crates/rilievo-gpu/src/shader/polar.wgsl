// The polar units E2 and E3, in whole numbers and to the bit: `rilievo-polar` says what each of them does. Words of 16
// bits: angles (a turn is 2^16) and values (Q2.14). Only what turns vectors into words is float.

const E3 = 1u;
const TURN = 65536.0;

// Directions and normals in the axes of a unit, whose pole is +Z: objects stand on +Y.
fn upright(v: vec3f) -> vec3f {
    return v.zxy;
}

fn angle(radians: f32) -> i32 {
    return i32(round(radians / (2.0 * PI) * TURN)) & 0xffff;
}

// Azimuth and polar angle.
fn words_of(v: vec3f) -> vec2i {
    let level = length(v.xy);
    if level == 0.0 {
        return vec2i(0, select(0x8000, 0, v.z >= 0.0));
    }
    return vec2i(angle(atan2(v.y, v.x)), angle(atan2(level, v.z)));
}

fn table_word(at: u32) -> i32 {
    return i32(textureLoad(table, vec2u(at & 255u, at >> 8u), 0).x);
}

// A quarter wave of 2^bits words, folded. The end of the quarter is wired to 1.
fn sine(word: i32) -> i32 {
    let bits = u.variant >> 8u;
    let dropped = 14u - bits;
    let entries = 1i << bits;
    let step = ((word & 0xffff) + ((1i << dropped) >> 1u)) >> dropped;
    let quadrant = step >> bits;
    var within = step & (entries - 1);
    if (quadrant & 1) == 1 {
        within = entries - within;
    }
    var magnitude = 16384;
    if within < entries {
        magnitude = table_word(u32(within));
    }
    return select(magnitude, -magnitude, (quadrant & 2) == 2);
}

fn cosine(word: i32) -> i32 {
    return sine(word + 16384);
}

fn value(word: u32) -> i32 {
    return i32(word << 16u) >> 16u;
}

// sin θ sin Δ
fn across(theta: i32, delta: i32) -> i32 {
    return (cosine(theta - delta) - cosine(theta + delta)) >> 1u;
}

// N'·V for a vector's words, the normal's, and those of the bump vector: Q2.14.
fn product(v: vec2i, normal: vec2i, bump: vec3u) -> i32 {
    let delta = (v.x - normal.x) & 0xffff;
    let theta = v.y;
    let k = (16384 + cosine(delta)) >> 1u;
    if (u.variant & 255u) == E3 {
        // The bump vector as (ξ, ρ, y): turning it is one addition.
        let along = (i32(bump.x) + normal.y) & 0xffff;
        let sum = cosine(theta + along);
        let difference = cosine(theta - along);
        let g = sum + (((difference - sum) * k) >> 14u);
        return (value(bump.y) * g + value(bump.z) * across(theta, delta)) >> 14u;
    }
    // E2: the vector, turned into the meridian frame.
    let sin_sum = sine(theta + normal.y);
    let sin_difference = sine(theta - normal.y);
    let cos_sum = cosine(theta + normal.y);
    let cos_difference = cosine(theta - normal.y);
    let x = (((sin_sum + sin_difference) * k) >> 14u) - sin_sum;
    let z = cos_sum + (((cos_difference - cos_sum) * k) >> 14u);
    return (x * value(bump.x) + across(theta, delta) * value(bump.y) + z * value(bump.z)) >> 14u;
}

// A word of a table of 2^10, by a product; as a share of one.
fn look_up(first: u32, product: i32) -> f32 {
    if product <= 0 {
        return 0.0;
    }
    return f32(table_word(first + u32(min(product >> 4u, 1023)))) / 65535.0;
}

// What the words of one texel say of all lights.
fn by_unit(bump: vec3u, material: u32, v: Surface, normal: vec3f, view: vec3f, side: i32) -> Shade {
    let words = words_of(normal);
    // The diffuse table follows the sine, the specular ones follow it.
    let diffuse = max(1u << (u.variant >> 8u), 256u);
    let layers = layers_of(material);
    var sum = dark();
    for (var i = 0u; i < u.lights; i++) {
        let light = lamp(i, v.position);
        if dot(light.toward, light.toward) == 0.0 {
            continue;
        }
        let l = upright(light.toward);
        let h = unit_or(l + view, normal);
        let nl = product(words_of(l), words, bump) * side;
        let nh = product(words_of(h), words, bump) * side;
        if nl <= 0 {
            continue;
        }
        var at = layers.x;
        for (var k = 0u; k < layers.y; k++) {
            let layer = layer_at(at);
            let color = material_texel(at + 1u).rgb * light.color * layer.weight;
            if layer.kind == LAMBERT {
                sum.diffuse += color * look_up(diffuse, nl);
            } else if layer.kind == BLINN_PHONG {
                sum.specular += color * look_up(diffuse + u32(layer.second), nh);
            }
            at += layer.texels;
        }
    }
    return plus(sum, ambient_of(layers), 1.0);
}

fn texel_by_unit(texel: vec2i, level: i32, v: Surface, normal: vec3f, view: vec3f, side: i32) -> Shade {
    let bump = textureLoad(indices, texel, level).xyz;
    var material = 0u;
    if u.kinds == 1u {
        material = textureLoad(kinds, texel, level).x;
    }
    return by_unit(bump, material, v, normal, view, side);
}

fn level_by_unit(uv: vec2f, level: i32, v: Surface, normal: vec3f, view: vec3f, side: i32) -> Shade {
    let size = vec2i(textureDimensions(indices, level));
    let corner = corner_of(uv, size);
    var sum = dark();
    for (var tap = 0u; tap < 4u; tap++) {
        let one = texel_by_unit(texel_of(corner, tap, size), level, v, normal, view, side);
        sum = plus(sum, one, weight_of(corner, tap));
    }
    return sum;
}

@fragment fn fragment_polar(v: Surface, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let footprint = footprint_of(v.uv, v.clip.w);
    let normal = unit_or(upright(v.normal), vec3f(0.0, 0.0, 1.0));
    let view = unit_or(upright(u.eye.xyz - v.position), normal);
    let side = select(-1, 1, front);
    if u.detail == SMOOTH {
        let flat_words = select(vec3u(0u, 0u, 16384u), vec3u(0u, 16384u, 0u), (u.variant & 255u) == E3);
        return leave(by_unit(flat_words, 0u, v, normal, view, side), footprint);
    }
    let at = in_copy(footprint, u.repeat.xy);
    let size = vec2i(textureDimensions(indices, 0));
    if u.filtering == NEAREST {
        return leave(texel_by_unit(nearest(at, size), 0, v, normal, view, side), footprint);
    }
    let lod = lod_of(size, at, u.levels);
    var lit = dark();
    for (var level = 0; level < levels_to_walk(); level++) {
        let share = share_of_level(lod, level);
        if share > 0.0 {
            lit = plus(lit, level_by_unit(at.uv, level, v, normal, view, side), share);
        }
    }
    return leave(lit, footprint);
}
