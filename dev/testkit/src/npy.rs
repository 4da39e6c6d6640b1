//! NumPy arrays as test data.

use half::f16;

/// The size and values of a little-endian float16 array (`.npy` version 1), widened to f32.
///
/// Source: numpy.lib.format: magic, version, header length in 2 bytes, a Python dictionary, the values.
///
/// # Panics
/// If the bytes are anything else: test data are trusted to be what the test says.
pub fn read_npy_f16(bytes: &[u8]) -> (Vec<usize>, Vec<f32>) {
    assert!(bytes.starts_with(b"\x93NUMPY\x01\x00"), "not a .npy file of version 1");
    let header_len = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let (header, values) = bytes[10..].split_at(header_len);
    let header = std::str::from_utf8(header).expect("the header is ASCII");
    assert!(header.contains("'descr': '<f2'"), "not little-endian float16: {header}");
    assert!(header.contains("'fortran_order': False"), "not row-major: {header}");
    let shape = header.split_once("'shape': (").and_then(|(_, rest)| rest.split_once(')')).expect("a shape").0;
    let shape: Vec<usize> =
        shape.split(',').filter_map(|side| Some(side.trim()).filter(|s| !s.is_empty())).map(parse_side).collect();
    let values: Vec<f32> = values.chunks_exact(2).map(|pair| f16::from_le_bytes([pair[0], pair[1]]).to_f32()).collect();
    assert_eq!(values.len(), shape.iter().product::<usize>(), "values do not fill the shape {shape:?}");
    (shape, values)
}

fn parse_side(text: &str) -> usize {
    text.parse().expect("a whole number")
}

/// A little-endian float32 array as NumPy writes it (`.npy` version 1); `values` need not fill `shape`, for files that lie.
pub fn write_npy_f32(shape: &[usize], values: &[f32]) -> Vec<u8> {
    let sides: String = shape.iter().map(|side| format!("{side}, ")).collect();
    let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({sides}), }}");
    // With the ten bytes before it, whole lines of 64.
    let padded = (header.len() + 11).next_multiple_of(64) - 11;
    let header = format!("{header:padded$}\n");
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.as_bytes());
    file.extend(values.iter().flat_map(|v| v.to_le_bytes()));
    file
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_the_shape_and_the_values() {
        let header = "{'descr': '<f2', 'fortran_order': False, 'shape': (1, 2, ), }\n";
        let mut file = b"\x93NUMPY\x01\x00".to_vec();
        file.extend((header.len() as u16).to_le_bytes());
        file.extend(header.as_bytes());
        file.extend([0x00, 0x3c, 0x00, 0xc0]);
        assert_eq!(read_npy_f16(&file), (vec![1, 2], vec![1.0, -2.0]));
    }

    #[test]
    fn writes_whole_lines_of_header() {
        let file = write_npy_f32(&[2, 1], &[0.5, -1.0]);
        assert!(file.len() == 128 + 8 && file[127] == b'\n', "{}", file.len());
        assert_eq!(file[128..], [0, 0, 0, 0x3f, 0, 0, 0x80, 0xbf]);
    }
}
