//! The lengths that can be transformed, and their radices.

/// A length as a product of radices: m = first * inner * leaf.
#[derive(Clone, Debug, PartialEq)]
pub struct Factors {
    /// The radix of the first pass, which skips the zero padding: the first divisor among 8, 4, 2, 5 and 3.
    pub first: usize,
    /// The radices of the passes after it, longest blocks first: 3, 4, 5, 8.
    pub inner: Vec<usize>,
    /// The radix of the last pass, which needs no roots: 1, 2, 3, 4, 5, 8.
    pub leaf: usize,
}

/// The radices of a length; `None` if the length is 1 or not of the form 2^a 3^b 5^c.
pub fn factors(length: usize) -> Option<Factors> {
    let first = [8, 4, 2, 5, 3].into_iter().find(|radix| length > 0 && length.is_multiple_of(*radix))?;
    let mut rest = length / first;
    let mut powers = |prime: usize| {
        let mut power = 0;
        while rest.is_multiple_of(prime) {
            rest /= prime;
            power += 1;
        }
        power
    };
    let (mut fives, mut threes, twos) = (powers(5), powers(3), powers(2));
    if rest != 1 {
        return None;
    }
    // The rest of the power of two after the leaf is a product of fours and eights.
    let (leaf, twos) = match twos {
        0 if fives > 0 => (5, 0),
        0 if threes > 0 => (3, 0),
        0 => (1, 0),
        1 => (2, 0),
        a if a % 3 == 0 => (8, a - 3),
        a => (4, a - 2),
    };
    fives -= usize::from(leaf == 5);
    threes -= usize::from(leaf == 3);
    let fours = if twos % 3 == 0 { 0 } else { 3 - twos % 3 };
    let eights = (twos - 2 * fours) / 3;
    let mut inner = vec![8; eights];
    inner.extend(vec![5; fives]);
    inner.extend(vec![4; fours]);
    inner.extend(vec![3; threes]);
    Some(Factors { first, inner, leaf })
}

/// The smallest multiple of 16 of the form 2^a 3^b 5^c that is at least `minimum`.
///
/// Sixteen, because the rows are transformed at half their length, and both first passes are fastest with radix 8.
pub fn good_length(minimum: usize) -> usize {
    let sixteens = minimum.div_ceil(16).max(1);
    let mut best = sixteens.next_power_of_two();
    let mut five = 1;
    while five < best {
        let mut odd = five;
        while odd < best {
            best = best.min(odd * sixteens.div_ceil(odd).next_power_of_two());
            odd *= 3;
        }
        five *= 5;
    }
    16 * best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radices_multiply_to_the_length() {
        for m in 1..5000 {
            let smooth = {
                let mut rest = m;
                [2, 3, 5].iter().for_each(|p| {
                    while rest % p == 0 {
                        rest /= p;
                    }
                });
                rest == 1 && m > 1
            };
            let found = factors(m);
            assert_eq!(found.is_some(), smooth, "{m}");
            if let Some(Factors { first, inner, leaf }) = found {
                assert_eq!(first * inner.iter().product::<usize>() * leaf, m);
                assert!(inner.iter().all(|r| [3, 4, 5, 8].contains(r)) && [1, 2, 3, 4, 5, 8].contains(&leaf));
            }
        }
        assert_eq!(factors(2048), Some(Factors { first: 8, inner: vec![8, 8], leaf: 4 }));
    }

    #[test]
    fn good_lengths_are_the_least() {
        for minimum in 1..3000_usize {
            let least = (minimum..).find(|m| m.is_multiple_of(16) && factors(*m).is_some());
            assert_eq!(Some(good_length(minimum)), least);
        }
    }
}
