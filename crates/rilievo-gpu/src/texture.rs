//! Maps in the memory of the GPU.

use crate::device::Gpu;
use crate::error::Result;
use rilievo::light::Environment;
use rilievo::{LinearRgb, MipChain};
use wgpu::{
    Extent3d, Origin3d, TexelCopyBufferLayout, TexelCopyTextureInfo, Texture, TextureAspect, TextureDescriptor,
    TextureDimension, TextureFormat, TextureUsages, TextureView, TextureViewDescriptor,
};

/// Entries in a row of a texture that is a list.
pub(crate) const ROW: u32 = 256;

/// What to do about maps that are too large.
const SMALLER: &str = "make the map smaller, or use the CPU renderer";

/// An empty texture.
pub(crate) fn create(gpu: &Gpu, (width, height): (u32, u32), levels: u32, format: TextureFormat) -> Texture {
    gpu.device.create_texture(&TextureDescriptor {
        label: None,
        size: Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: levels,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// Writes the first rows of a level; gives the number of bytes.
pub(crate) fn write(gpu: &Gpu, texture: &Texture, level: u32, (width, rows): (u32, u32), bytes: &[u8]) -> u64 {
    let to = TexelCopyTextureInfo { texture, mip_level: level, origin: Origin3d::ZERO, aspect: TextureAspect::All };
    let layout =
        TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(bytes.len() as u32 / rows), rows_per_image: None };
    gpu.queue.write_texture(to, bytes, layout, Extent3d { width, height: rows, depth_or_array_layers: 1 });
    bytes.len() as u64
}

/// A map with its mip levels; `bytes` are those of one level.
pub(crate) fn upload<T>(
    gpu: &Gpu,
    what: &'static str,
    map: &MipChain<T>,
    format: TextureFormat,
    bytes: impl Fn(&[T]) -> Vec<u8>,
) -> Result<Texture> {
    gpu.expect_side(what, map.base().size(), SMALLER)?;
    let texture = create(gpu, map.base().size(), map.levels().len() as u32, format);
    for (i, level) in map.levels().iter().enumerate() {
        write(gpu, &texture, i as u32, level.size(), &bytes(level.texels()));
    }
    Ok(texture)
}

/// Linear light in 16-bit floats.
pub(crate) fn light_bytes(colors: impl Iterator<Item = LinearRgb>) -> Vec<u8> {
    float_bytes(colors.map(|c| [c.r, c.g, c.b, 1.0]))
}

/// Four components in 16-bit floats.
pub(crate) fn float_bytes(texels: impl Iterator<Item = [f32; 4]>) -> Vec<u8> {
    let halves: Vec<[u16; 4]> = texels.map(|t| t.map(|v| half::f16::from_f32(v).to_bits())).collect();
    bytemuck::cast_slice(&halves).to_vec()
}

/// A list of texels in rows of [`ROW`].
pub(crate) struct List {
    pub(crate) texture: Texture,
    rows: u32,
    texel_bytes: usize,
    scratch: Vec<u8>,
}

impl List {
    /// Room for at least `texels`.
    pub(crate) fn new(gpu: &Gpu, what: &'static str, texels: usize, format: TextureFormat) -> Result<Self> {
        let rows = texels.div_ceil(ROW as usize).max(1) as u32;
        gpu.expect_side(what, (ROW, rows), SMALLER)?;
        let texel_bytes = format.block_copy_size(None).unwrap_or(4) as usize;
        Ok(Self { texture: create(gpu, (ROW, rows), 1, format), rows, texel_bytes, scratch: Vec::new() })
    }

    /// One row, as long as need be.
    pub(crate) fn line(gpu: &Gpu, what: &'static str, texels: u32, format: TextureFormat) -> Result<Self> {
        gpu.expect_side(what, (texels, 1), "use fewer, or the CPU renderer")?;
        let texel_bytes = format.block_copy_size(None).unwrap_or(4) as usize;
        Ok(Self { texture: create(gpu, (texels, 1), 1, format), rows: 1, texel_bytes, scratch: Vec::new() })
    }

    /// Texels in a row.
    pub(crate) fn width(&self) -> u32 {
        self.texture.width()
    }

    /// Whether as many texels fit.
    pub(crate) fn holds(&self, texels: usize) -> bool {
        texels <= (self.rows * self.width()) as usize
    }

    /// Writes texels from the first on; gives the number of bytes that were sent.
    ///
    /// Whole rows are sent: where there is less than one, a short one.
    pub(crate) fn write(&mut self, gpu: &Gpu, bytes: &[u8]) -> u64 {
        let texels = bytes.len() / self.texel_bytes;
        if texels == 0 {
            return 0;
        }
        if texels <= self.width() as usize {
            return write(gpu, &self.texture, 0, (texels as u32, 1), bytes);
        }
        let row_bytes = ROW as usize * self.texel_bytes;
        let rows = texels.div_ceil(ROW as usize);
        if rows * row_bytes == bytes.len() {
            return write(gpu, &self.texture, 0, (ROW, rows as u32), bytes);
        }
        self.scratch.clear();
        self.scratch.extend_from_slice(bytes);
        self.scratch.resize(rows * row_bytes, 0);
        write(gpu, &self.texture, 0, (ROW, rows as u32), &self.scratch)
    }
}

/// The copies of the surroundings, one below the other, and where each lies: first row, width and height without the border.
pub(crate) fn surroundings(gpu: &Gpu, environment: &Environment) -> Result<(Texture, Vec<[u32; 4]>)> {
    let size = environment.copies().fold((0, 0), |(width, height), c| (width.max(c.width + 2), height + c.height + 2));
    gpu.expect_side("the environment", size, "use a smaller panorama, or the CPU renderer")?;
    let texture = create(gpu, size, 1, TextureFormat::Rgba16Float);
    let (mut places, mut row) = (Vec::new(), 0);
    for copy in environment.copies() {
        let (width, height) = (copy.width + 2, copy.height + 2);
        let bytes = light_bytes(copy.texels.iter().copied());
        let to = TexelCopyTextureInfo { origin: Origin3d { x: 0, y: row, z: 0 }, ..texture.as_image_copy() };
        let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * 8), rows_per_image: None };
        gpu.queue.write_texture(to, &bytes, layout, Extent3d { width, height, depth_or_array_layers: 1 });
        places.push([row, copy.width, copy.height, 0]);
        row += height;
    }
    Ok((texture, places))
}

pub(crate) fn view(texture: &Texture) -> TextureView {
    texture.create_view(&TextureViewDescriptor::default())
}
