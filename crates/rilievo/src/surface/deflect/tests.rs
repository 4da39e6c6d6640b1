use std::f64::consts::{PI, TAU};

use glam::{Vec2, Vec3};
use proptest::prelude::*;

use super::*;
use crate::height::to_normals;
use crate::progress::Silent;
use crate::surface::MeshParts;
use crate::surface::shapes::{CUBE_ATLAS_REPEAT, CubeUvs, cube, plane, plane_grid, sphere, torus};

/// Heights 0 … 1 without any symmetry: two waves that tile, and a little noise.
fn bumpy(width: u32, height: u32, depth: f32) -> HeightMap {
    let heights = Grid::from_fn(width, height, |x, y| {
        let (u, v) = (f64::from(x) / f64::from(width), f64::from(y) / f64::from(height));
        let waves = (TAU * (2.0 * u + v)).sin() + 0.5 * (TAU * (v - u)).cos();
        let noise = f64::from((x * 7919 + y * 104_729) % 97) / 97.0;
        (0.5 + 0.25 * waves + 0.1 * noise) as f32 / 1.2
    });
    HeightMap::new(heights.unwrap(), depth).unwrap()
}

/// The largest angle, in radians, to what is expected, over covered texels; fails if there are none.
fn worst(result: &Deflected, expected: impl Fn(u32, u32) -> Normal<Object>) -> f64 {
    let (width, height) = result.normals.size();
    let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let covered = all.filter(|&at| result.covered[at]);
    let angles: Vec<f64> = covered.map(|(x, y)| result.normals[(x, y)].angle_to(expected(x, y))).collect();
    assert!(!angles.is_empty());
    angles.into_iter().fold(0.0, f64::max)
}

fn all_covered(result: &Deflected) -> bool {
    result.covered.texels().iter().all(|&c| c)
}

fn normals(mesh: &Mesh, map: &NormalMap<Tangent>, options: &Deflect) -> Deflected {
    deflect_normals(mesh, map, None, options, &Silent).unwrap()
}

fn heights(mesh: &Mesh, map: &HeightMap, options: &Deflect) -> Deflected {
    deflect_heights(mesh, map, None, Filter::Plane4, Edges::Wrap, options, &Silent).unwrap()
}

#[test]
fn uncovered_sources_stay_uncovered() {
    let (width, height) = (12, 8);
    let map = bumpy(width, height, 0.2);
    let tangent = to_normals(&map, Filter::Plane4, Edges::Wrap);
    let hole = |x: u32, y: u32| (3..6).contains(&x) && (2..5).contains(&y) || x == 11;
    let covered = Grid::from_fn(width, height, |x, y| !hole(x, y)).unwrap();
    let mesh = plane(1.5).unwrap();
    // Once at the same size, and three times at twice the size: a texel of the source is then 2 × 2 of the result.
    for (options, scale) in [
        (Deflect { gutter: 1, ..Deflect::new((width, height)) }, 1),
        (Deflect { gutter: 1, repeat: [3.0, 1.0], ..Deflect::new((6 * width, 2 * height)) }, 2),
    ] {
        let by = |covered| {
            [
                deflect_normals(&mesh, &tangent, covered, &options, &Silent).unwrap(),
                deflect_heights(&mesh, &map, covered, Filter::Plane4, Edges::Wrap, &options, &Silent).unwrap(),
            ]
        };
        for (full, holed) in by(None).into_iter().zip(by(Some(&covered))) {
            assert!(all_covered(&full));
            for y in 0..options.size.1 {
                for x in 0..options.size.0 {
                    let expected = !hole(x / scale % width, y / scale);
                    assert_eq!(holed.covered[(x, y)], expected, "{x}, {y} at {scale}");
                    if expected {
                        assert_eq!(holed.normals[(x, y)], full.normals[(x, y)]);
                    }
                }
            }
            // The gutter runs into the hole from its rim, one texel deep, and no further.
            let (left, top) = (3 * scale, 2 * scale);
            assert_eq!(holed.normals[(left, top + 1)], full.normals[(left - 1, top + 1)]);
            assert_eq!(holed.normals[(left + 1, top + 1)], Normal::Z);
        }
    }
    let wrong = Grid::filled(height, width, true).unwrap();
    let options = Deflect::new((width, height));
    assert!(deflect_normals(&mesh, &tangent, Some(&wrong), &options, &Silent).is_err());
    assert!(deflect_heights(&mesh, &map, Some(&wrong), Filter::Plane4, Edges::Wrap, &options, &Silent).is_err());
}

/// A normal from f64 numbers.
fn normal<S: crate::Space>(x: f64, y: f64, z: f64) -> Normal<S> {
    Normal::new(DVec3::new(x, y, z).as_vec3()).unwrap()
}

/// The mesh with other texture coordinates.
fn with_uvs(mesh: &Mesh, f: impl Fn(Vec2) -> Vec2) -> Mesh {
    Mesh::new(MeshParts {
        positions: mesh.positions().to_vec(),
        normals: mesh.normals().to_vec(),
        uvs: mesh.uvs().iter().map(|uv| f(*uv)).collect(),
        triangles: mesh.triangles().to_vec(),
    })
    .unwrap()
}

#[test]
fn plane_gets_the_flat_map() {
    let map = bumpy(37, 23, 0.2);
    let options = Deflect::new((37, 23));
    for mesh in [plane(37.0 / 23.0).unwrap(), plane_grid(37.0 / 23.0, 5, 4).unwrap()] {
        for edges in [Edges::Wrap, Edges::Clamp, Edges::Mirror] {
            for filter in [Filter::Plane4, Filter::Sobel] {
                let flat = to_normals(&map, filter, edges);
                let tilt = flat.texels().iter().map(|n| n.angle_to(Normal::Z)).fold(0.0, f64::max);
                assert!(tilt > 0.5, "the map must be bumpy for this to mean anything: {tilt}");
                let by_normals = normals(&mesh, &flat, &options);
                let by_heights = deflect_heights(&mesh, &map, None, filter, edges, &options, &Silent).unwrap();
                for result in [by_normals, by_heights] {
                    assert!(all_covered(&result) && result.overlaps == 0);
                    let angle = worst(&result, |x, y| flat[(x, y)].relabel());
                    assert!(angle < 4e-7, "{angle} rad");
                }
            }
        }
    }
}

#[test]
fn finer_result_interpolates_between_texels() {
    let left = normal(0.6, 0.0, 0.8);
    let map = Grid::new(2, 1, vec![left, Normal::Z]).unwrap();
    let result = normals(&plane(2.0).unwrap(), &map, &Deflect::new((8, 1)));
    // The centre of texel 3 lies 3/8 of the way from the first source texel to the second: (3 + ½) · 2/8 − ½.
    let expected = normal(0.6 * 0.625, 0.0, 0.8 * 0.625 + 0.375);
    assert!(result.normals[(3, 0)].angle_to(expected) < 1e-6);
}

#[test]
fn undisturbed_sphere_keeps_its_normals() {
    let flat = Grid::filled(4, 4, Normal::Z).unwrap();
    let level = HeightMap::new(Grid::filled(4, 4, 0.7).unwrap(), 0.3).unwrap();
    let (width, height) = (300, 150);
    let mesh = sphere(256, 128).unwrap();
    let options = Deflect::new((width, height));
    for result in [normals(&mesh, &flat, &options), heights(&mesh, &level, &options)] {
        assert_eq!(result.overlaps, 0);
        let angle = worst(&result, |x, y| {
            let (sin_lon, cos_lon) = (((f64::from(x) + 0.5) / f64::from(width) - 0.5) * TAU).sin_cos();
            let (sin_lat, cos_lat) = ((0.5 - (f64::from(y) + 0.5) / f64::from(height)) * PI).sin_cos();
            normal(cos_lat * sin_lon, sin_lat, cos_lat * cos_lon)
        });
        // Within a cell, linear interpolation is off by a quarter of the squared step, (2π / 256)² / 8 in each direction;
        // at the poles a triangle bends longitude by up to a quarter of a step times the ring's radius.
        assert!(angle < 4e-4, "{angle} rad");
    }
}

/// The normal of the displaced unit sphere at (u, v), by finite differences in f64.
fn displaced_sphere(u: f64, v: f64, height: impl Fn(f64, f64) -> f64) -> DVec3 {
    let surface = |u: f64, v: f64| {
        let ((sin_lon, cos_lon), (sin_lat, cos_lat)) = (((u - 0.5) * TAU).sin_cos(), ((0.5 - v) * PI).sin_cos());
        DVec3::new(cos_lat * sin_lon, sin_lat, cos_lat * cos_lon) * (1.0 + height(u, v))
    };
    let step = 1e-6;
    let along_u = surface(u + step, v) - surface(u - step, v);
    let along_v = surface(u, v + step) - surface(u, v - step);
    along_v.cross(along_u).normalize()
}

#[test]
fn bumps_on_a_sphere_point_the_right_way() {
    let (width, height) = (512u32, 256u32);
    let mesh = sphere(256, 128).unwrap();
    // The mean of |∂P/∂u| = 2π cos(latitude) over the area of the sphere.
    let map_width = PI * PI / 2.0;
    let depth = 0.004;
    // What remains is the central difference of the map and the height that Blinn leaves out, under 1 % of the tilt
    // together; at the pole, whose triangles cannot follow the circles of latitude, 5 %.
    for (place, u0, v0, tolerance) in
        [("front", 0.5, 0.5, 0.012), ("side", 0.75, 0.4, 0.012), ("seam", 0.0, 0.55, 0.012), ("top", 0.4, 0.1, 0.06)]
    {
        // A bell as round on the sphere as it gets: wider in u where the circles of latitude are smaller.
        let (spread_v, spread_u) = (0.03, 0.015 / (v0 * PI).sin());
        let bell = |u: f64, v: f64| {
            let du = (u - u0 + 0.5).rem_euclid(1.0) - 0.5;
            (-0.5 * ((du / spread_u).powi(2) + ((v - v0) / spread_v).powi(2))).exp()
        };
        let white = Grid::from_fn(width, height, |x, y| {
            bell((f64::from(x) + 0.5) / f64::from(width), (f64::from(y) + 0.5) / f64::from(height)) as f32
        });
        let map = HeightMap::new(white.unwrap(), depth).unwrap();
        let result = heights(&mesh, &map, &Deflect::new((width, height)));
        let (mut steepest, mut worst) = (0.0f64, 0.0f64);
        for y in 0..height {
            for x in 0..width {
                let (u, v) = ((f64::from(x) + 0.5) / f64::from(width), (f64::from(y) + 0.5) / f64::from(height));
                if !result.covered[(x, y)] || bell(u, v) < 1e-3 {
                    continue;
                }
                let [expected, smooth] = [1.0, 0.0]
                    .map(|on| displaced_sphere(u, v, |u, v| on * f64::from(depth) * map_width * bell(u, v)).as_vec3());
                let (expected, smooth) = (Normal::new(expected).unwrap(), Normal::new(smooth).unwrap());
                steepest = steepest.max(smooth.angle_to(expected));
                worst = worst.max(result.normals[(x, y)].angle_to(expected));
            }
        }
        let (steepest, worst) = (steepest.to_degrees(), worst.to_degrees());
        eprintln!("{place}: {worst:.3}° off at most, where the bump tilts by up to {steepest:.2}°");
        assert!(steepest > 5.0 && worst < tolerance * steepest, "{place}: {worst}° off, bump tilts {steepest}°");
    }
}

#[test]
fn up_the_picture_is_north_and_right_is_east() {
    let mesh = sphere(64, 32).unwrap();
    let tilted: NormalMap<Tangent> = Grid::filled(1, 1, normal(0.3, 0.5, 0.8)).unwrap();
    let result = normals(&mesh, &tilted, &Deflect::new((64, 32)));
    let size = DVec3::new(0.3, 0.5, 0.8).length();
    // Front, right and seam: just right of the centre, so the normals are those of the texel's own place within 3°.
    for ((x, y), east, up, out) in [
        ((32, 16), DVec3::X, DVec3::Y, DVec3::Z),
        ((48, 16), DVec3::NEG_Z, DVec3::Y, DVec3::X),
        ((0, 16), DVec3::NEG_X, DVec3::Y, DVec3::NEG_Z),
    ] {
        let expected = Normal::new(((0.3 * east + 0.5 * up + 0.8 * out) / size).as_vec3()).unwrap();
        let angle = result.normals[(x, y)].angle_to(expected).to_degrees();
        assert!(angle < 5.0, "({x}, {y}): {angle}°");
    }
}

#[test]
fn a_mirrored_texture_mirrors_the_bumps() {
    let map = bumpy(32, 32, 0.1);
    let flat = to_normals(&map, Filter::Plane4, Edges::Wrap);
    let options = Deflect::new((32, 32));
    let plain = plane_grid(1.0, 3, 3).unwrap();
    for (mirror, sx, sy) in [
        (with_uvs(&plain, |uv| Vec2::new(1.0 - uv.x, uv.y)), -1.0, 1.0),
        (with_uvs(&plain, |uv| Vec2::new(uv.x, 1.0 - uv.y)), 1.0, -1.0),
    ] {
        let expected = |x, y| {
            let n = flat[(x, y)].vec();
            Normal::new(Vec3::new(sx * n.x, sy * n.y, n.z)).unwrap()
        };
        for result in [normals(&mirror, &flat, &options), heights(&mirror, &map, &options)] {
            assert!(all_covered(&result));
            let angle = worst(&result, expected);
            assert!(angle < 1e-6, "{angle}");
        }
    }
}

/// Two squares side by side that share the middle edge and show the same texture, the left one mirrored.
fn mirrored_pair(left_first: bool) -> Mesh {
    let x = |i: usize| i as f32 - 1.0;
    let positions = (0..6).map(|i| Vec3::new(x(i % 3), 1.0 - (i / 3) as f32, 0.0)).collect();
    let uvs = (0..6).map(|i| Vec2::new(x(i % 3).abs(), (i / 3) as f32)).collect();
    let mut triangles = vec![[0, 3, 4], [0, 4, 1], [1, 4, 5], [1, 5, 2]];
    if !left_first {
        triangles.rotate_left(2);
    }
    Mesh::new(MeshParts { positions, normals: vec![], uvs, triangles }).unwrap()
}

#[test]
fn overlaps_are_counted_and_the_first_triangle_wins_without_cancelling_at_a_mirror_seam() {
    let map = bumpy(16, 16, 0.1);
    let flat = to_normals(&map, Filter::Plane4, Edges::Wrap);
    for (left_first, sign) in [(true, -1.0), (false, 1.0)] {
        let mesh = mirrored_pair(left_first);
        for result in [normals(&mesh, &flat, &Deflect::new((16, 16))), heights(&mesh, &map, &Deflect::new((16, 16)))] {
            assert_eq!(result.overlaps, 256);
            let angle = worst(&result, |x, y| {
                let n = flat[(x, y)].vec();
                Normal::new(Vec3::new(sign * n.x, n.y, n.z)).unwrap()
            });
            assert!(angle < 1e-6, "left first: {left_first}: {angle}");
        }
    }
}

#[test]
fn coordinates_outside_the_square_wrap() {
    let map = bumpy(16, 16, 0.1);
    let flat = to_normals(&map, Filter::Plane4, Edges::Wrap);
    let options = Deflect::new((16, 16));
    let plain = plane_grid(1.0, 2, 2).unwrap();
    for shift in [Vec2::new(3.0, -2.0), Vec2::new(0.25, -0.4375), Vec2::new(-7.7, 11.3)] {
        let mesh = with_uvs(&plain, |uv| uv + shift);
        for result in [normals(&mesh, &flat, &options), heights(&mesh, &map, &options)] {
            assert!(all_covered(&result), "{shift}");
            assert_eq!(result.overlaps, 0, "{shift}");
            // Coordinates of f32 far from zero are a little off.
            let angle = worst(&result, |x, y| flat[(x, y)].relabel());
            assert!(angle < 2e-6, "{shift}: {angle}");
        }
    }
    let twice = normals(&with_uvs(&plain, |uv| uv * 2.0), &flat, &options);
    assert_eq!(twice.overlaps, 256);
    let often = with_uvs(&plain, |uv| uv * 40.0);
    assert!(matches!(deflect_normals(&often, &flat, None, &options, &Silent), Err(Error::Parameter { .. })));
    // Nine tiles are few, but not at a size where their corners no longer fit the fixed point of the rasteriser.
    let long = with_uvs(&plane(1.0).unwrap(), |uv| Vec2::new(uv.x * 20.0, uv.y));
    assert!(deflect_normals(&long, &flat, None, &Deflect::new((65_536, 1)), &Silent).is_err());
}

#[test]
fn a_repeated_map_lies_on_each_face_of_the_cube() {
    // Only the top left quarter is tilted, to the upper right.
    let tilted = normal(0.4, 0.3, 0.8);
    let map = Grid::from_fn(8, 8, |x, y| if x < 4 && y < 4 { tilted } else { Normal::Z }).unwrap();
    let mesh = cube(CubeUvs::Atlas).unwrap();
    let options = Deflect { repeat: CUBE_ATLAS_REPEAT, ..Deflect::new((96, 64)) };
    let result = normals(&mesh, &map, &options);
    assert_eq!(result.overlaps, 0);
    for (k, quad) in mesh.positions().chunks_exact(4).enumerate() {
        // Vertices run from the top left, row by row.
        let (right, up) = ((quad[1] - quad[0]).as_dvec3(), (quad[0] - quad[2]).as_dvec3());
        let out = right.cross(up);
        let corner = mesh.uvs()[4 * k] * Vec2::new(96.0, 64.0);
        let at = |dx: u32, dy: u32| result.normals[(corner.x as u32 + dx, corner.y as u32 + dy)];
        let expected = Normal::new((0.4 * right + 0.3 * up + 0.8 * out).as_vec3()).unwrap();
        assert!(at(8, 8).angle_to(expected) < 1e-6, "face {k}");
        for (dx, dy) in [(24, 8), (8, 24), (24, 24)] {
            assert!(at(dx, dy).angle_to(Normal::new(out.as_vec3()).unwrap()) < 1e-6, "face {k}");
        }
    }
}

#[test]
fn gutter_fills_the_margins_of_the_atlas_from_the_nearest_face() {
    let flat = Grid::filled(1, 1, Normal::Z).unwrap();
    let mesh = cube(CubeUvs::Atlas).unwrap();
    let size = (192, 128);
    let result = normals(&mesh, &flat, &Deflect { gutter: 2, ..Deflect::new(size) });
    assert!(!all_covered(&result));
    let faces = [Vec3::NEG_X, Vec3::Z, Vec3::X, Vec3::Y, Vec3::NEG_Z, Vec3::NEG_Y];
    for y in 0..size.1 {
        for x in 0..size.0 {
            let face = faces[(x / 64 + 3 * (y / 64)) as usize];
            assert_eq!(result.normals[(x, y)].vec(), face, "({x}, {y})");
        }
    }
    let bare = normals(&mesh, &flat, &Deflect { gutter: 0, ..Deflect::new(size) });
    assert_eq!(bare.normals[(0, 0)], Normal::Z);
    assert_eq!(bare.covered, result.covered);
}

#[test]
fn heights_and_normals_agree_on_a_thin_torus() {
    // A thin ring is nearly a cylinder: a square map repeated 50 times around keeps its proportions within 2 %.
    let mesh = torus(800, 64, 50.0, 1.0).unwrap();
    let map = bumpy(32, 32, 0.15);
    let flat = to_normals(&map, Filter::Plane4, Edges::Wrap);
    let options = Deflect { repeat: [50.0, 1.0], ..Deflect::new((1600, 32)) };
    let by_normals = normals(&mesh, &flat, &options);
    let by_heights = heights(&mesh, &map, &options);
    assert!(all_covered(&by_normals) && by_normals.overlaps == 0);
    let angle = worst(&by_heights, |x, y| by_normals.normals[(x, y)]).to_degrees();
    eprintln!("thin torus: the two ways differ by at most {angle:.3}°");
    assert!(angle < 1.0, "{angle}°");
}

#[test]
fn texture_without_area_gives_no_nan() {
    let map = bumpy(8, 8, 0.1);
    let flat = to_normals(&map, Filter::Plane4, Edges::Wrap);
    let options = Deflect::new((8, 8));
    let point = with_uvs(&plane(1.0).unwrap(), |_| Vec2::splat(0.3));
    let result = normals(&point, &flat, &options);
    assert!(result.covered.texels().iter().all(|&c| !c) && result.normals.texels().iter().all(|n| *n == Normal::Z));
    let refused = deflect_heights(&point, &map, None, Filter::Plane4, Edges::Wrap, &options, &Silent);
    assert!(matches!(refused, Err(Error::Parameter { .. })));
    let bare = Mesh::new(MeshParts {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        triangles: vec![[0, 1, 2]],
        ..MeshParts::default()
    })
    .unwrap();
    assert!(matches!(deflect_normals(&bare, &flat, None, &options, &Silent), Err(Error::Missing { .. })));
}

#[test]
fn options_out_of_range_are_refused() {
    let (mesh, flat) = (plane(1.0).unwrap(), Grid::filled(1, 1, Normal::Z).unwrap());
    let good = Deflect::new((1, 1));
    assert_eq!(normals(&mesh, &flat, &good).normals[(0, 0)], Normal::Z);
    for bad in [
        Deflect { size: (0, 4), ..good },
        Deflect { gutter: MAX_GUTTER + 1, ..good },
        Deflect { repeat: [0.0, 1.0], ..good },
        Deflect { repeat: [1.0, f32::NAN], ..good },
        Deflect { repeat: [f32::INFINITY, 1.0], ..good },
    ] {
        assert!(deflect_normals(&mesh, &flat, None, &bad, &Silent).is_err(), "{bad:?}");
    }
}

#[test]
#[cfg(feature = "rayon")]
fn any_number_of_threads_gives_the_same_bits() {
    let (mesh, map) = (torus(20, 13, 1.0, 0.4).unwrap(), bumpy(33, 17, 0.1));
    let options = Deflect { repeat: [3.0, 2.0], ..Deflect::new((301, 203)) };
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| heights(&mesh, &map, &options))
    };
    assert_eq!(with(1), with(3));
}

proptest! {
    #[test]
    fn any_mesh_gives_unit_normals(
        coordinates in prop::collection::vec(prop::array::uniform5(-2.0f32..2.0), 6),
        picks in prop::collection::vec(prop::array::uniform3(0u32..6), 1..8),
        snap in any::<bool>(),
    ) {
        // On a coarse lattice, many triangles have no area, on the mesh or in the texture.
        let place = |c: f32| if snap { c.round() } else { c };
        let parts = MeshParts {
            positions: coordinates.iter().map(|c| Vec3::new(place(c[0]), place(c[1]), place(c[2]))).collect(),
            normals: vec![],
            uvs: coordinates.iter().map(|c| Vec2::new(place(c[3]), place(c[4]))).collect(),
            triangles: picks,
        };
        let Ok(mesh) = Mesh::new(parts) else { return Ok(()) };
        let map = bumpy(5, 3, 0.5);
        let options = Deflect { gutter: 3, ..Deflect::new((9, 7)) };
        let flat = to_normals(&map, Filter::Plane4, Edges::Wrap);
        let by_heights = deflect_heights(&mesh, &map, None, Filter::Plane4, Edges::Wrap, &options, &Silent);
        for result in deflect_normals(&mesh, &flat, None, &options, &Silent).into_iter().chain(by_heights) {
            for n in result.normals.texels() {
                prop_assert!((n.vec().length() - 1.0).abs() < 1e-6);
            }
        }
    }
}
