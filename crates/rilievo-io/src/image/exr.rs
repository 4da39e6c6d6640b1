//! OpenEXR in and out, for maps of floats.

use std::io::Cursor;

use exr::meta::MetaData;
use exr::prelude::*;
use rilievo::{Convention, Grid, NormalMap, Space};

use super::raster::{Raster, Samples};
use crate::error::Error;
use crate::limits::{Limits, check_plausible};
use crate::source::Source;

/// Above what zip, run lengths and wavelets reach.
const MAX_RATIO: u64 = 4096;

/// Decodes the first layer of an EXR: channels R, G, B or X, Y, Z (any case, with or without a layer name before the
/// last dot), or a single one, and A.
pub(crate) fn decode(source: &Source, limits: &Limits) -> crate::Result<Raster> {
    let (name, bytes) = (source.name(), source.bytes());
    let failed = |e: exr::error::Error| match e {
        exr::error::Error::NotSupported(what) => Error::unsupported(name, format!("this EXR ({what})"), REMEDY),
        e => Error::format(name, "EXR data", e.to_string()),
    };
    let headers = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(failed)?.headers;
    let mut declared = 0;
    for header in &headers {
        let lossy = match header.compression {
            Compression::DWAA(_) => Some("DWAA"),
            Compression::DWAB(_) => Some("DWAB"),
            _ => None,
        };
        if let Some(kind) = lossy {
            return Err(Error::unsupported(name, format!("the lossy EXR compression {kind}"), REMEDY));
        }
        let size = header.layer_size;
        let texels = limits.check_size(name, size.width() as u64, size.height() as u64)? as u64;
        if header.channels.list.len() > 64 {
            return Err(Error::limits(name, format!("{} channels", header.channels.list.len()), 64));
        }
        declared += texels * header.channels.bytes_per_pixel as u64;
    }
    check_plausible(name, declared, bytes.len() as u64, MAX_RATIO)?;

    let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
    let layer = reader.non_parallel().from_buffered(Cursor::new(bytes)).map_err(failed)?.layer_data;
    let channels = &layer.channel_data.list;
    let find = |wanted: &str| {
        let last = |c: &AnyChannel<FlatSamples>| {
            let text = c.name.to_string();
            text.rsplit('.').next().unwrap_or_default().to_ascii_uppercase()
        };
        channels.iter().find(|c| last(c) == wanted)
    };
    let all = |names: [&str; 3]| names.map(find).into_iter().collect::<Option<Vec<_>>>();
    let alpha = find("A");
    let gray = || {
        let mut data = channels.iter().filter(|c| alpha.is_none_or(|a| a.name != c.name));
        data.next().filter(|_| data.next().is_none()).map(|c| vec![c])
    };
    let Some(mut chosen) = all(["R", "G", "B"]).or_else(|| all(["X", "Y", "Z"])).or_else(gray) else {
        let names: Vec<String> = channels.iter().map(|c| c.name.to_string()).collect();
        let reason = format!("channels R, G, B or X, Y, Z, or a single one, are needed; it has {}", names.join(", "));
        return Err(Error::format(name, "EXR header", reason));
    };
    chosen.extend(alpha);
    let (width, height) = (layer.size.width(), layer.size.height());
    let mut samples = vec![0.0; width * height * chosen.len()];
    for (i, channel) in chosen.iter().enumerate() {
        if channel.sampling != Vec2(1, 1) {
            return Err(Error::unsupported(name, "an EXR with subsampled channels", REMEDY));
        }
        let into = samples[i..].iter_mut().step_by(chosen.len());
        into.zip(channel.sample_data.values_as_f32()).for_each(|(to, from)| *to = from);
    }
    Raster::new(name, (width as u32, height as u32), chosen.len(), Samples::F32(samples))
}

const REMEDY: &str = "save the EXR again with ZIP or no compression, one layer of full-size channels";

/// Normals as an EXR of 32-bit floats, ZIP-compressed: channels R, G, B hold x, y, z in −1 … 1; A is there (1 or 0)
/// only if some texel is uncovered.
///
/// # Errors
/// [`Error::Invalid`] if `covered` has another size.
pub fn encode_normals_exr<S: Space>(
    map: &NormalMap<S>,
    convention: Convention,
    covered: Option<&Grid<bool>>,
) -> crate::Result<Vec<u8>> {
    const NAME: &str = "EXR to be written";
    let covered = covered.filter(|c| c.texels().contains(&false));
    if let Some(covered) = covered {
        map.expect_same_size("coverage", covered).map_err(|e| Error::invalid(NAME, e))?;
    }
    let component = |i: usize| map.texels().iter().map(|&n| convention.apply(n).vec()[i]).collect();
    let channel = |name: &str, values: Vec<f32>| AnyChannel::new(name, FlatSamples::F32(values));
    let mut list: Vec<_> = ["R", "G", "B"].iter().enumerate().map(|(i, name)| channel(name, component(i))).collect();
    if let Some(covered) = covered {
        list.push(channel("A", covered.texels().iter().map(|&c| f32::from(u8::from(c))).collect()));
    }
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: exr::image::Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let size = (map.width() as usize, map.height() as usize);
    let layer = Layer::new(size, LayerAttributes::default(), encoding, AnyChannels::sort(list.into_iter().collect()));
    let mut bytes = Vec::new();
    let image = Image::from_layer(layer);
    let written = image.write().non_parallel().to_buffered(Cursor::new(&mut bytes));
    written.map_err(|e| Error::write(NAME, std::io::Error::other(e.to_string())))?;
    Ok(bytes)
}
