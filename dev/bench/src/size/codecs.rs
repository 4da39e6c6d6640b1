//! What normal maps are stored in elsewhere.

use anyhow::{Result, ensure};
use block_compression::encode::compress_rgba8;
use block_compression::{BC7Settings, CompressionVariant};
use rilievo::normal::decode_u8;
use rilievo::{Grid, Normal, NormalMap, Object};

/// As for our own files: slow to write, as fast to read as any other.
const ZSTD_LEVEL: i32 = 19;

/// Bytes of a file, and the normals that come out of it.
pub(super) struct Stored {
    pub(super) bytes: usize,
    pub(super) normals: NormalMap<Object>,
}

/// A map of octahedral codes: two components of so many bits.
pub(super) struct Octahedral {
    bits: u32,
    codes: Grid<[u8; 2]>,
}

/// The sphere unfolded to the square −1 … 1 (Meyer et al. 2010).
fn unfold([x, y, z]: [f32; 3]) -> [f32; 2] {
    let sum = x.abs() + y.abs() + z.abs();
    let (u, v) = (x / sum, y / sum);
    if z < 0.0 { [(1.0 - v.abs()).copysign(u), (1.0 - u.abs()).copysign(v)] } else { [u, v] }
}

fn fold(codes: [u8; 2], bits: u32) -> Normal<Object> {
    let [u, v] = codes.map(|c| f32::from(c) / ((1u32 << bits) - 1) as f32 * 2.0 - 1.0);
    let z = 1.0 - u.abs() - v.abs();
    let (x, y) = if z < 0.0 { ((1.0 - v.abs()).copysign(u), (1.0 - u.abs()).copysign(v)) } else { (u, v) };
    Normal::new_or([x, y, z].into(), Normal::Z)
}

/// The nearest of the four codes around: rounding alone is not always it (Cigolle et al. 2014, "precise").
fn octahedral_code(n: Normal<Object>, bits: u32) -> [u8; 2] {
    let top = ((1u32 << bits) - 1) as f32;
    let low = unfold(n.vec().to_array()).map(|c| ((c * 0.5 + 0.5) * top).floor().clamp(0.0, top - 1.0) as u8);
    let around = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|step: [u8; 2]| [low[0] + step[0], low[1] + step[1]]);
    let angle = |code: &[u8; 2]| fold(*code, bits).angle_to(n);
    around.into_iter().min_by(|a, b| angle(a).total_cmp(&angle(b))).unwrap_or(low)
}

/// A map as octahedral codes of up to 8 bits a component.
pub(super) fn octahedral(normals: &NormalMap<Object>, bits: u32) -> Result<Octahedral> {
    ensure!((1..=8).contains(&bits), "codes are bytes");
    Ok(Octahedral { bits, codes: normals.map(|&n| octahedral_code(n, bits)) })
}

impl Octahedral {
    fn normals(&self) -> NormalMap<Object> {
        self.codes.map(|&code| fold(code, self.bits))
    }

    fn interleaved(&self) -> Vec<u8> {
        self.codes.texels().as_flattened().to_vec()
    }
}

/// Zstandard of both components, side by side or one after the other, whichever is smaller.
pub(super) fn packed(map: &Octahedral) -> Result<Stored> {
    let plane = |k: usize| map.codes.texels().iter().map(move |c| c[k]);
    let planar: Vec<u8> = plane(0).chain(plane(1)).collect();
    let bytes = zstd_bytes(&map.interleaved())?.min(zstd_bytes(&planar)?);
    Ok(Stored { bytes, normals: map.normals() })
}

/// Both components in a gray picture with alpha.
pub(super) fn gray_alpha_png(map: &Octahedral) -> Result<Stored> {
    let bytes = png_bytes(map.codes.size(), png::ColorType::GrayscaleAlpha, &map.interleaved(), smallest())?;
    Ok(Stored { bytes, normals: map.normals() })
}

/// Presets of the encoder (the algorithm of Intel's ISPC texture compressor), with their names.
pub(super) fn bc7_settings() -> [(&'static str, BC7Settings); 2] {
    [("fast", BC7Settings::opaque_fast()), ("slow", BC7Settings::opaque_slow())]
}

/// BC7 of the colours, with Zstandard around it, as texture files have it. Sides are multiples of 4.
pub(super) fn bc7(codes: &Grid<[u8; 3]>, settings: BC7Settings) -> Result<Stored> {
    let (width, height) = codes.size();
    ensure!(width.is_multiple_of(4) && height.is_multiple_of(4), "{width} × {height} is not made of blocks");
    let rgba: Vec<u8> = codes.texels().iter().flat_map(|&[r, g, b]| [r, g, b, 255]).collect();
    let variant = CompressionVariant::BC7(settings);
    let mut blocks = vec![0; variant.blocks_byte_size(width, height)];
    compress_rgba8(variant, &rgba, &mut blocks, width, height, 4 * width);
    let mut found = vec![[0u8; 3]; codes.texels().len()];
    for (i, block) in blocks.as_chunks::<16>().0.iter().enumerate() {
        let mut texels = [0u8; 64];
        bcdec_rs::bc7(block, &mut texels, 16);
        let (x, y) = (i % (width as usize / 4) * 4, i / (width as usize / 4) * 4);
        for (t, &[r, g, b, _]) in texels.as_chunks::<4>().0.iter().enumerate() {
            found[(y + t / 4) * width as usize + x + t % 4] = [r, g, b];
        }
    }
    let found = Grid::new(width, height, found)?;
    Ok(Stored { bytes: zstd_bytes(&blocks)?, normals: found.map(|&c| decode_u8(c)) })
}

/// The 24-bit PNG that `rilievo normal` writes.
pub(super) fn png24(normals: &NormalMap<Object>, codes: &Grid<[u8; 3]>) -> Result<Stored> {
    Ok(Stored { bytes: rilievo_io::encode_normals_png8(codes, None)?.len(), normals: normals.clone() })
}

/// The smallest 24-bit PNG that its encoder makes.
pub(super) fn smallest_png24(normals: &NormalMap<Object>, codes: &Grid<[u8; 3]>) -> Result<Stored> {
    let bytes = png_bytes(codes.size(), png::ColorType::Rgb, codes.texels().as_flattened(), smallest())?;
    Ok(Stored { bytes, normals: normals.clone() })
}

/// Every row filter there is.
fn smallest() -> Vec<png::Filter> {
    use png::Filter::{Adaptive, Avg, NoFilter, Paeth, Sub, Up};
    vec![NoFilter, Sub, Up, Avg, Paeth, Adaptive]
}

/// Size of the smallest PNG with any of the filters.
fn png_bytes(size: (u32, u32), color: png::ColorType, data: &[u8], filters: Vec<png::Filter>) -> Result<usize> {
    let mut sizes = Vec::new();
    for filter in filters {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, size.0, size.1);
        encoder.set_color(color);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        encoder.set_filter(filter);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(data)?;
        writer.finish()?;
        sizes.push(bytes.len());
    }
    Ok(sizes.into_iter().min().unwrap_or_default())
}

fn zstd_bytes(data: &[u8]) -> Result<usize> {
    Ok(zstd::bulk::compress(data, ZSTD_LEVEL)?.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn octahedral_codes_are_near_and_stable() {
        let normals = Grid::new(100, 100, testkit::uniform_sphere(10_000, 3)).unwrap();
        // Half the diagonal of a cell; cells are stretched by up to √3 · √2 on the way to the sphere, along one side.
        for (bits, most_deg) in [(8, 0.95), (5, 8.0)] {
            let map = octahedral(&normals, bits).unwrap();
            let back = map.normals();
            let worst = normals.texels().iter().zip(back.texels()).map(|(a, b)| a.angle_to(*b)).fold(0.0, f64::max);
            assert!(worst.to_degrees() < most_deg, "{bits}: {}", worst.to_degrees());
            let again = octahedral(&back, bits).unwrap().normals();
            assert!(again.texels().iter().zip(back.texels()).all(|(a, b)| a.angle_to(*b) < 1e-6));
        }
    }

    #[test]
    fn bc7_puts_blocks_where_they_were() {
        let codes = Grid::from_fn(16, 8, |x, y| [(x / 4 * 60) as u8, (y / 4 * 90) as u8, 200]).unwrap();
        for (_, settings) in bc7_settings() {
            let back = bc7(&codes, settings).unwrap().normals;
            let expected = codes.map(|&c| decode_u8::<Object>(c));
            assert!(back.texels().iter().zip(expected.texels()).all(|(a, b)| a.angle_to(*b) < 0.02));
        }
    }
}
