//! Memory of a very fine grid. `cargo test --release -p sweepsim-dexel --test large -- --ignored --nocapture`

use sweepsim_dexel::{Grid, Interval, Stock};

/// Most memory that this process has had, where the system says.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(1024 * line.split_whitespace().nth(1)?.parse::<u64>().ok()?)
}

#[test]
#[ignore = "takes 4 GiB"]
fn ten_thousand_by_ten_thousand_dexels_of_a_block_fit_in_six_gibibytes() {
    const LIMIT: u64 = 6 << 30;
    let grid = Grid::new([0.0; 2], [1000.0; 2], [10_000; 2]).unwrap();
    let (min, max) = ([0.0; 3], [1000.0, 1000.0, 100.0]);
    let start = std::time::Instant::now();
    let mut dexels = Stock::Block { min, max }.dexels(&grid).unwrap();
    let filled = start.elapsed();
    assert_eq!((dexels.count(), dexels.covered()), (100_000_000, 100_000_000));
    assert!((dexels.volume() - 1e8).abs() < 1e-2);
    // And it can still be cut.
    for index in (0..grid.len()).step_by(997) {
        dexels.subtract(index, &[Interval::between(40.0, 60.0)]).unwrap();
    }
    assert_eq!(dexels.count(), 100_000_000 + grid.len().div_ceil(997));
    let bytes = dexels.bytes() as u64;
    let gib = |bytes: u64| bytes as f64 / f64::from(1 << 30);
    println!(
        "{:.2} GiB of dexels, filled in {filled:.1?}; peak {:.2?} GiB",
        gib(bytes),
        peak().map(gib)
    );
    assert!(bytes < LIMIT && peak().is_none_or(|peak| peak < LIMIT));
}
