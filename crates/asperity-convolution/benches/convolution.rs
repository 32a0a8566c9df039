//! One convolution: the lane-batched engine on every instruction set, against the rustfft form.
//!
//! `cargo bench -p asperity-convolution --bench convolution -- [SECONDS] [N ...]`: alternates the forms, so that a busy machine
//! slows down all of them, and prints the shortest and the median time of each [ms].

use std::time::Instant;

use asperity_convolution::batched::BatchedFft;
use asperity_convolution::{OnRustfft, even_spectrum};
use asperity_sweep::Instructions;
use ndarray::Array2;

type Form = (String, Box<dyn FnMut() -> f64 + Send>, Vec<f64>);

fn main() {
    let arguments: Vec<f64> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    let seconds = arguments.first().copied().unwrap_or(2.0);
    let sizes: Vec<usize> = match arguments.get(1..) {
        Some(sizes) if !sizes.is_empty() => sizes.iter().map(|n| *n as usize).collect(),
        _ => vec![512, 1024, 2048],
    };
    for n in sizes {
        let lengths = [2 * n; 2];
        let kernel =
            Array2::from_shape_fn((n + 1, n + 1), |(i, j)| 1.0 / (1.0 + (i * i + j * j) as f64).sqrt());
        let spectrum = even_spectrum(&kernel, lengths);
        let input: Vec<f64> = (0..n * n).map(|i| (i * 7919 % 1013) as f64 / 1013.0).collect();
        let single: Vec<f32> = input.iter().map(|x| *x as f32).collect();
        let mut exact = vec![0.0; n * n];
        let mut form = OnRustfft::new([n, n], lengths, spectrum.view());
        form.apply_into(&input, &mut exact);
        let scale = exact.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut forms: Vec<Form> = Vec::new();
            pool.install(|| {
                let (input, single, exact) = (input.clone(), single.clone(), exact.clone());
                let mut form = OnRustfft::new([n, n], lengths, spectrum.view());
                let (i, mut out) = (input.clone(), vec![0.0; n * n]);
                forms.push((
                    "rustfft f64".into(),
                    Box::new(move || {
                        form.apply_into(&i, &mut out);
                        0.0
                    }),
                    vec![],
                ));
                for instructions in Instructions::available() {
                    if instructions == Instructions::Portable {
                        continue;
                    }
                    let mut form =
                        BatchedFft::<f64>::on(instructions, [n, n], lengths, vec![spectrum.view().into()]);
                    let (i, e, mut out) = (input.clone(), exact.clone(), vec![0.0; n * n]);
                    forms.push((
                        format!("{instructions:?} f64"),
                        Box::new(move || {
                            form.apply_into(&i, &mut out);
                            (0..e.len()).step_by(97).fold(0.0, |m: f64, k| m.max((e[k] - out[k]).abs()))
                        }),
                        vec![],
                    ));
                    let mut form =
                        BatchedFft::<f32>::on(instructions, [n, n], lengths, vec![spectrum.view().into()]);
                    let (i, e, mut out) = (single.clone(), exact.clone(), vec![0.0; n * n]);
                    forms.push((
                        format!("{instructions:?} f32"),
                        Box::new(move || {
                            form.apply_into(&i, &mut out);
                            (0..e.len())
                                .step_by(97)
                                .fold(0.0, |m: f64, k| m.max((e[k] - f64::from(out[k])).abs()))
                        }),
                        vec![],
                    ));
                }
            });
            let start = Instant::now();
            while start.elapsed().as_secs_f64() < seconds || forms[0].2.len() < 5 {
                for (_, form, times) in &mut forms {
                    let t = Instant::now();
                    pool.install(&mut *form);
                    times.push(t.elapsed().as_secs_f64() * 1e3);
                }
            }
            let mut base = [0.0; 2];
            for (k, (name, form, times)) in forms.iter_mut().enumerate() {
                times.sort_by(f64::total_cmp);
                let found = [times[0], times[times.len() / 2]];
                if k == 0 {
                    base = found;
                }
                println!(
                    "{n} threads {threads} {name:12} min {:8.3} median {:8.3}  ratio {:5.2} {:5.2}  error {:.1e}",
                    found[0],
                    found[1],
                    base[0] / found[0],
                    base[1] / found[1],
                    form() / scale
                );
            }
        }
    }
}
