//! Compares the engine with a plain two-dimensional transform, and with itself on other instructions.

use ndarray::Array2;
use proptest::prelude::*;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::engine::{Convolve, Engine};
use super::factors::factors;
use super::portable::Portable;
use super::*;

/// Domains and lengths: padded, periodic, wrapped, rectangles, one cell, more lanes than cells. The interpreter Miri runs only
/// the small ones, because it takes about a thousand times as long.
fn shapes() -> impl Iterator<Item = ([usize; 2], [usize; 2])> {
    SHAPES.into_iter().filter(|(_, [mx, my])| !cfg!(miri) || mx * my <= 130)
}

const SHAPES: [([usize; 2], [usize; 2]); 25] = [
    ([1, 1], [1, 1]),
    ([1, 1], [16, 16]),
    ([1, 40], [16, 80]),
    ([37, 1], [80, 16]),
    ([2, 3], [16, 16]),
    ([8, 8], [16, 16]),
    ([9, 13], [32, 48]),
    ([16, 16], [16, 16]),
    ([16, 8], [16, 16]),
    ([12, 24], [12, 24]),
    ([20, 40], [20, 40]),
    ([17, 33], [20, 40]),
    ([15, 21], [15, 21]),
    ([7, 10], [9, 11]),
    ([33, 31], [80, 64]),
    ([64, 64], [128, 128]),
    ([61, 50], [144, 240]),
    ([72, 100], [180, 200]),
    ([90, 120], [180, 240]),
    ([100, 200], [100, 200]),
    ([50, 100], [50, 100]),
    ([27, 30], [27, 30]),
    ([25, 36], [75, 90]),
    ([5, 4], [10, 12]),
    ([3, 2], [3, 2]),
];

/// A fixed, rough field: the fractional part of multiples of the golden ratio, minus a half.
fn field(cells: [usize; 2]) -> Vec<f64> {
    (1..=cells[0] * cells[1]).map(|n| (n as f64 * 0.618_033_988_749_895).fract() - 0.5).collect()
}

/// A positive spectrum that falls with the frequency and differs along the axes.
fn spectrum([mx, my]: [usize; 2]) -> Array2<f64> {
    Array2::from_shape_fn((mx / 2 + 1, my / 2 + 1), |(i, j)| {
        1.0 / (0.3 + i as f64 / mx as f64 + 2.0 * j as f64 / my as f64)
    })
}

/// The oracle: rustfft along both axes of the whole padded array.
fn plain(cells: [usize; 2], lengths: [usize; 2], spectrum: &Array2<f64>, input: &[f64]) -> Vec<f64> {
    let [mx, my] = lengths;
    let mut planner = FftPlanner::new();
    let mut array = Array2::<Complex<f64>>::zeros((mx, my));
    for (n, x) in input.iter().enumerate() {
        array[(n / cells[1], n % cells[1])].re = *x;
    }
    let mut along_both = |array: &mut Array2<Complex<f64>>, direction| {
        for axis in [1, 0] {
            let fft = planner.plan_fft(lengths[axis], direction);
            for mut lane in array.lanes_mut(ndarray::Axis(axis)) {
                let mut signal = lane.to_vec();
                fft.process(&mut signal);
                lane.iter_mut().zip(signal).for_each(|(z, s)| *z = s);
            }
        }
    };
    along_both(&mut array, rustfft::FftDirection::Forward);
    for ((kx, ky), z) in array.indexed_iter_mut() {
        *z *= spectrum[(kx.min(mx - kx), ky.min(my - ky))] / (mx * my) as f64;
    }
    along_both(&mut array, rustfft::FftDirection::Inverse);
    (0..input.len()).map(|n| array[(n / cells[1], n % cells[1])].re).collect()
}

/// The largest difference, relative to the largest value.
fn error(found: &[f64], expected: &[f64]) -> f64 {
    let largest = expected.iter().fold(f64::MIN_POSITIVE, |m, e| m.max(e.abs()));
    found.iter().zip(expected).fold(0.0_f64, |m, (f, e)| m.max((f - e).abs())) / largest
}

fn on_threads<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> R {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

fn apply<T: Real>(mut convolution: BatchedFft<T>, input: &[T]) -> Vec<T> {
    let mut output = vec![T::nearest(f64::NAN); input.len()];
    convolution.apply_into(input, &mut output);
    output
}

#[test]
fn equals_the_plain_transform_on_any_shape() {
    for (cells, lengths) in shapes() {
        let (input, spectrum) = (field(cells), spectrum(lengths));
        let exact = plain(cells, lengths, &spectrum, &input);
        for instructions in Instructions::available() {
            let found =
                apply(BatchedFft::on(instructions, cells, lengths, vec![spectrum.view().into()]), &input);
            let error = error(&found, &exact);
            // Rounding of a transform: a few 2^-53 per pass, some ten passes in all.
            assert!(error < 4e-15, "{instructions:?} {cells:?} {lengths:?}: {error:e}");
            let single: Vec<f32> = input.iter().map(|x| *x as f32).collect();
            let found =
                apply(BatchedFft::on(instructions, cells, lengths, vec![spectrum.view().into()]), &single);
            let found: Vec<f64> = found.into_iter().map(f64::from).collect();
            let error = self::error(&found, &exact);
            // The same with 2^-24.
            assert!(error < 2e-6, "{instructions:?} {cells:?} {lengths:?} in f32: {error:e}");
        }
    }
}

/// The bits of a convolution on every instruction set and number of threads, all of which must agree.
fn assert_same_bits<T: Real>(cells: [usize; 2], lengths: [usize; 2], bits: impl Fn(T) -> u64 + Sync) {
    let (input, spectrum) = (field(cells), spectrum(lengths));
    let input: Vec<T> = input.into_iter().map(T::nearest).collect();
    let run = |instructions, threads| -> Vec<u64> {
        on_threads(threads, || {
            let convolution = BatchedFft::on(instructions, cells, lengths, vec![spectrum.view().into()]);
            apply(convolution, &input).into_iter().map(&bits).collect()
        })
    };
    let portable = run(Instructions::Portable, 1);
    for instructions in Instructions::available() {
        for threads in [1, 2, 3] {
            assert!(
                run(instructions, threads) == portable,
                "{instructions:?} on {threads} threads, {cells:?} of {lengths:?}"
            );
        }
    }
}

#[test]
fn has_the_same_bits_on_all_instructions_and_threads() {
    for (cells, lengths) in shapes() {
        assert_same_bits::<f64>(cells, lengths, f64::to_bits);
        assert_same_bits::<f32>(cells, lengths, |x| u64::from(x.to_bits()));
    }
}

#[test]
fn has_the_same_bits_for_any_number_of_lanes() {
    fn run<const N: usize>(cells: [usize; 2], lengths: [usize; 2]) -> Vec<u64> {
        let (x, y) = (factors(lengths[0]).unwrap(), factors(lengths[1] / 2).unwrap());
        let spectrum = spectrum(lengths);
        let mut engine =
            Engine::<Portable<f64, N>>::new(cells, lengths, [&x, &y], vec![spectrum.view().into()]);
        let mut output = vec![0.0; cells[0] * cells[1]];
        engine.forward(&field(cells));
        engine.multiply(0);
        engine.back(&mut output);
        output.into_iter().map(f64::to_bits).collect()
    }
    let shapes = [([20, 40], [20, 40]), ([33, 31], [80, 64])];
    for (cells, lengths) in &shapes[..if cfg!(miri) { 1 } else { 2 }] {
        let (cells, lengths) = (*cells, *lengths);
        let four = run::<4>(cells, lengths);
        assert_eq!(run::<8>(cells, lengths), four);
        assert_eq!(run::<16>(cells, lengths), four);
    }
}

#[test]
fn a_plan_can_be_used_again_and_on_more_threads_than_it_was_made_for() {
    let (cells, lengths) = if cfg!(miri) { ([9, 13], [18, 30]) } else { ([61, 50], [144, 240]) };
    let spectrum = spectrum(lengths);
    let mut convolution = on_threads(1, || BatchedFft::<f64>::new(cells, lengths, spectrum.view()));
    let other: Vec<f64> = field(cells).iter().map(|x| 1.0 / x).collect();
    let mut output = vec![0.0; other.len()];
    convolution.apply_into(&other, &mut output);
    let again = on_threads(3, || {
        let mut output = vec![0.0; other.len()];
        convolution.apply_into(&field(cells), &mut output);
        output
    });
    assert_eq!(again, apply(BatchedFft::new(cells, lengths, spectrum.view()), &field(cells)));
}

/// The factor of a cell between two convolutions, by its number.
fn weight<T: Real>(n: usize) -> T {
    T::nearest([0.0, -1.0, 0.5, 2.0][n % 4])
}

fn weighted<T: Real + std::ops::Mul<Output = T>>(x: &[T]) -> Vec<T> {
    x.iter().enumerate().map(|(n, x)| *x * weight(n)).collect()
}

#[test]
fn a_chain_is_one_convolution_after_the_other() {
    fn check<T: Real + std::ops::Mul<Output = T>>(rows: usize, rounding: f64) {
        for (cells, lengths) in shapes() {
            let spectra = [spectrum(lengths), spectrum(lengths).mapv(|s| 1.0 / (0.2 + s))];
            let input: Vec<T> = field(cells).into_iter().map(T::nearest).collect();
            let plan = |instructions, number: &[usize]| {
                let views = number.iter().map(|n| spectra[*n].view().into()).collect();
                BatchedFft::<T>::on(instructions, cells, lengths, views)
            };
            let dot =
                |x: &[T], y: &[T]| -> f64 { x.iter().zip(y).map(|(x, y)| x.widened() * y.widened()).sum() };
            let mut energies = Vec::new();
            for instructions in Instructions::available() {
                let first = apply(plan(instructions, &[0]), &input);
                let between = weighted(&first);
                let second = apply(plan(instructions, &[1]), &between);
                let third = apply(plan(instructions, &[0]), &weighted(&second));

                let mut plan = plan(instructions, &[0, 1]);
                let mut kept = vec![T::default(); input.len()];
                let change =
                    |n: usize, x: &mut [T]| x.iter_mut().zip(n..).for_each(|(x, n)| *x = *x * weight(n));
                let groups = std::sync::atomic::AtomicUsize::new(0);
                let mut chain = plan.chain(&input);
                let before = chain.multiply(0);
                chain.modify(&mut kept, &|n, x, kept| {
                    // All instructions use groups of the same rows, and each group begins at a whole byte of a set.
                    assert!(n.is_multiple_of(8) && n.is_multiple_of(rows * cells[1]));
                    groups.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                    kept.copy_from_slice(x);
                    change(n, x);
                });
                assert_eq!(groups.into_inner(), cells[0].div_ceil(rows));
                let energy = chain.multiply(1);
                chain.modify(&mut [], &|n, x, none| {
                    assert!(none.is_empty());
                    change(n, x);
                });
                chain.multiply(0);
                let mut output = vec![T::default(); input.len()];
                chain.finish(&mut output, &|_, x, output| output.copy_from_slice(x));
                assert!(kept == first && output == third, "{instructions:?} {cells:?} {lengths:?}");

                // x'S x by Parseval's theorem, and by its definition: a column is a sum of this number of terms.
                for (found, x, y) in [(before, &input, &first), (energy, &between, &second)] {
                    let error =
                        (found - dot(x, y)).abs() / dot(y, y).sqrt().max(1e-30) / dot(x, x).sqrt().max(1e-30);
                    let most = (16 + 2 * lengths[0]) as f64 * rounding;
                    assert!(error < most, "{instructions:?} {cells:?} {lengths:?}: {error:e}");
                }
                energies.push([before.to_bits(), energy.to_bits()]);
            }
            assert!(energies.windows(2).all(|two| two[0] == two[1]), "{cells:?} {lengths:?}");
        }
    }
    check::<f64>(8, f64::EPSILON);
    check::<f32>(16, f64::from(f32::EPSILON));
}

#[test]
fn zero_gives_zero_and_one_cell_its_response() {
    let (cells, lengths) = if cfg!(miri) { ([6, 10], [12, 20]) } else { ([24, 40], [48, 80]) };
    let spectrum = spectrum(lengths);
    let zero = vec![0.0; cells[0] * cells[1]];
    assert_eq!(apply(BatchedFft::<f64>::new(cells, lengths, spectrum.view()), &zero), zero);
    // A unit in a corner shows the kernel, which is the transform of the spectrum.
    let mut unit = zero;
    unit[0] = 1.0;
    let response = apply(BatchedFft::<f64>::new(cells, lengths, spectrum.view()), &unit);
    let kernel = crate::even_spectrum(&spectrum, lengths) / (lengths[0] * lengths[1]) as f64;
    let exact: Vec<f64> = kernel.slice(ndarray::s![..cells[0], ..cells[1]]).iter().copied().collect();
    assert!(error(&response, &exact) < 4e-15);
}

/// Largest number of cells along one side of a random shape, and of cells of padding.
const MOST: usize = if cfg!(miri) { 16 } else { 90 };

proptest! {
    // Each case has a few thousand cells, so about a hundred cases take only seconds.
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 3 } else { 96 }))]

    #[test]
    fn equals_the_plain_transform_on_random_shapes(
        nx in 1..MOST,
        ny in 1..MOST,
        extra_x in 0..MOST,
        extra_y in 0..MOST,
        good in any::<bool>(),
        values in proptest::collection::vec(-1.0..1.0, MOST * MOST),
    ) {
        let cells = [nx, ny];
        let lengths = if good {
            cells.map(|n| BatchedFft::<f64>::good_length(2 * n - 1))
        } else {
            [nx + extra_x, ny + extra_y]
        };
        let spectrum = spectrum(lengths);
        let input = &values[..nx * ny];
        let exact = plain(cells, lengths, &spectrum, input);
        let found = apply(BatchedFft::new(cells, lengths, spectrum.view()), input);
        let error = error(&found, &exact);
        // As above; a wrapped kernel adds the rounding of two more transforms.
        prop_assert!(error < 1e-14, "{cells:?} {lengths:?}: {error:e}");
    }
}
