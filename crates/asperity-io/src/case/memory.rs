//! How much memory a run needs, and how much there is.

/// Bytes per cell of a run without retarded terms: padded spectrum of the influence function, the solver's
/// vectors, transforms, gap, histories. A measured upper bound, not a sum of parts.
const BYTES_PER_CELL: u128 = 200;
/// Bytes per cell and retarded term: its field, and what a checkpoint of it takes while it is written.
const BYTES_PER_TERM: u128 = 16;
/// One field of doubles.
const BYTES_PER_FIELD: u128 = 8;

/// Where the system does not say how much memory it has.
const ASSUMED: u128 = 64 << 30;

/// Bytes that a run takes: `branches` retarded terms, `kept` whole pressure fields (direct scheme).
pub fn estimate(cells: [usize; 2], branches: usize, kept: usize) -> u128 {
    let cells = cells[0] as u128 * cells[1] as u128;
    let per_cell = BYTES_PER_CELL + BYTES_PER_TERM * branches as u128 + BYTES_PER_FIELD * kept as u128;
    cells.saturating_mul(per_cell)
}

/// Memory of the machine in bytes; 64 GiB where the system does not tell.
pub fn physical() -> u128 {
    std::fs::read_to_string("/proc/meminfo").ok().and_then(|text| total(&text)).unwrap_or(ASSUMED)
}

/// The line "MemTotal:  24689764 kB" of /proc/meminfo, in bytes.
fn total(meminfo: &str) -> Option<u128> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    let kibibytes: u128 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

/// "3.2 GB".
pub fn words(bytes: u128) -> String {
    const UNITS: [&str; 7] = ["bytes", "kB", "MB", "GB", "TB", "PB", "EB"];
    let mut value = bytes as f64;
    let mut unit = 0;
    while value >= 1000.0 && unit + 1 < UNITS.len() {
        value /= 1000.0;
        unit += 1;
    }
    match unit {
        0 => format!("{bytes} bytes"),
        _ if value >= 1e4 => format!("{value:.1e} {}", UNITS[unit]),
        _ => format!("{value:.3} {}", UNITS[unit]).replace(".000 ", " "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_estimate_grows_with_terms_and_kept_fields() {
        assert_eq!(estimate([1024, 1024], 0, 0), 200 << 20);
        assert_eq!(estimate([1024, 1024], 2, 0), 232 << 20);
        assert_eq!(estimate([10, 10], 0, 101), 100 * (200 + 808));
        assert!(estimate([usize::MAX, usize::MAX], usize::MAX, usize::MAX) > ASSUMED);
    }

    #[test]
    fn the_total_is_read_from_meminfo() {
        assert_eq!(total("MemTotal:       24689764 kB\nMemFree: 1 kB\n"), Some(24_689_764 * 1024));
        assert_eq!(total("MemFree: 1 kB"), None);
        assert_eq!(total("MemTotal: many"), None);
    }

    #[test]
    fn sizes_in_words() {
        assert_eq!(words(999), "999 bytes");
        assert_eq!(words(3_200_000_000), "3.200 GB");
        assert_eq!(words(200_000_000_000_000), "200 TB");
        assert!(words(u128::MAX).ends_with("EB"));
    }
}
