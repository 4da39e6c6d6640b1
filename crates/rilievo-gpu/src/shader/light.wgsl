// All lighting models, one normal at a time: `rilievo::light::shade` in the words of a GPU. A test holds the two together.

const LEAST_POWER = 1e-30;
const BRIGHTEST = 1e6;
const PI = 3.14159265;

const AMBIENT = 0u;
const LAMBERT = 1u;
const STEPS = 2u;
const CARTOON = 3u;
const PHONG = 4u;
const BLINN_PHONG = 5u;
const DOUBLED_ANGLE = 6u;
const CHROME = 7u;
const ENVIRONMENT = 8u;
const METALLIC_ROUGHNESS = 9u;

fn unit_or(v: vec3f, otherwise: vec3f) -> vec3f {
    let length = length(v);
    return select(otherwise, v / length, length > 1e-30);
}

struct Lamp {
    // The unit vector from the surface; zero at the light itself.
    toward: vec3f,
    color: vec3f,
}

fn lamp(i: u32, p: vec3f) -> Lamp {
    let place = textureLoad(lights, vec2u(2u * i, 0u), 0);
    let color = textureLoad(lights, vec2u(2u * i + 1u, 0u), 0);
    if place.w == 0.0 {
        return Lamp(place.xyz, color.rgb);
    }
    let away = place.xyz - p;
    var shown = color.rgb;
    // The distance at which the colour is meant; less than none: it does not fall off.
    if color.w >= 0.0 {
        let square = dot(away, away);
        let falloff = color.w * color.w / max(square, 1e-30);
        shown *= select(min(falloff, BRIGHTEST), 0.0, color.w == 0.0);
    }
    return Lamp(unit_or(away, vec3f(0.0)), shown);
}

// A material's first layer and how many it has.
fn layers_of(material: u32) -> vec2u {
    return vec2u(material_texel(material).xy);
}

fn material_texel(i: u32) -> vec4f {
    return textureLoad(materials, vec2u(i & 255u, i >> 8u), 0);
}

// The head of a layer: kind and texels, weight, and two parameters.
struct Layer {
    kind: u32,
    texels: u32,
    weight: f32,
    first: f32,
    second: f32,
}

fn layer_at(i: u32) -> Layer {
    let head = material_texel(i);
    let word = u32(head.x);
    return Layer(word & 15u, word >> 4u, head.y, head.z, head.w);
}

fn luminance(c: vec3f) -> f32 {
    return dot(c, vec3f(0.2126, 0.7152, 0.0722));
}

// `root` to the power, 0 for what is below 0 or too dark to see.
fn power(root: f32, exponent: f32) -> f32 {
    if root <= 0.0 {
        return select(0.0, 1.0, exponent == 0.0);
    }
    let raised = pow(root, exponent);
    return select(raised, 0.0, raised < LEAST_POWER);
}

fn mirrored(n: vec3f, v: vec3f) -> vec3f {
    return n * (2.0 * dot(n, v)) - v;
}

fn shade(material: u32, n: vec3f, view: vec3f, p: vec3f) -> Shade {
    let layers = layers_of(material);
    var sum = dark();
    var brightness = 0.0;
    for (var i = 0u; i < u.lights; i++) {
        let light = lamp(i, p);
        let cosine = dot(n, light.toward);
        if !(cosine > 0.0) {
            continue;
        }
        brightness += luminance(light.color) * cosine;
        var at = layers.x;
        for (var k = 0u; k < layers.y; k++) {
            let layer = layer_at(at);
            let by_one = by_light(layer, at, n, light.toward, view, cosine);
            sum.diffuse += by_one.diffuse * light.color * layer.weight;
            sum.specular += by_one.specular * light.color * layer.weight;
            at += layer.texels;
        }
    }
    var at = layers.x;
    for (var k = 0u; k < layers.y; k++) {
        let layer = layer_at(at);
        sum = plus(sum, by_all(layer, at, n, view, brightness), layer.weight);
        at += layer.texels;
    }
    return sum;
}

// The answer to light from everywhere, of materials that say no more of it.
fn ambient_of(layers: vec2u) -> Shade {
    var sum = dark();
    var at = layers.x;
    for (var k = 0u; k < layers.y; k++) {
        let layer = layer_at(at);
        if layer.kind == AMBIENT {
            sum.diffuse += u.ambient.rgb * material_texel(at + 1u).rgb * layer.weight;
        }
        at += layer.texels;
    }
    return sum;
}

// The answer to one white light.
fn by_light(layer: Layer, at: u32, n: vec3f, l: vec3f, view: vec3f, cosine: f32) -> Shade {
    let color = material_texel(at + 1u).rgb;
    switch layer.kind {
        case LAMBERT: {
            return Shade(color * cosine, vec3f(0.0));
        }
        case STEPS: {
            return Shade(color * (floor(cosine * layer.first + 0.5) / layer.first), vec3f(0.0));
        }
        case PHONG: {
            return Shade(vec3f(0.0), color * power(dot(mirrored(n, view), l), layer.first));
        }
        case BLINN_PHONG: {
            let h = unit_or(l + view, vec3f(0.0));
            return Shade(vec3f(0.0), color * power(dot(n, h), layer.first));
        }
        case DOUBLED_ANGLE: {
            let c = dot(mirrored(n, view), l);
            return Shade(vec3f(0.0), color * power(2.0 * c * c - 1.0, layer.first));
        }
        case METALLIC_ROUGHNESS: {
            return facet_by_light(color, layer.first, layer.second, n, l, view, cosine);
        }
        default: {
            return dark();
        }
    }
}

// The answer to what comes from everywhere.
fn by_all(layer: Layer, at: u32, n: vec3f, view: vec3f, brightness: f32) -> Shade {
    let color = material_texel(at + 1u);
    switch layer.kind {
        case AMBIENT: {
            return Shade(u.ambient.rgb * color.rgb, vec3f(0.0));
        }
        case CARTOON: {
            var band = color.rgb;
            for (var k = 1u; k < u32(layer.first); k++) {
                let next = material_texel(at + 1u + k);
                band = select(band, next.rgb, brightness >= next.w);
            }
            return Shade(band, vec3f(0.0));
        }
        case CHROME: {
            let up = transpose(u.to_sky) * vec3f(0.0, 1.0, 0.0);
            return Shade(vec3f(0.0), landscape(at + 1u, dot(mirrored(n, view), up)));
        }
        case ENVIRONMENT: {
            return Shade(vec3f(0.0), reflected(n, view, layer.first) * color.rgb);
        }
        case METALLIC_ROUGHNESS: {
            let mirrored = reflected(n, view, layer.second);
            return facet_by_all(color.rgb, layer.first, layer.second, mirrored, dot(n, view));
        }
        default: {
            return dark();
        }
    }
}

// Zenith, sky, ground and nadir follow one another.
fn landscape(at: u32, elevation: f32) -> vec3f {
    let up = clamp(elevation, 0.0, 1.0);
    let down = clamp(-elevation, 0.0, 1.0);
    let sky = mix(material_texel(at + 1u).rgb, material_texel(at).rgb, up);
    let ground = mix(material_texel(at + 2u).rgb, material_texel(at + 3u).rgb, down);
    return mix(ground, sky, clamp(elevation / 0.04 + 0.5, 0.0, 1.0));
}

// GGX, Smith by height, Schlick: glTF 2.0, appendix B.
fn facet_by_light(base: vec3f, metallic: f32, roughness: f32, n: vec3f, l: vec3f, view: vec3f, nl: f32) -> Shade {
    let halfway = l + view;
    if dot(halfway, halfway) < 1e-30 {
        return dark();
    }
    let h = normalize(halfway);
    let nv = max(dot(n, view), 1e-4);
    let nh = max(dot(n, h), 0.0);
    let vh = clamp(dot(view, h), 0.0, 1.0);
    let a = max(roughness * roughness, 0.002);
    // sin² by the cross product, which does not cancel in the middle of a highlight.
    let sine = cross(n, h);
    let k = a / (dot(sine, sine) + (a * nh) * (a * nh));
    let toward_eye = nv * sqrt(a * a + (1.0 - a * a) * nl * nl);
    let toward_light = nl * sqrt(a * a + (1.0 - a * a) * nv * nv);
    let glossy = k * k * 0.5 / (toward_eye + toward_light) * nl;
    let away = 1.0 - vh;
    let s = away * away * away * away * away;
    let dielectric = 0.04 + 0.96 * s;
    return split(base, metallic, nl * (1.0 - dielectric), vec3f(glossy * dielectric, glossy * (1.0 - s), glossy * s));
}

// Karis 2014, "Physically Based Shading on Mobile".
fn facet_by_all(base: vec3f, metallic: f32, roughness: f32, mirrored: vec3f, cosine: f32) -> Shade {
    let nv = max(cosine, 1e-4);
    let r = roughness * vec4f(-1.0, -0.0275, -0.572, 0.022) + vec4f(1.0, 0.0425, 1.04, -0.04);
    let grazing = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
    let scale = -1.04 * grazing + r.z;
    let bias = 1.04 * grazing + r.w;
    let dielectric = 0.04 * scale + bias;
    let specular = split(base, metallic, 0.0, vec3f(dielectric, scale, bias));
    let diffuse = split(base, metallic, 1.0 - dielectric, vec3f(0.0));
    return Shade(diffuse.diffuse * u.ambient.rgb + specular.diffuse * mirrored, specular.specular * mirrored);
}

// Dielectric and metal, mixed: `specular` is the one's, and the other's with and without its tint.
fn split(base: vec3f, metallic: f32, diffuse: f32, specular: vec3f) -> Shade {
    let tinted = base * ((1.0 - metallic) * diffuse + metallic * specular.y);
    return Shade(tinted, vec3f((1.0 - metallic) * specular.x + metallic * specular.z));
}

// What a mirror shows.
fn reflected(n: vec3f, view: vec3f, roughness: f32) -> vec3f {
    if u.sky_levels == 0u {
        return u.ambient.rgb;
    }
    let normal = u.to_sky * n;
    let eye = u.to_sky * view;
    if u.matcap == 1u {
        let side = vec3f(eye.z, 0.0, -eye.x);
        let right = select(vec3f(1.0, 0.0, 0.0), normalize(side), length(side) > 1e-6);
        return sky(0u, vec2f(dot(normal, right), dot(normal, cross(eye, right))) * 0.99);
    }
    let at = to_square(mirrored(normal, eye));
    let last = u.sky_levels - 1u;
    let place = clamp(roughness, 0.0, 1.0) * f32(last);
    let level = min(u32(place), last);
    let share = place - f32(level);
    let near = sky(level, at);
    if level == last || share == 0.0 {
        return near;
    }
    return mix(near, sky(level + 1u, at), share);
}

// The octahedron's square, its middle at +Z (Meyer et al. 2010).
fn to_square(d: vec3f) -> vec2f {
    let sum = abs(d.x) + abs(d.y) + abs(d.z);
    let p = d.xy / sum;
    if d.z >= 0.0 {
        return p;
    }
    return (1.0 - abs(p.yx)) * select(vec2f(-1.0), vec2f(1.0), p >= vec2f(0.0));
}

// Four texels of a copy, mixed; each copy has a border of one texel.
fn sky(level: u32, at: vec2f) -> vec3f {
    let copy = u.sky[level];
    let size = vec2f(copy.yz);
    let p = clamp(vec2f(at.x * 0.5 + 0.5, 0.5 - at.y * 0.5) * size + 0.5, vec2f(0.0), size + 0.999);
    let first = min(vec2u(p), copy.yz);
    let f = p - vec2f(first);
    let origin = first + vec2u(0u, copy.x);
    let top = mix(sky_texel(origin), sky_texel(origin + vec2u(1u, 0u)), f.x);
    let below = mix(sky_texel(origin + vec2u(0u, 1u)), sky_texel(origin + vec2u(1u, 1u)), f.x);
    return mix(top, below, f.y);
}

fn sky_texel(at: vec2u) -> vec3f {
    return textureLoad(surroundings, at, 0).rgb;
}
