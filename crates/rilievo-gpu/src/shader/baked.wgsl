// A light map, drawn as it is: baked once, or made anew by the CPU for each frame.

@fragment fn fragment_baked(v: Textured) -> @location(0) vec4f {
    let footprint = footprint_of(v.uv, v.clip.w);
    let at = in_copy(footprint, vec2f(1.0));
    let diffuse = sample_relief(at);
    let specular = sample_gloss(at);
    return leave(Shade(diffuse, specular), footprint);
}
