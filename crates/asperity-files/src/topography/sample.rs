//! Binary numbers of every width and byte order as f64.

use rayon::prelude::*;

use super::{Problem, Result};

/// Maps with fewer points are not worth the threads.
pub(super) const FEW: usize = 1 << 15;

/// Makes the enum of the types of numbers, and what decodes them, from a list of types that Rust knows.
macro_rules! kinds {
    ($($kind:ident: $number:ty;)*) => {
        /// Type of a binary number.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum Kind {
            $($kind,)*
            F16,
        }

        impl Kind {
            /// Bytes of one number.
            pub(super) fn width(self) -> usize {
                match self {
                    $(Kind::$kind => size_of::<$number>(),)*
                    Kind::F16 => 2,
                }
            }
        }

        /// The numbers of `bytes`, as many as there is room for.
        pub(super) fn decode_into(numbers: &mut [f64], bytes: &[u8], kind: Kind, order: Order) {
            match (kind, order) {
                $(
                    (Kind::$kind, Order::Little) => {
                        each(numbers, bytes, |bytes| <$number>::from_le_bytes(bytes) as f64);
                    }
                    (Kind::$kind, Order::Big) => {
                        each(numbers, bytes, |bytes| <$number>::from_be_bytes(bytes) as f64);
                    }
                )*
                (Kind::F16, Order::Little) => each(numbers, bytes, |bytes| half(u16::from_le_bytes(bytes))),
                (Kind::F16, Order::Big) => each(numbers, bytes, |bytes| half(u16::from_be_bytes(bytes))),
            }
        }
    };
}

kinds! {
    U8: u8;
    I8: i8;
    U16: u16;
    I16: i16;
    U32: u32;
    I32: i32;
    U64: u64;
    I64: i64;
    F32: f32;
    F64: f64;
}

/// Order of the bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    Little,
    Big,
}

/// The first `count` numbers of `bytes`.
///
/// # Errors
/// [`Problem::Truncated`] where there are fewer; nothing is allocated then.
pub(super) fn decode(bytes: &[u8], kind: Kind, order: Order, count: usize, what: &str) -> Result<Vec<f64>> {
    let needed = (count as u64).saturating_mul(kind.width() as u64);
    Problem::check_length(what, needed, bytes.len())?;
    let mut numbers = vec![0.0; count];
    let parts = bytes[..needed as usize].par_chunks(FEW * kind.width());
    numbers
        .par_chunks_mut(FEW)
        .zip(parts)
        .for_each(|(numbers, bytes)| decode_into(numbers, bytes, kind, order));
    Ok(numbers)
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
