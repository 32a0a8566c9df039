//! Sets of cells as bits, eight cells in a byte: adjacent cells, and empty lines at the rim.

use rayon::prelude::*;

/// Number of bytes of a set that are processed together.
const WORD: usize = 8;

/// The cells outside the set that are adjacent to one in it. Adjacent are the eight around each in memory, so the last cell of a
/// row is a neighbour of the first cell of the next row.
pub(crate) fn find_adjacent(set: &[u8], row: usize, adjacent: &mut [u8]) {
    let row = row as isize;
    adjacent.par_chunks_mut(1024 * WORD).enumerate().for_each(|(chunk, adjacent)| {
        for (n, bytes) in (1024 * chunk..).zip(adjacent.chunks_mut(WORD)) {
            let at = (8 * WORD * n) as isize;
            // Any of three rows, at the cells one before and one after these; the cells in between are in both.
            let [before, after] = [at - 1, at + 1]
                .map(|at| sixty_four(set, at - row) | sixty_four(set, at) | sixty_four(set, at + row));
            let near = before | before >> 1 | after << 1 | after;
            let open = near & !sixty_four(set, at);
            bytes.copy_from_slice(&open.to_le_bytes()[..bytes.len()]);
        }
    });
}

/// Cells `at`..`at + 64` of a set, as bits; 0 beyond its ends.
fn sixty_four(set: &[u8], at: isize) -> u64 {
    let (byte, shift) = (at.div_euclid(8), at.rem_euclid(8));
    let nine = usize::try_from(byte).ok().and_then(|byte| set.get(byte..)?.first_chunk().copied());
    let [first @ .., last]: [u8; 9] = nine.unwrap_or_else(|| {
        let within = |k| usize::try_from(byte + k).ok().and_then(|byte| set.get(byte).copied());
        std::array::from_fn(|k| within(k as isize).unwrap_or(0))
    });
    // Shifted in two steps, because a shift by 64 is not allowed.
    u64::from_le_bytes(first) >> shift | u64::from(last) << 1 << (63 - shift)
}

/// Total number of lines without a cell of the set at both ends of each direction. At each end no more than `most` (at most 64)
/// are counted.
pub(crate) fn margins(set: &[u8], [nx, ny]: [usize; 2], most: usize) -> [usize; 2] {
    let empty = |i: usize| (0..ny).step_by(64).all(|j| some(set, i * ny + j, ny - j) == 0);
    let above = (0..nx.min(most)).take_while(|i| empty(*i)).count();
    let below = (0..nx.min(most)).take_while(|i| empty(nx - 1 - i)).count();
    let width = ny.min(most);
    let [mut left, mut right] = [0; 2];
    for start in (0..nx).map(|i| i * ny) {
        left |= some(set, start, width);
        right |= some(set, start + ny - width, width);
    }
    let [left, right] = [left.trailing_zeros(), (right << (64 - width)).leading_zeros()];
    [above + below, width.min(left as usize) + width.min(right as usize)]
}

/// The first `cells` cells from `at` on as bits, at most 64.
fn some(set: &[u8], at: usize, cells: usize) -> u64 {
    let bits = sixty_four(set, at as isize);
    if cells < 64 { bits & ((1 << cells) - 1) } else { bits }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A set of blobs on nx x ny cells.
    pub(crate) fn set([nx, ny]: [usize; 2]) -> Vec<u8> {
        let mut set = vec![0; (nx * ny).div_ceil(8)];
        for n in 0..nx * ny {
            let (x, y) = ((n / ny) as f64, (n % ny) as f64);
            if (0.31 * x).sin() + (0.23 * y + 0.1 * x).cos() > 0.4 {
                set[n / 8] |= 1 << (n % 8);
            }
        }
        set
    }

    pub(crate) fn is_in(set: &[u8], n: usize) -> bool {
        set[n / 8] >> (n % 8) & 1 == 1
    }

    #[test]
    fn open_cells_adjacent_to_the_set() {
        for cells in [[16, 8], [37, 50], [3, 21], [40, 64]] {
            let ([_, ny], set) = (cells, set(cells));
            let n = cells[0] * ny;
            let mut adjacent = vec![u8::MAX; set.len()];
            find_adjacent(&set, ny, &mut adjacent);
            for k in 0..n {
                let around = [0, 1, 2, ny, ny + 2, 2 * ny, 2 * ny + 1, 2 * ny + 2]
                    .map(|d| (k + d).checked_sub(ny + 1));
                let near = around.iter().any(|k| k.is_some_and(|k| k < n && is_in(&set, k)));
                assert_eq!(is_in(&adjacent, k), near && !is_in(&set, k), "{cells:?} {k}");
            }
        }
    }

    #[test]
    fn lines_without_a_cell_of_the_set() {
        for cells in [[1_usize, 1], [16, 8], [37, 50], [3, 21], [40, 64], [100, 130]] {
            let [nx, ny] = cells;
            for (top, bottom, left, right) in [(0, 0, 0, 0), (1, 0, 2, 3), (5, 9, 30, 1), (20, 20, 3, 80)] {
                let mut set = vec![0; (nx * ny).div_ceil(8)];
                let (rows, columns) = (top..nx.saturating_sub(bottom), left..ny.saturating_sub(right));
                if rows.is_empty() || columns.is_empty() {
                    continue;
                }
                // Two corners of the remainder.
                for n in [top * ny + left, (rows.end - 1) * ny + columns.end - 1] {
                    set[n / 8] |= 1 << (n % 8);
                }
                let expected = [top.min(16) + bottom.min(16), left.min(16) + right.min(16)];
                assert_eq!(margins(&set, cells, 16), expected, "{cells:?}");
            }
        }
    }
}
