//! What is drawn into, and how it comes back.

use crate::device::Gpu;
use crate::error::{Error, Result};
use futures_channel::oneshot;
use rilievo::color::Picture;
use rilievo::{Grid, Rgba8};
use wgpu::{
    BufferDescriptor, BufferUsages, CommandEncoderDescriptor, Extent3d, MapMode, TexelCopyBufferInfo,
    TexelCopyBufferLayout, Texture, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView,
};

/// Encoded colours: shaders encode them, as surfaces are sRGB on one web API and linear on the other.
pub(crate) const COLOR: TextureFormat = TextureFormat::Rgba8Unorm;
pub(crate) const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// A picture in the memory of the GPU, 8-bit sRGB, with its depth. Copies are the same picture.
#[derive(Debug, Clone)]
pub struct Target {
    gpu: Gpu,
    size: (u32, u32),
    color: Texture,
    pub(crate) color_view: TextureView,
    pub(crate) depth_view: TextureView,
}

impl Target {
    /// A target of a size in pixels.
    ///
    /// # Errors
    /// [`Error::Limit`] if a side is longer than the device allows, [`Error::Scene`] if one is 0.
    pub fn new(gpu: &Gpu, size: (u32, u32)) -> Result<Self> {
        gpu.expect_side("a picture", size, "draw a smaller one, or use the CPU renderer")?;
        if size.0 == 0 || size.1 == 0 {
            return Err(rilievo::Error::Size { width: size.0.into(), height: size.1.into() }.into());
        }
        let texture = |format, usage| {
            gpu.device.create_texture(&TextureDescriptor {
                label: None,
                size: Extent3d { width: size.0, height: size.1, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: TextureDimension::D2,
                format,
                usage: usage | TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let color = texture(COLOR, TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC);
        let depth = texture(DEPTH, TextureUsages::empty());
        let (color_view, depth_view) = (crate::texture::view(&color), crate::texture::view(&depth));
        Ok(Self { gpu: gpu.clone(), size, color, color_view, depth_view })
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// The colours, encoded, for others to show.
    pub fn view(&self) -> &TextureView {
        &self.color_view
    }

    /// The picture; transparent where nothing was drawn on a transparent ground.
    ///
    /// # Errors
    /// [`Error::Device`] if the device is lost meanwhile.
    pub async fn read(&self) -> Result<Picture> {
        self.gpu.check()?;
        let (width, height) = self.size;
        // Rows of a copy start at multiples of 256 bytes.
        let row = (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.gpu.device.create_buffer(&BufferDescriptor {
            label: None,
            size: u64::from(row) * u64::from(height),
            usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
        let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let to = TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(self.color.as_image_copy(), to, self.color.size());
        self.gpu.queue.submit([encoder.finish()]);

        let (tell, told) = oneshot::channel();
        buffer.slice(..).map_async(MapMode::Read, move |result| {
            // Nobody waits any more: then nobody need be told.
            let _ = tell.send(result);
        });
        self.gpu.wait()?;
        told.await.map_err(|_| Error::Device("a picture was not read".into()))?.map_err(device)?;
        let bytes = buffer.slice(..).get_mapped_range().map_err(device)?;
        let rows = bytes.chunks_exact(row as usize);
        let pixel = |p: &[u8]| Rgba8::new(p[0], p[1], p[2], p[3]);
        let pixels = rows.flat_map(|row| row[..width as usize * 4].chunks_exact(4).map(pixel)).collect();
        Ok(Grid::new(width, height, pixels)?)
    }
}

fn device(error: impl std::fmt::Display) -> Error {
    Error::Device(error.to_string())
}
