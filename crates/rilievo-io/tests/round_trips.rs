//! What is written comes back; and independent readers agree.
#![expect(clippy::unwrap_used, reason = "test helpers fail loudly")]

use rilievo::normal::{encode_u8, encode_u16};
use rilievo::{
    Convention, Grid, MaterialSpan, MipChain, Normal, NormalMap, NormalTable, Object, QuantizedMap, Tangent,
};
use rilievo_io::*;
use testkit::{Random, uniform_sphere};

fn source(bytes: Vec<u8>) -> Source {
    Source::from_bytes("map", bytes)
}

fn worst_deg<S: rilievo::Space>(a: &NormalMap<S>, b: &NormalMap<S>) -> f64 {
    assert_eq!(a.size(), b.size());
    let angles = a.texels().iter().zip(b.texels()).map(|(a, &b)| a.angle_to(b));
    angles.fold(0.0, f64::max).to_degrees()
}

/// A map of `size` with `entries` entries in three materials (one, if there are too few entries).
fn map(size: (u32, u32), entries: usize) -> QuantizedMap<Object> {
    let k = entries as u32;
    let cuts = if k < 3 { vec![(5, 0..k)] } else { vec![(0, 0..1), (3, 1..k / 2 + 1), (255, k / 2 + 1..k)] };
    let spans = cuts.into_iter().filter(|(_, e)| !e.is_empty());
    let spans = spans.map(|(material, entries)| MaterialSpan { material, entries }).collect();
    let table = NormalTable::with_materials(uniform_sphere(entries, 17), spans).unwrap();
    let mut random = Random::new(9);
    let base = Grid::from_fn(size.0, size.1, |_, _| (random.bits() % entries as u64) as u16).unwrap();
    QuantizedMap::new(table, MipChain::build(base, |block| *block[0])).unwrap()
}

fn check_table(read: &QuantizedMap<Object>, written: &QuantizedMap<Object>) {
    assert_eq!(read.table().spans(), written.table().spans());
    let codes = |m: &QuantizedMap<Object>| m.table().normals().iter().map(|&n| encode_u16(n)).collect::<Vec<_>>();
    let steps = codes(read).into_iter().flatten().zip(codes(written).into_iter().flatten());
    assert!(steps.into_iter().all(|(a, b)| a.abs_diff(b) <= 1), "table differs by more than 16 bits hold");
    let pairs = read.table().normals().iter().zip(written.table().normals());
    let worst = pairs.map(|(a, &b)| a.angle_to(b)).fold(0.0, f64::max).to_degrees();
    assert!(worst < 0.0017, "{worst}");
}

fn object(file: IndexedFile) -> QuantizedMap<Object> {
    assert_eq!(file.warnings, Vec::<String>::new());
    let AnyIndexed::Object(map) = file.map else { panic!("not in object space") };
    map
}

#[test]
fn normals_of_16_bits_and_floats_keep_their_directions() {
    let normals = uniform_sphere::<Tangent>(41 * 29, 1);
    let all = Grid::new(41, 29, normals).unwrap();
    let limits = Limits::default();
    for convention in [Convention::Gl, Convention::Dx] {
        let png = source(encode_normals_png16(&all, convention, None).unwrap());
        let back = decode_normals(&png, convention, &limits).unwrap();
        assert!(worst_deg(&back.normals, &all) <= 0.003 && back.depth == Depth::U16);
        let exr = source(encode_normals_exr(&all, convention, None).unwrap());
        let back = decode_normals(&exr, convention, &limits).unwrap();
        assert!(worst_deg(&back.normals, &all) <= 1e-5 && back.depth == Depth::F32 && back.covered.is_none());
    }
    let gl = source(encode_normals_png16(&all, Convention::Gl, None).unwrap());
    let flipped = decode_normals::<Tangent>(&gl, Convention::Dx, &limits).unwrap();
    assert!((flipped.normals.texels()[0].vec().y + all.texels()[0].vec().y).abs() < 1e-4);
    let png8 = source(encode_normals_png8(&all.map(|&n| encode_u8(n)), None).unwrap());
    let back = decode_normals(&png8, Convention::Gl, &limits).unwrap();
    // Half a step in each component: √3 / 255 rad.
    assert!(worst_deg(&back.normals, &all) < 0.4 && back.depth == Depth::U8);
}

#[test]
fn uncovered_texels_stay_uncovered_and_may_hold_anything() {
    let normals = Grid::new(5, 3, uniform_sphere::<Object>(15, 1)).unwrap();
    let covered = Grid::from_fn(5, 3, |x, y| (x + y) % 3 != 0).unwrap();
    let limits = Limits::default();
    for bytes in [
        encode_normals_png16(&normals, Convention::Gl, Some(&covered)).unwrap(),
        encode_normals_exr(&normals, Convention::Gl, Some(&covered)).unwrap(),
        encode_normals_png8(&normals.map(|&n| encode_u8(n)), Some(&covered)).unwrap(),
    ] {
        let back = decode_normals::<Object>(&source(bytes), Convention::Gl, &limits).unwrap();
        assert_eq!(back.covered.as_ref(), Some(&covered));
        let texels = back.normals.texels().iter().zip(covered.texels());
        assert!(texels.filter(|(_, c)| !**c).all(|(&n, _)| n == Normal::Z));
    }
}

/// An array of floats, height × width × 4, as NumPy writes it.
fn npy(width: u32, height: u32, channels: usize, values: &[f32]) -> Source {
    let bytes = testkit::write_npy_f32(&[height as usize, width as usize, channels], values);
    Source::from_bytes("floats.npy", bytes)
}

#[test]
fn floats_without_direction_are_counted_and_placed() {
    let limits = Limits::default();
    let mut values = [0.0, 0.0, 1.0, 1.0].repeat(6);
    values[4..8].copy_from_slice(&[f32::NAN, 0.0, 1.0, 1.0]);
    values[20..24].copy_from_slice(&[0.0, 0.0, 0.0, 1.0]);
    let decode = |v: &[f32]| decode_normals::<Tangent>(&npy(3, 2, 4, v), Convention::Gl, &limits);
    let message = decode(&values).unwrap_err().to_string();
    assert!(message.contains("2 texels") && message.contains("(1, 0)"), "{message}");
    (values[7], values[23]) = (0.0, 0.0);
    let map = decode(&values).unwrap();
    assert_eq!((map.normals[(1, 0)], map.normals[(2, 1)]), (Normal::Z, Normal::Z));
    assert_eq!(map.covered.unwrap().texels(), [true, false, true, true, true, false]);

    let message = decode_height(&npy(2, 2, 1, &[0.0, 1.0, f32::INFINITY, f32::NAN]), &limits).unwrap_err().to_string();
    assert!(message.contains("2 heights") && message.contains("(0, 1)"), "{message}");
    let metres = decode_height(&npy(2, 1, 1, &[-3.5, 7.0]), &limits).unwrap();
    assert_eq!(metres.heights.texels(), [-3.5, 7.0]);
    assert!(metres.warnings.len() == 1 && metres.warnings[0].contains("from -3.5 to 7,"), "{:?}", metres.warnings);
    assert!(decode_height(&npy(2, 1, 1, &[-1.0, 2.0]), &limits).unwrap().warnings.is_empty());
    // What is not covered has no height.
    assert!(decode_height(&npy(2, 1, 2, &[0.5, 1.0, 9.0, 0.0]), &limits).unwrap().warnings.is_empty());
}

#[test]
fn indexed_png_round_trips_in_every_bit_depth() {
    for entries in [1, 2, 3, 4, 5, 16, 17, 255, 256] {
        for size in [(1, 1), (13, 7), (8, 3)] {
            for convention in [Convention::Gl, Convention::Dx] {
                let written = map(size, entries);
                let bytes = encode_indexed_png(&written, convention).unwrap();
                let bits = match entries {
                    0..=2 => 1,
                    3..=4 => 2,
                    5..=16 => 4,
                    _ => 8,
                };
                assert_eq!(bytes[24..26], [bits, 3], "bit depth and colour type");
                let file = decode_indexed(&source(bytes.clone()), &ImportAs::default(), &Limits::default()).unwrap();
                assert_eq!((file.convention, file.map.entries(), file.map.size()), (convention, entries, size));
                let read = object(file);
                assert_eq!(read.base(), written.base());
                check_table(&read, &written);
                // Any program that shows the picture shows the normals in 8 bits.
                let seen = decode_normals::<Object>(&source(bytes), convention, &Limits::default()).unwrap();
                assert!(worst_deg(&seen.normals, &written.expand()) < 0.4);
            }
        }
    }
    assert!(matches!(encode_indexed_png(&map((2, 2), 257), Convention::Gl), Err(Error::Unsupported { .. })));
}

#[test]
fn ktx2_round_trips_with_all_levels() {
    for entries in [1, 256, 257, 5000, 65_536] {
        for size in [(1, 1), (33, 17), (64, 64)] {
            let written = map(size, entries);
            let bytes = encode_ktx2(&written, Convention::Dx).unwrap();
            let file = decode_indexed(&source(bytes), &ImportAs::default(), &Limits::default()).unwrap();
            assert_eq!((file.convention, file.map.levels()), (Convention::Dx, written.indices().levels().len()));
            let read = object(file);
            assert_eq!(read.indices(), written.indices());
            check_table(&read, &written);
        }
    }
}

#[test]
fn ktx2_passes_an_independent_reader() {
    for (entries, format, bytes_each) in [(200, ktx2::Format::R8_UINT, 1), (2048, ktx2::Format::R16_UINT, 2)] {
        let written = map((50, 20), entries);
        let bytes = encode_ktx2(&written, Convention::Gl).unwrap();
        let reader = ktx2::Reader::new(&bytes).unwrap();
        let header = reader.header();
        assert_eq!((header.format, header.type_size), (Some(format), bytes_each));
        assert_eq!((header.pixel_width, header.pixel_height, header.pixel_depth), (50, 20, 0));
        assert_eq!((header.layer_count, header.face_count, header.level_count), (0, 1, 6));
        assert_eq!(header.supercompression_scheme, Some(ktx2::SupercompressionScheme::Zstandard));

        assert_eq!(reader.dfd_blocks().len(), 1);
        let dfd = reader.basic_dfd().unwrap();
        assert_eq!(dfd.color_model, Some(ktx2::ColorModel::RGBSDA));
        assert_eq!(dfd.transfer_function, Some(ktx2::TransferFunction::Linear));
        assert_eq!(dfd.sample_information.len(), 1);
        let sample = &dfd.sample_information[0];
        assert_eq!((sample.bit_offset, u32::from(sample.bit_length.get())), (0, 8 * bytes_each));
        assert_eq!((sample.channel_type, sample.lower, sample.upper), (0, 0, 1));

        let pairs: Vec<_> = reader.key_value_data().collect();
        let keys: Vec<_> = pairs.iter().map(|(k, _)| *k).collect();
        assert_eq!(keys, ["KTXorientation", "KTXwriter", "rilievo:table"]);
        assert_eq!(pairs[0].1, b"rd\0");
        assert!(reader.writer().unwrap().starts_with("rilievo"));

        for (level, grid) in reader.levels().zip(written.indices().levels()) {
            assert_eq!(level.uncompressed_byte_length, grid.texels().len() as u64 * u64::from(bytes_each));
            let raw = zstd::bulk::decompress(level.data, level.uncompressed_byte_length as usize).unwrap();
            let read: Vec<u16> = match bytes_each {
                1 => raw.iter().map(|&b| b.into()).collect(),
                _ => raw.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]])).collect(),
            };
            assert_eq!(read, grid.texels());
        }
        // Smallest level first in the file, and nothing between or behind.
        let field = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
        let index: Vec<(u64, u64)> = (0..6).map(|i| (field(80 + 24 * i), field(88 + 24 * i))).collect();
        assert_eq!(index[0].0 + index[0].1, bytes.len() as u64);
        assert!(index.windows(2).all(|w| w[1].0 + w[1].1 == w[0].0));
    }
}

#[test]
fn rewriting_the_palette_is_relighting_the_picture() {
    let written = map((23, 11), 77);
    let bytes = encode_indexed_png(&written, Convention::Dx).unwrap();
    let file = source(bytes.clone());
    let palette = PalettePng::parse(&file).unwrap();
    let table = palette.table(&ImportAs::default()).unwrap();
    let AnyTable::Object(normals) = &table.table else { panic!("not in object space") };
    assert_eq!((table.convention, normals.spans()), (Convention::Dx, written.table().spans()));

    let light = |n: &Normal<Object>| n.vec().to_array().map(|c| (c.abs() * 200.0) as u8);
    let colors: Vec<[u8; 3]> = normals.normals().iter().map(light).collect();
    let relit = palette.relit(&colors).unwrap();
    let picture = decode_picture(&source(relit.clone()), &Limits::default()).unwrap();
    let read = object(decode_indexed(&file, &ImportAs::default(), &Limits::default()).unwrap());
    assert_eq!(
        picture,
        read.expand().map(|n| {
            let [r, g, b] = light(n);
            rilievo::Rgba8::new(r, g, b, 255)
        })
    );

    let mut in_place = bytes.clone();
    relight_in_place(&mut in_place, &colors).unwrap();
    assert_eq!(in_place, relit);
    let changed: Vec<usize> = (0..bytes.len()).filter(|&i| bytes[i] != relit[i]).collect();
    assert!(changed[changed.len() - 1] - changed[0] < 77 * 3 + 4, "only the palette and its checksum change");
    assert!(matches!(palette.relit(&colors[1..]), Err(Error::Invalid { .. })));

    // What was relit is a picture: the exact table no longer fits, and that is said.
    let again = decode_indexed(&source(relit), &ImportAs::default(), &Limits::default()).unwrap();
    assert!(again.warnings[0].contains("nrTB") && again.convention == Convention::Dx, "{:?}", again.warnings);
}

#[test]
fn a_re_sorted_palette_is_read_as_normals_with_a_warning() {
    let written = map((16, 16), 256);
    let mut bytes = encode_indexed_png(&written, Convention::Gl).unwrap();
    let file = source(bytes.clone());
    let palette = PalettePng::parse(&file).unwrap();
    let mut colors = palette.colors().to_vec();
    colors.reverse();
    relight_in_place(&mut bytes, &colors).unwrap();
    let read = decode_indexed(&source(bytes), &ImportAs::default(), &Limits::default()).unwrap();
    assert!(read.warnings[0].contains("re-sorted"), "{:?}", read.warnings);
    let AnyIndexed::Object(read) = read.map else { panic!("the stated space is kept") };
    assert_eq!(read.table().spans().len(), 1);
    let pairs = read.table().normals().iter().zip(written.table().normals().iter().rev());
    let worst = pairs.map(|(a, &b)| a.angle_to(b)).fold(0.0, f64::max).to_degrees();
    assert!(worst < 0.4, "{worst}");
}

#[test]
fn materials_are_gray_values_or_palette_indices() {
    let limits = Limits::default();
    let numbers = Grid::from_fn(5, 2, |x, y| (x * 50 + y) as u8).unwrap();
    let gray = source(encode_gray_png8(&numbers).unwrap());
    assert_eq!(decode_materials(&gray, &limits).unwrap(), numbers);
    let indexed = map((6, 5), 13);
    let palette = source(encode_indexed_png(&indexed, Convention::Gl).unwrap());
    assert_eq!(decode_materials(&palette, &limits).unwrap(), indexed.base().map(|&i| i as u8));
    let sixteen = source(encode_gray_png16(&Grid::filled(2, 2, 0.5).unwrap()).unwrap());
    assert!(matches!(decode_materials(&sixteen, &limits), Err(Error::Format { .. })));
}

#[test]
fn tiff_of_all_depths_are_read() {
    use tiff::encoder::{TiffEncoder, colortype as ct};
    type Writer<'a> = TiffEncoder<std::io::Cursor<&'a mut Vec<u8>>>;
    let write = |run: &dyn Fn(&mut Writer)| {
        let mut bytes = Vec::new();
        run(&mut TiffEncoder::new(std::io::Cursor::new(&mut bytes)).unwrap());
        source(bytes)
    };
    let limits = Limits::default();
    let gray8 = write(&|t| t.write_image::<ct::Gray8>(2, 1, &[0, 51]).unwrap());
    assert_eq!(decode_height(&gray8, &limits).unwrap().heights.texels(), [0.0, 0.2]);
    let gray16 = write(&|t| t.write_image::<ct::Gray16>(2, 1, &[13_107, 65_535]).unwrap());
    let height = decode_height(&gray16, &limits).unwrap();
    assert_eq!((height.heights.texels(), height.depth), (&[0.2, 1.0][..], Depth::U16));
    let float = write(&|t| t.write_image::<ct::Gray32Float>(2, 1, &[-4.25, 1e6]).unwrap());
    assert_eq!(decode_height(&float, &limits).unwrap().heights.texels(), [-4.25, 1e6]);
    let rgb = write(&|t| t.write_image::<ct::RGB32Float>(1, 1, &[0.6, 0.0, -0.8]).unwrap());
    let normal = decode_normals::<Object>(&rgb, Convention::Gl, &limits).unwrap().normals.texels()[0];
    assert!((normal.vec() - glam::Vec3::new(0.6, 0.0, -0.8)).length() < 1e-6);
    let rgb16 = write(&|t| t.write_image::<ct::RGB16>(1, 1, &[0, 32_896, 65_535]).unwrap());
    assert_eq!(decode_picture(&rgb16, &limits).unwrap().texels(), [rilievo::Rgba8::new(0, 128, 255, 255)]);
    for source in [gray8, gray16, float, rgb, rgb16] {
        for length in 0..source.bytes().len() {
            let cut = Source::from_bytes("cut.tiff", source.bytes()[..length].to_vec());
            let _ = (decode_height(&cut, &limits), decode_normals::<Object>(&cut, Convention::Gl, &limits));
        }
    }
}

/// An 8-bit PNG of the given colours, one row.
fn png8(color: png::ColorType, texels: &[u8], width: u32) -> Source {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, 1);
    encoder.set_color(color);
    encoder.write_header().unwrap().write_image_data(texels).unwrap();
    source(bytes)
}

#[test]
fn materials_are_read_from_alpha_and_from_sub_cubes() {
    let limits = Limits::default();
    let read = |source: &Source, place| decode_normals_with_materials::<Object>(source, Convention::Gl, place, &limits);
    let rgba = png8(png::ColorType::Rgba, &[255, 128, 128, 0, 128, 128, 255, 9], 2);
    let (image, materials) = read(&rgba, EmbeddedMaterials::Alpha).unwrap();
    assert_eq!(materials.texels(), [0, 9]);
    assert!(image.covered.is_none() && image.normals[(0, 0)].vec().x > 0.99 && image.normals[(1, 0)].vec().z > 0.99);
    let message = read(&png8(png::ColorType::Rgb, &[1, 2, 3], 1), EmbeddedMaterials::Alpha).unwrap_err().to_string();
    assert!(message.contains("no alpha"), "{message}");

    // Every direction, in every one of the four sub-cubes, comes back within half a step of 7 bits.
    for material in 0..4u8 {
        let (r, g) = (material >> 1, material & 1);
        let top = [r, g, r ^ g].map(|bit| bit << 7);
        let wanted = uniform_sphere::<Object>(500, u64::from(material));
        let encode = |n: &Normal<Object>| {
            let v = n.vec().to_array();
            [0, 1, 2].map(|k| top[k] | ((v[k] + 1.0) / 2.0 * 127.0 + 0.5) as u8)
        };
        let texels: Vec<u8> = wanted.iter().flat_map(encode).collect();
        let (image, materials) = read(&png8(png::ColorType::Rgb, &texels, 500), EmbeddedMaterials::SubCubes).unwrap();
        assert!(materials.texels().iter().all(|&m| m == material));
        let worst = image.normals.texels().iter().zip(&wanted).map(|(a, b)| a.angle_to(*b)).fold(0.0, f64::max);
        assert!(worst < 3f64.sqrt() / 127.0, "{worst}");
    }
    let message = read(&png8(png::ColorType::Rgb, &[0, 0, 0, 128, 0, 0], 2), EmbeddedMaterials::SubCubes)
        .unwrap_err()
        .to_string();
    assert!(message.contains("(1, 0)") && message.contains("sub-cube"), "{message}");
}

#[test]
fn long_levels_are_several_frames_and_any_decoder_joins_them() {
    // 4 MiB and a bit of two-byte indices.
    let written = map((2048, 1030), 300);
    let bytes = encode_ktx2(&written, Convention::Gl).unwrap();
    let reader = ktx2::Reader::new(&bytes).unwrap();
    let level = reader.levels().next().unwrap();
    let first = zstd::zstd_safe::find_frame_compressed_size(level.data).unwrap();
    assert!(first < level.data.len());
    assert_eq!(zstd::zstd_safe::find_frame_compressed_size(&level.data[first..]).unwrap(), level.data.len() - first);
    let whole = zstd::bulk::decompress(level.data, level.uncompressed_byte_length as usize).unwrap();
    let expected: Vec<u8> = written.base().texels().iter().flat_map(|i| i.to_le_bytes()).collect();
    assert!(whole == expected);
    let back = decode_indexed(&source(bytes), &ImportAs::default(), &Limits::default()).unwrap();
    assert_eq!(back.map.indices(), written.indices());
}
