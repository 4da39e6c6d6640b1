//! PNG and APNG out.

use png::{BitDepth, ColorType, Encoder, EncodingError};
use rilievo::color::Picture;
use rilievo::normal::encode_u16;
use rilievo::{Convention, Grid, NormalMap, Rgba8, Space};

use crate::error::{Error, Result};

const NAME: &str = "PNG to be written";

/// 8-bit normals as an RGB PNG, or RGBA if some texel is uncovered. Without colour chunks: it is data.
///
/// # Errors
/// [`Error::Invalid`] if `covered` has another size.
pub fn encode_normals_png8(codes: &Grid<[u8; 3]>, covered: Option<&Grid<bool>>) -> Result<Vec<u8>> {
    let covered = only_partial(codes, covered)?;
    let (color, data) = match covered {
        None => (ColorType::Rgb, codes.texels().as_flattened().to_vec()),
        Some(covered) => {
            let texels = codes.texels().iter().zip(covered.texels());
            (ColorType::Rgba, texels.flat_map(|(&[r, g, b], &c)| [r, g, b, if c { 255 } else { 0 }]).collect())
        }
    };
    still(codes.size(), color, BitDepth::Eight, &data)
}

/// Normals as an RGB PNG of 16 bits, or RGBA if some texel is uncovered. Without colour chunks: it is data.
///
/// # Errors
/// [`Error::Invalid`] if `covered` has another size.
pub fn encode_normals_png16<S: Space>(
    map: &NormalMap<S>,
    convention: Convention,
    covered: Option<&Grid<bool>>,
) -> Result<Vec<u8>> {
    let covered = only_partial(map, covered)?;
    let codes = map.texels().iter().map(|&n| encode_u16(convention.apply(n)));
    let (color, data) = match covered {
        None => (ColorType::Rgb, codes.flatten().flat_map(u16::to_be_bytes).collect::<Vec<_>>()),
        Some(covered) => {
            let texel = |([r, g, b], &c): ([u16; 3], &bool)| [r, g, b, if c { u16::MAX } else { 0 }];
            let texels = codes.zip(covered.texels()).flat_map(texel);
            (ColorType::Rgba, texels.flat_map(u16::to_be_bytes).collect())
        }
    };
    still(map.size(), color, BitDepth::Sixteen, &data)
}

/// Values 0 … 1 as a gray PNG of 16 bits: floor(v · 65535 + 0.5); values outside are clipped.
///
/// # Errors
/// [`Error::Invalid`] if a value is NaN.
pub fn encode_gray_png16(values: &Grid<f32>) -> Result<Vec<u8>> {
    if let Some(index) = values.texels().iter().position(|v| v.is_nan()) {
        return Err(Error::invalid(NAME, rilievo::Error::NotFinite { what: "gray value", index }));
    }
    let encode = |&v: &f32| ((v.clamp(0.0, 1.0) * 65_535.0 + 0.5) as u16).to_be_bytes();
    let data: Vec<u8> = values.texels().iter().flat_map(encode).collect();
    still(values.size(), ColorType::Grayscale, BitDepth::Sixteen, &data)
}

/// Numbers as a gray PNG of 8 bits.
///
/// # Errors
/// None of its own; writing to memory does not fail.
pub fn encode_gray_png8(values: &Grid<u8>) -> Result<Vec<u8>> {
    still(values.size(), ColorType::Grayscale, BitDepth::Eight, values.texels())
}

/// A picture as an sRGB PNG; opaque pictures have no alpha channel.
///
/// # Errors
/// None of its own; writing to memory does not fail.
pub fn encode_picture_png(picture: &Picture) -> Result<Vec<u8>> {
    let (color, data) = pixels(picture, is_opaque(picture));
    encode(picture.size(), color, BitDepth::Eight, |mut encoder| {
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        write(encoder, &[&data])
    })
}

/// Pictures of one size as an animated PNG (sRGB) that loops for ever, each shown for `delay_ms`.
///
/// # Errors
/// [`Error::Invalid`] if there is no frame, or frames differ in size.
pub fn encode_apng(frames: &[Picture], delay_ms: u16) -> Result<Vec<u8>> {
    let Some(first) = frames.first() else {
        let e = rilievo::Error::Missing { what: "frames", remedy: "give at least one picture" };
        return Err(Error::invalid("APNG to be written", e));
    };
    for frame in frames {
        first.expect_same_size("frame", frame).map_err(|e| Error::invalid("APNG to be written", e))?;
    }
    let opaque = frames.iter().all(is_opaque);
    let data: Vec<_> = frames.iter().map(|f| pixels(f, opaque)).collect();
    let count = u32::try_from(frames.len()).unwrap_or(u32::MAX);
    encode(first.size(), data[0].0, BitDepth::Eight, |mut encoder| {
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        encoder.set_animated(count, 0)?;
        encoder.set_frame_delay(delay_ms, 1000)?;
        write(encoder, &data.iter().map(|(_, d)| d.as_slice()).collect::<Vec<_>>())
    })
}

/// The coverage if it has the map's size and some texel is uncovered.
fn only_partial<'a, T>(map: &Grid<T>, covered: Option<&'a Grid<bool>>) -> Result<Option<&'a Grid<bool>>> {
    if let Some(covered) = covered {
        map.expect_same_size("coverage", covered).map_err(|e| Error::invalid(NAME, e))?;
    }
    Ok(covered.filter(|c| c.texels().contains(&false)))
}

fn is_opaque(picture: &Picture) -> bool {
    picture.texels().iter().all(|p| p.a == 255)
}

fn pixels(picture: &Picture, opaque: bool) -> (ColorType, Vec<u8>) {
    if opaque {
        (ColorType::Rgb, picture.texels().iter().flat_map(|p| p.rgb()).collect())
    } else {
        (ColorType::Rgba, picture.texels().iter().flat_map(|&Rgba8 { r, g, b, a }| [r, g, b, a]).collect())
    }
}

fn still(size: (u32, u32), color: ColorType, depth: BitDepth, data: &[u8]) -> Result<Vec<u8>> {
    encode(size, color, depth, |encoder| write(encoder, &[data]))
}

/// Sets up an encoder that writes to memory, and runs it.
pub(crate) fn encode(
    (width, height): (u32, u32),
    color: ColorType,
    depth: BitDepth,
    run: impl FnOnce(Encoder<'_, &mut Vec<u8>>) -> Result<(), EncodingError>,
) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    run(encoder).map_err(|e| Error::write(NAME, std::io::Error::other(e)))?;
    Ok(bytes)
}

fn write(encoder: Encoder<'_, &mut Vec<u8>>, frames: &[&[u8]]) -> Result<(), EncodingError> {
    let mut writer = encoder.write_header()?;
    for frame in frames {
        writer.write_image_data(frame)?;
    }
    writer.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chunks::chunks;
    use rilievo::{Normal, Tangent};

    fn kinds(bytes: &[u8]) -> Vec<String> {
        let kind = |c: Result<crate::chunks::Chunk<'_>>| String::from_utf8(c.unwrap().kind.to_vec()).unwrap();
        chunks("a", bytes).unwrap().map(kind).collect()
    }

    #[test]
    fn data_maps_have_no_colour_chunks_and_alpha_only_where_needed() {
        let map: NormalMap<Tangent> = Grid::filled(3, 2, Normal::Z).unwrap();
        let all = Grid::filled(3, 2, true).unwrap();
        let mut holed = all.clone();
        holed[(1, 1)] = false;
        for (covered, color) in [(None, 2), (Some(&all), 2), (Some(&holed), 6)] {
            let eight = encode_normals_png8(&map.map(|_| [128, 128, 255]), covered).unwrap();
            for bytes in [eight, encode_normals_png16(&map, Convention::Gl, covered).unwrap()] {
                assert_eq!((kinds(&bytes), bytes[25]), (["IHDR", "IDAT", "IEND"].map(String::from).to_vec(), color));
            }
        }
        assert_eq!(kinds(&encode_gray_png8(&Grid::filled(5, 1, 7).unwrap()).unwrap()), ["IHDR", "IDAT", "IEND"]);
        assert!(encode_normals_png16(&map, Convention::Gl, Some(&Grid::filled(2, 2, true).unwrap())).is_err());
    }

    #[test]
    fn pictures_say_that_they_are_srgb_and_apngs_loop() {
        let frame = |v| Grid::filled(4, 3, Rgba8::new(v, 0, 0, 255)).unwrap();
        let still = encode_picture_png(&frame(9)).unwrap();
        assert!(kinds(&still).contains(&"sRGB".to_owned()) && still[25] == 2);
        let moving = encode_apng(&[frame(1), frame(2), frame(3)], 40).unwrap();
        let all = kinds(&moving);
        assert_eq!(all.iter().filter(|k| *k == "fcTL").count(), 3);
        let control = chunks("a", &moving).unwrap().map(Result::unwrap).find(|c| c.kind == *b"acTL").unwrap();
        assert_eq!(control.data, [0, 0, 0, 3, 0, 0, 0, 0]);
        assert!(encode_apng(&[], 40).is_err());
        assert!(encode_apng(&[frame(1), Grid::filled(1, 1, Rgba8::default()).unwrap()], 40).is_err());
    }

    #[test]
    fn gray_values_round_to_nearest_clip_and_refuse_nan() {
        let grid = |v: Vec<f32>| Grid::new(v.len() as u32, 1, v).unwrap();
        assert!(encode_gray_png16(&grid(vec![0.0, f32::NAN])).is_err());
        let source = crate::Source::from_bytes("a", encode_gray_png16(&grid(vec![-1.0, 0.5, 7.0])).unwrap());
        let back = crate::decode_height(&source, &crate::Limits::default()).unwrap();
        assert_eq!(back.heights.texels(), [0.0, 32_768.0 / 65_535.0, 1.0]);
    }
}
