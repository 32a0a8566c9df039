//! The pass over rows: real signals along y to and from their half spectra.
//!
//! A row of my real numbers is taken as my/2 complex ones, z(j) = x(2j) + i x(2j + 1). With H = my/2
//! and Z its transform, the spectrum of the row is, for k = 0..H,
//!
//! 2 X(k) = E + O, 2 X(H - k) = (E - O)*, E = Z(k) + Z*(H - k), O = -i w^k \[Z(k) - Z*(H - k)\],
//!
//! w = exp(-2 pi i / my) and * the complex conjugate. Both come from the same two numbers, so the
//! columns are stored as such pairs, k = 0..=H/2: half of a block's lanes hold k, the others H - k.
//! The last pair is repeated until it fills its block.

use super::complex::{Complex, Root, scalars, scalars_mut, transpose};
use super::prefetch::Purpose;
use super::roots::root;
use super::transform::Transform;
use super::vector::{Kernel, MAX_LANES, Scalar, Vector};
use super::work::{Scratch, Tiles};

/// Number of blocks by which tiles are prefetched in advance.
const AHEAD: usize = 4;

/// A planned pass over rows.
pub struct Rows<T> {
    /// Numbers in a row, ny.
    cells: usize,
    transform: Transform<T>,
    /// For k = 0..=H/2; the last one is repeated.
    pairs: Vec<Pair<T>>,
}

/// The frequencies k and H - k.
struct Pair<T> {
    k: usize,
    /// Position of Z(k) in the digit-reversed spectrum.
    position: usize,
    /// Position of Z(H - k).
    mirror: usize,
    /// -i w^k.
    root: Root<T>,
}

impl<T: Scalar> Rows<T> {
    /// Rows of `cells` numbers, where 2 H is twice the length of the transform, for vectors with this number of lanes.
    pub fn new(cells: usize, transform: Transform<T>, lanes: usize) -> Self {
        let half = transform.length();
        let positions = transform.positions();
        let pairs = (0..(half / 2 + 1).next_multiple_of(lanes / 2))
            .map(|k| k.min(half / 2))
            .map(|k| Pair {
                k,
                position: positions[k],
                mirror: positions[(half - k) % half],
                root: root(2 * k + half, 4 * half),
            })
            .collect();
        Rows { cells, transform, pairs }
    }

    /// ny.
    pub fn cells(&self) -> usize {
        self.cells
    }

    /// The frequencies of the columns, lane by lane, block by block.
    pub fn frequencies(&self, lanes: usize) -> Vec<usize> {
        let half = self.transform.length();
        let block = |pairs: &[Pair<T>]| -> Vec<usize> {
            pairs.iter().map(|pair| pair.k).chain(pairs.iter().map(|pair| half - pair.k)).collect()
        };
        self.pairs.chunks_exact(lanes / 2).flat_map(block).collect()
    }

    /// Lengths of the buffers: the packed rows and their transform.
    pub fn scratch(&self, lanes: usize) -> [usize; 2] {
        let packed = self.cells.div_ceil(lanes) * (lanes / 2);
        [packed.max(self.transform.signal_length()), self.transform.length()]
    }

    /// signal\[j\] = x(2j) + i x(2j + 1), zero beyond ny, row n of `rows` in lane n.
    #[inline(always)]
    fn pack<V: Vector<Scalar = T>>(&self, rows: &[T], signal: &mut [Complex<V>]) {
        let (ny, lanes) = (self.cells, V::LANES);
        let full = rows.len() == lanes * ny;
        for (start, numbers) in (0..ny).step_by(lanes).zip(signal.chunks_exact_mut(lanes / 2)) {
            let tile = scalars_mut(numbers);
            if full && start + lanes <= ny {
                V::transpose(&rows[start..], ny, tile, lanes);
            } else {
                let end = (start + lanes).min(ny);
                tile.fill(T::default());
                for (lane, row) in rows.chunks_exact(ny).enumerate() {
                    for (j, x) in row[start..end].iter().enumerate() {
                        tile[j * lanes + lane] = *x;
                    }
                }
            }
        }
        let packed = ny.div_ceil(lanes) * (lanes / 2);
        signal[packed..].fill(Complex::zero());
    }

    /// The inverse of [`Rows::pack`].
    #[inline(always)]
    fn unpack<V: Vector<Scalar = T>>(&self, signal: &[Complex<V>], rows: &mut [T]) {
        let (ny, lanes) = (self.cells, V::LANES);
        let full = rows.len() == lanes * ny;
        for (start, numbers) in (0..ny).step_by(lanes).zip(signal.chunks_exact(lanes / 2)) {
            let tile = scalars(numbers);
            if full && start + lanes <= ny {
                V::transpose(tile, lanes, &mut rows[start..], ny);
            } else {
                let end = (start + lanes).min(ny);
                for (lane, row) in rows.chunks_exact_mut(ny).enumerate() {
                    for (j, x) in row[start..end].iter_mut().enumerate() {
                        *x = tile[j * lanes + lane];
                    }
                }
            }
        }
    }
}

impl<T: Scalar> Pair<T> {
    /// 2 X(k) and 2 X(H - k), from Z.
    #[inline(always)]
    fn spectra<V: Vector<Scalar = T>>(&self, z: &[Complex<V>]) -> (Complex<V>, Complex<V>) {
        let (z, m) = (z[self.position], z[self.mirror]);
        let even = z.plus_conjugate(m);
        let odd = z.minus_conjugate(m).rotated(self.root);
        (even + odd, even.conjugate_minus(odd))
    }

    /// 2 Z(k) and 2 Z(H - k), from X, into Z, real and imaginary parts exchanged.
    #[inline(always)]
    fn store<V: Vector<Scalar = T>>(&self, x: Complex<V>, m: Complex<V>, z: &mut [Complex<V>]) {
        let even = x.plus_conjugate(m);
        let odd = x.minus_conjugate(m).rotated_back(self.root);
        z[self.mirror] = even.conjugate_minus(odd).swapped();
        z[self.position] = (even + odd).swapped();
    }
}

/// One block of rows, forward: `rows` into their `tiles` of the column blocks.
pub struct ForwardRows<'a, V: Vector> {
    pub plan: &'a Rows<V::Scalar>,
    pub rows: &'a [V::Scalar],
    pub tiles: Tiles<'a, V>,
    pub scratch: &'a mut Scratch<V>,
}

impl<V: Vector> Kernel for ForwardRows<'_, V> {
    #[inline(always)]
    fn run(mut self) {
        let [signal, spectrum] = self.plan.scratch(V::LANES);
        let (signal, spectrum) = self.scratch.buffers(signal, spectrum);
        self.plan.pack(self.rows, signal);
        self.plan.transform.forward(signal, spectrum);
        let half = V::LANES / 2;
        let mut columns = [Complex::<V>::zero(); MAX_LANES];
        for (block, pairs) in self.plan.pairs.chunks_exact(half).enumerate() {
            for lane in 0..half {
                (columns[lane], columns[half + lane]) = pairs[lane].spectra(spectrum);
            }
            self.tiles.prefetch(Purpose::Writing, block + AHEAD);
            let tile = self.tiles.tile(block);
            if tile.len() == V::LANES {
                transpose(&columns, tile);
            } else {
                let mut rows = [Complex::<V>::zero(); MAX_LANES];
                transpose(&columns, &mut rows);
                tile.copy_from_slice(&rows[..tile.len()]);
            }
        }
    }
}

/// One block of rows, back: `rows` from their `tiles` of the column blocks.
pub struct InverseRows<'a, V: Vector> {
    pub plan: &'a Rows<V::Scalar>,
    pub tiles: Tiles<'a, V>,
    pub rows: &'a mut [V::Scalar],
    pub scratch: &'a mut Scratch<V>,
}

impl<V: Vector> Kernel for InverseRows<'_, V> {
    #[inline(always)]
    fn run(mut self) {
        let [signal, spectrum] = self.plan.scratch(V::LANES);
        let (signal, spectrum) = self.scratch.buffers(signal, spectrum);
        let half = V::LANES / 2;
        let mut columns = [Complex::<V>::zero(); MAX_LANES];
        for (block, pairs) in self.plan.pairs.chunks_exact(half).enumerate() {
            self.tiles.prefetch(Purpose::Reading, block + AHEAD);
            let tile = self.tiles.tile(block);
            if tile.len() == V::LANES {
                transpose(tile, &mut columns);
            } else {
                let mut rows = [Complex::<V>::zero(); MAX_LANES];
                rows[..tile.len()].copy_from_slice(tile);
                transpose(&rows, &mut columns);
            }
            for lane in 0..half {
                pairs[lane].store(columns[lane], columns[half + lane], spectrum);
            }
        }
        self.plan.transform.inverse(spectrum, signal);
        self.plan.unpack(signal, self.rows);
    }
}
