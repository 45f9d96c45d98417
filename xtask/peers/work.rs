// Shared by the peers' programs: what `cargo xtask peers` asks for, and how they answer.

/// The work: a tool, a block, and poses.
pub struct Work {
    /// Whether the tool is a ball end; else it is flat.
    pub ball: bool,
    pub radius: f64,
    pub length: f64,
    /// The block's corners.
    pub min: [f64; 3],
    pub max: [f64; 3],
    /// Columns along each side, seen along z.
    pub cells: usize,
    /// Tip and axis of each pose.
    pub poses: Vec<([f64; 3], [f64; 3])>,
}

impl Work {
    /// Reads the file that the first argument names: `key,values…` in each line.
    pub fn read() -> Self {
        let file = std::env::args().nth(1).expect("the work's file");
        let text = std::fs::read_to_string(&file).expect(&file);
        let mut work =
            Self { ball: false, radius: 0.0, length: 0.0, min: [0.0; 3], max: [0.0; 3], cells: 0, poses: Vec::new() };
        for line in text.lines() {
            let (key, rest) = line.split_once(',').expect("key,values");
            let values: Vec<f64> = rest.split(',').map(|word| word.parse().expect("a number")).collect();
            match key {
                "ball" | "flat" => {
                    (work.ball, work.radius, work.length) = (key == "ball", values[0], values[1]);
                }
                "block" => {
                    work.min.copy_from_slice(&values[..3]);
                    work.max.copy_from_slice(&values[3..]);
                }
                "cells" => work.cells = values[0] as usize,
                _ => work.poses.push(([values[0], values[1], values[2]], [values[3], values[4], values[5]])),
            }
        }
        work
    }

    /// The second argument: a step or a tolerance, in mm.
    pub fn setting() -> f64 {
        std::env::args().nth(2).and_then(|word| word.parse().ok()).expect("a step or a tolerance")
    }
}

/// Writes numbers to the file that the third argument names, and the seconds to the standard output.
pub fn answer(seconds: f64, numbers: impl Iterator<Item = f64>) {
    let file = std::env::args().nth(3).expect("the answer's file");
    let bytes: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
    std::fs::write(&file, bytes).expect(&file);
    println!("{seconds}");
}

/// Seconds of processor time of this thread, where the system tells; else seconds since the start by the clock.
pub fn seconds() -> f64 {
    let own = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = own.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(
        || std::time::UNIX_EPOCH.elapsed().expect("a clock after 1970").as_secs_f64(),
        |nanoseconds| nanoseconds * 1e-9,
    )
}
