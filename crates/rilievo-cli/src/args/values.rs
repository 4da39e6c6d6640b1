//! Sizes, colours, angles.

use std::str::FromStr;

use rilievo::LinearRgb;

use crate::scene::CameraSpec;

/// `WxH`, or one number for a square.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SizeArg {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

impl FromStr for SizeArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (w, h) = text.split_once(['x', 'X', '×']).unwrap_or((text, text));
        let side =
            |s: &str| s.trim().parse::<u32>().map_err(|_| format!("'{text}' is not WIDTHxHEIGHT, as in 640x480"));
        let size = Self { width: side(w)?, height: side(h)? };
        rilievo::grid::check_size(size.width.into(), size.height.into()).map_err(|e| e.to_string())?;
        Ok(size)
    }
}

/// `#RRGGBB` in sRGB, optionally `*FACTOR` in linear light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ColorArg(pub(crate) LinearRgb);

impl FromStr for ColorArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("'{text}' is not a colour; write RRGGBB in sRGB, or RRGGBB*FACTOR, as in ffddaa*0.8");
        let (hex, factor) = text.split_once('*').unwrap_or((text, "1"));
        let hex = hex.strip_prefix('#').unwrap_or(hex);
        if hex.len() != 6 || !hex.is_ascii() {
            return Err(wrong());
        }
        let byte = |i: usize| u8::from_str_radix(&hex[i..i + 2], 16).map_err(|_| wrong());
        let factor = finite(factor).filter(|f| *f >= 0.0).ok_or_else(wrong)?;
        Ok(Self(LinearRgb::from_srgb([byte(0)?, byte(2)?, byte(4)?]) * factor))
    }
}

/// `AZ,EL[,DISTANCE[,FOV]]`: an orbit about the object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CameraArg(pub(crate) CameraSpec);

impl FromStr for CameraArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let form = || format!("'{text}' is not AZIMUTH,ELEVATION[,DISTANCE[,FOV]] in degrees, as in 30,20,1.1");
        let parts: Vec<f32> = text.split(',').map(finite).collect::<Option<_>>().ok_or_else(form)?;
        let (&[azimuth, elevation], rest) = parts.split_first_chunk::<2>().ok_or_else(form)?;
        if rest.len() > 2 || !(-90.0..=90.0).contains(&elevation) {
            return Err(form());
        }
        let (distance, fov) = (rest.first().copied().unwrap_or(1.0), rest.get(1).copied().unwrap_or(30.0));
        if !(0.01..=10_000.0).contains(&distance) || !(0.1..=170.0).contains(&fov) {
            return Err(format!("'{text}': the distance must be 0.01 to 10000, the field of view 0.1 to 170 degrees"));
        }
        let (azimuth_rad, elevation_rad) = (azimuth.to_radians(), elevation.to_radians());
        Ok(Self(CameraSpec::Orbit { azimuth_rad, elevation_rad, distance, fov_y_rad: fov.to_radians(), target: None }))
    }
}

/// A finite number.
pub(crate) fn finite(text: &str) -> Option<f32> {
    text.trim().parse::<f32>().ok().filter(|v| v.is_finite())
}

/// A threshold: a number, not NaN.
pub(crate) fn number(text: &str) -> Result<f64, String> {
    text.trim().parse().ok().filter(|v: &f64| !v.is_nan()).ok_or_else(|| format!("'{text}' is not a number"))
}

/// `A,B`, or one number for both: how often a map repeats along u and v.
pub(crate) fn pair(text: &str) -> Result<[f32; 2], String> {
    let (a, b) = text.split_once(',').unwrap_or((text, text));
    let value = |s: &str| finite(s).filter(|v| *v > 0.0);
    match (value(a), value(b)) {
        (Some(a), Some(b)) => Ok([a, b]),
        _ => Err(format!("'{text}' is not U,V with positive numbers, as in 3,2")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!("640x480".parse(), Ok(SizeArg { width: 640, height: 480 }));
        assert_eq!("512".parse(), Ok(SizeArg { width: 512, height: 512 }));
        for bad in ["", "x", "0x4", "-1x4", "99999999x9", "4x4x4"] {
            assert!(bad.parse::<SizeArg>().is_err(), "{bad}");
        }
    }

    #[test]
    fn colors() {
        assert_eq!("#ffffff".parse(), Ok(ColorArg(LinearRgb::WHITE)));
        assert_eq!("ff0000*0.5".parse(), Ok(ColorArg(LinearRgb::new(0.5, 0.0, 0.0))));
        for bad in ["fff", "gggggg", "ffffff*x", "ffffff*-1", "ééé"] {
            assert!(bad.parse::<ColorArg>().is_err(), "{bad}");
        }
    }

    #[test]
    fn cameras() {
        assert!("30,20".parse::<CameraArg>().is_ok() && "-30,-20,1.5,40".parse::<CameraArg>().is_ok());
        for bad in ["", "30", "0,91", "1,2,3,4,5", "nan,0", "0,0,0", "0,0,1e30", "0,0,1,180"] {
            assert!(bad.parse::<CameraArg>().is_err(), "{bad}");
        }
    }
}
