//! The memory that there is, so that a grid that cannot fit is refused rather than ended by the system.

use crate::base::{JobError, words};
use sweepsim_dexel::Grid;

/// The least that a dexel takes, in bytes: runs take several times as much.
const LEAST: u64 = 24;

/// The least memory in bytes that the dexels of a grid take.
#[must_use]
pub fn least_memory(grid: &Grid) -> u64 {
    (grid.len() as u64).saturating_mul(LEAST)
}

/// Refuses a grid for whose dexels there is no room. `advice` says what else is expected than fewer of them.
///
/// # Errors
/// [`JobError`] with both sizes, where the system tells how much memory is left.
pub(crate) fn check_room(grid: &Grid, advice: &str) -> Result<(), JobError> {
    let needed = least_memory(grid);
    match available() {
        Some(left) if needed > left => {
            let [columns, rows] = grid.cells();
            Err(JobError::run(format!(
                "a grid of {columns} x {rows} dexels takes at least {}, but {} of memory are left: expected fewer cells{advice}",
                words::bytes(needed),
                words::bytes(left)
            )))
        }
        _ => Ok(()),
    }
}

/// The bytes that this process may still take, as far as Linux tells: free memory and swap, the limit of its address
/// space, that of its control group.
fn available() -> Option<u64> {
    let read = |file: &str| std::fs::read_to_string(file).ok();
    let free = read("/proc/meminfo")
        .and_then(|text| Some(field(&text, "MemAvailable:")? + field(&text, "SwapFree:").unwrap_or(0)));
    let free = free.map(|kilobytes| kilobytes.saturating_mul(1024));
    let space = read("/proc/self/limits").and_then(|text| field(&text, "Max address space"));
    let group = read("/sys/fs/cgroup/memory.max").and_then(|text| text.trim().parse().ok());
    [free, space, group].into_iter().flatten().min()
}

/// The first number after a name; `None` if it is none, as with `unlimited`.
fn field(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_fit_is_refused() {
        let of = |cells: [usize; 2]| Grid::new([0.0; 2], [1.0; 2], cells).unwrap();
        assert!(check_room(&of([100, 100]), "").is_ok());
        // 96 GB, which some machines have.
        let most = check_room(&of([63_245, 63_245]), ", or shards");
        let fits = available().is_none_or(|left| left >= 24 * 63_245 * 63_245);
        assert_eq!(most.is_ok(), fits);
    }

    #[test]
    fn fields_are_numbers_after_a_name() {
        let text =
            "MemTotal:  5 kB\nMemAvailable:   123 kB\nMax address space         unlimited            unlimited\n";
        assert_eq!(field(text, "MemAvailable:"), Some(123));
        assert_eq!(field(text, "Max address space"), None);
        assert_eq!(field(text, "SwapFree:"), None);
    }
}
