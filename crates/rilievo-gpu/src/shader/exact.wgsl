// Shading by the pixel: normals are filtered and normalised, and the model is evaluated with the pixel's own view direction.

// A sum of the map's normals becomes a normal of the object.
fn to_object(sum: vec3f, v: Surface, plain: vec3f) -> vec3f {
    switch u.detail {
        case SMOOTH: {
            return plain;
        }
        // MikkTSpace: the frame as it is interpolated, and only the result is normalised.
        case TANGENT: {
            let local = unit_or(sum, vec3f(0.0, 0.0, 1.0));
            let bitangent = cross(v.normal, v.tangent.xyz) * v.tangent.w;
            return unit_or(v.tangent.xyz * local.x + bitangent * local.y + v.normal * local.z, plain);
        }
        default: {
            return unit_or(sum, plain);
        }
    }
}

@fragment fn fragment_exact(v: Surface, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let footprint = footprint_of(v.uv, v.clip.w);
    let plain = unit_or(v.normal, vec3f(0.0, 0.0, 1.0));
    let view = unit_or(u.eye.xyz - v.position, plain);
    let side = select(-1.0, 1.0, front);
    var parts = gather(footprint);
    var total = dark();
    for (var i = 0u; i < parts.count; i++) {
        let part = parts.sums[i];
        let n = to_object(part.xyz, v, plain) * side;
        total = plus(total, shade(u32(part.w), n, view, v.position), parts.weights[i]);
    }
    return leave(total, footprint);
}
