#![no_main]

use asperity_io::topography::Format;

libfuzzer_sys::fuzz_target!(|data: &[u8]| asperity_fuzz::read(Format::Mnt, data));
