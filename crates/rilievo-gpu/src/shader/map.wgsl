// Which texels a pixel sees, and how much of each: as the CPU's renderer has it, so that pictures are the same.

// Texture coordinates of a pixel's centre, and how they change to the next pixel to the right and below.
struct Footprint {
    uv: vec2f,
    dx: vec2f,
    dy: vec2f,
}

// Differences of uv between pixels are no derivatives: a step may leave the triangle. Of uv/w and 1/w, which are
// linear on the screen, they are. `inverse_w` is the fragment's position.w.
fn footprint_of(uv: vec2f, inverse_w: f32) -> Footprint {
    let over_w = uv * inverse_w;
    let dx = (dpdx(over_w) - uv * dpdx(inverse_w)) / inverse_w;
    let dy = (dpdy(over_w) - uv * dpdy(inverse_w)) / inverse_w;
    return Footprint(uv, dx, dy);
}

// The footprint in one copy of the map: coordinates from 0 to 1.
fn in_copy(at: Footprint, repeat: vec2f) -> Footprint {
    return Footprint(place_in_copy(at.uv, repeat), at.dx * repeat, at.dy * repeat);
}

fn place_in_copy(t: vec2f, repeat: vec2f) -> vec2f {
    if u.edges == WRAP {
        return fract(t * repeat);
    }
    let mirrored = 1.0 - abs(1.0 - (t - 2.0 * floor(t * 0.5)));
    let square = select(mirrored, clamp(t, vec2f(0.0), vec2f(1.0)), u.edges == CLAMP);
    let inside = fract(square * repeat);
    // The far rim is the end of the last copy, not the start of one more.
    return select(inside, vec2f(1.0), (inside == vec2f(0.0)) & (square > vec2f(0.0)));
}

// The texel of a level, for one that may lie just beyond its border.
fn resolve(p: vec2i, size: vec2i) -> vec2i {
    if u.edges == WRAP {
        return (p + size) % size;
    }
    return clamp(p, vec2i(0), size - 1);
}

// log2 of the longer side of the footprint, in texels of the full-size level.
fn level_of_detail(size: vec2f, at: Footprint) -> f32 {
    let dx = at.dx * size;
    let dy = at.dy * size;
    return 0.5 * log2(max(max(dot(dx, dx), dot(dy, dy)), 1.2e-38));
}

// The texel under a pixel, full-size level.
fn nearest(at: Footprint, size: vec2i) -> vec2i {
    return resolve(vec2i(floor(at.uv * vec2f(size))), size);
}

// The four texels about a pixel: the first one and the share of the others.
struct Corner {
    first: vec2i,
    share: vec2f,
}

fn corner_of(uv: vec2f, size: vec2i) -> Corner {
    let p = uv * vec2f(size) - 0.5;
    return Corner(vec2i(floor(p)), fract(p));
}

// The weight of tap 0 to 3 of a corner, and where it lies.
fn weight_of(corner: Corner, tap: u32) -> f32 {
    let x = select(1.0 - corner.share.x, corner.share.x, (tap & 1u) == 1u);
    let y = select(1.0 - corner.share.y, corner.share.y, tap >= 2u);
    return x * y;
}

fn texel_of(corner: Corner, tap: u32, size: vec2i) -> vec2i {
    return resolve(corner.first + vec2i(i32(tap & 1u), i32(tap >> 1u)), size);
}

// Where between the levels a pixel is; level 0 unless they are mixed.
fn lod_of(size: vec2i, at: Footprint, count: u32) -> f32 {
    if u.filtering != TRILINEAR {
        return 0.0;
    }
    return clamp(level_of_detail(vec2f(size), at), 0.0, f32(count - 1u));
}

// How many levels may have a share. Texel fetches walk all of them and do not jump to the two they need: some drivers take
// the level of a fetch from one pixel of four.
fn levels_to_walk() -> i32 {
    return select(1, i32(u.levels), u.filtering == TRILINEAR);
}

fn share_of_level(lod: f32, level: i32) -> f32 {
    return max(1.0 - abs(lod - f32(level)), 0.0);
}

// Levels are chosen and mixed here: what hardware does between two levels is cheaper than it should be on some.
fn sample_relief(at: Footprint) -> vec3f {
    let lod = lod_of(vec2i(textureDimensions(relief, 0)), at, u.levels);
    let finer = textureSampleLevel(relief, sampling, at.uv, floor(lod)).rgb;
    if fract(lod) == 0.0 {
        return finer;
    }
    return mix(finer, textureSampleLevel(relief, sampling, at.uv, floor(lod) + 1.0).rgb, fract(lod));
}

fn sample_gloss(at: Footprint) -> vec3f {
    let lod = lod_of(vec2i(textureDimensions(gloss, 0)), at, u.levels);
    let finer = textureSampleLevel(gloss, sampling, at.uv, floor(lod)).rgb;
    if fract(lod) == 0.0 {
        return finer;
    }
    return mix(finer, textureSampleLevel(gloss, sampling, at.uv, floor(lod) + 1.0).rgb, fract(lod));
}

fn base_color(footprint: Footprint) -> vec3f {
    if u.base_levels == 0u {
        return vec3f(1.0);
    }
    let at = in_copy(footprint, u.repeat.zw);
    let lod = lod_of(vec2i(textureDimensions(base, 0)), at, u.base_levels);
    let finer = textureSampleLevel(base, sampling, at.uv, floor(lod)).rgb;
    if fract(lod) == 0.0 {
        return finer;
    }
    return mix(finer, textureSampleLevel(base, sampling, at.uv, floor(lod) + 1.0).rgb, fract(lod));
}
