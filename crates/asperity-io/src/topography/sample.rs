//! Binary numbers of every width and byte order as f64.

use rayon::prelude::*;

use super::Problem;

/// Maps with fewer points are not worth the threads.
pub(super) const FEW: usize = 1 << 15;

/// Type of a binary number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    U64,
    I64,
    F16,
    F32,
    F64,
}

/// Order of the bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    Little,
    Big,
}

impl Kind {
    /// Bytes of one number.
    pub(super) fn width(self) -> usize {
        match self {
            Kind::U8 | Kind::I8 => 1,
            Kind::U16 | Kind::I16 | Kind::F16 => 2,
            Kind::U32 | Kind::I32 | Kind::F32 => 4,
            Kind::U64 | Kind::I64 | Kind::F64 => 8,
        }
    }
}

/// The first `count` numbers of `bytes`.
///
/// # Errors
/// [`Problem::Truncated`] where there are fewer; nothing is allocated then.
pub(super) fn decode(
    bytes: &[u8],
    kind: Kind,
    order: Order,
    count: usize,
    what: &str,
) -> Result<Vec<f64>, Problem> {
    let needed = (count as u64).saturating_mul(kind.width() as u64);
    let available = bytes.len() as u64;
    if available < needed {
        return Err(Problem::truncated(what, needed, available));
    }
    let mut numbers = vec![0.0; count];
    let parts = bytes[..needed as usize].par_chunks(FEW * kind.width());
    numbers
        .par_chunks_mut(FEW)
        .zip(parts)
        .for_each(|(numbers, bytes)| decode_into(numbers, bytes, kind, order));
    Ok(numbers)
}

/// The numbers of `bytes`, as many as there is room for.
pub(super) fn decode_into(numbers: &mut [f64], bytes: &[u8], kind: Kind, order: Order) {
    match (kind, order) {
        (Kind::U8, _) => each(numbers, bytes, |[b]: [u8; 1]| f64::from(b)),
        (Kind::I8, _) => each(numbers, bytes, |[b]: [u8; 1]| f64::from(b as i8)),
        (Kind::U16, Order::Little) => each(numbers, bytes, |b| f64::from(u16::from_le_bytes(b))),
        (Kind::U16, Order::Big) => each(numbers, bytes, |b| f64::from(u16::from_be_bytes(b))),
        (Kind::I16, Order::Little) => each(numbers, bytes, |b| f64::from(i16::from_le_bytes(b))),
        (Kind::I16, Order::Big) => each(numbers, bytes, |b| f64::from(i16::from_be_bytes(b))),
        (Kind::F16, Order::Little) => each(numbers, bytes, |b| half(u16::from_le_bytes(b))),
        (Kind::F16, Order::Big) => each(numbers, bytes, |b| half(u16::from_be_bytes(b))),
        (Kind::U32, Order::Little) => each(numbers, bytes, |b| f64::from(u32::from_le_bytes(b))),
        (Kind::U32, Order::Big) => each(numbers, bytes, |b| f64::from(u32::from_be_bytes(b))),
        (Kind::I32, Order::Little) => each(numbers, bytes, |b| f64::from(i32::from_le_bytes(b))),
        (Kind::I32, Order::Big) => each(numbers, bytes, |b| f64::from(i32::from_be_bytes(b))),
        (Kind::F32, Order::Little) => each(numbers, bytes, |b| f64::from(f32::from_le_bytes(b))),
        (Kind::F32, Order::Big) => each(numbers, bytes, |b| f64::from(f32::from_be_bytes(b))),
        (Kind::U64, Order::Little) => each(numbers, bytes, |b| u64::from_le_bytes(b) as f64),
        (Kind::U64, Order::Big) => each(numbers, bytes, |b| u64::from_be_bytes(b) as f64),
        (Kind::I64, Order::Little) => each(numbers, bytes, |b| i64::from_le_bytes(b) as f64),
        (Kind::I64, Order::Big) => each(numbers, bytes, |b| i64::from_be_bytes(b) as f64),
        (Kind::F64, Order::Little) => each(numbers, bytes, f64::from_le_bytes),
        (Kind::F64, Order::Big) => each(numbers, bytes, f64::from_be_bytes),
    }
}

/// Every number as `decode` reads its bytes.
fn each<const WIDTH: usize>(numbers: &mut [f64], bytes: &[u8], decode: impl Fn([u8; WIDTH]) -> f64) {
    numbers.iter_mut().zip(bytes.as_chunks::<WIDTH>().0).for_each(|(number, bytes)| *number = decode(*bytes));
}

/// IEEE 754 binary16: sign, 5 bits of exponent (bias 15), 10 bits of fraction.
pub(super) fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let fraction = f64::from(bits & 0x3ff);
    sign * match bits >> 10 & 0x1f {
        0 => fraction * 2f64.powi(-24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        exponent => (1024.0 + fraction) * 2f64.powi(i32::from(exponent) - 25),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_are_ieee_754() {
        // Table of binary16: 1, -2, largest, smallest normal, smallest subnormal.
        for (bits, value) in [
            (0x3c00, 1.0),
            (0xc000, -2.0),
            (0x7bff, 65504.0),
            (0x0400, 2f64.powi(-14)),
            (0x0001, 2f64.powi(-24)),
        ] {
            assert_eq!(half(bits), value);
        }
        assert!(half(0x7e00).is_nan() && half(0x7c00).is_infinite());
    }

    #[test]
    fn the_order_of_the_bytes_is_kept() {
        let (little, big) = (1.5f32.to_le_bytes(), 1.5f32.to_be_bytes());
        assert_eq!(decode(&little, Kind::F32, Order::Little, 1, "x").ok(), Some(vec![1.5]));
        assert_eq!(decode(&big, Kind::F32, Order::Big, 1, "x").ok(), Some(vec![1.5]));
        assert_eq!(decode(&[0xff, 0xfe], Kind::I16, Order::Big, 1, "x").ok(), Some(vec![-2.0]));
        assert!(matches!(
            decode(&[0; 7], Kind::F64, Order::Big, usize::MAX / 16, "x"),
            Err(Problem::Truncated { available: 7, .. })
        ));
    }
}
