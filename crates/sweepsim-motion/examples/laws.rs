//! How much the motion of a tool between the same two poses differs between laws.

use sweepsim_motion::{Law, Path, Pose, RotaryTable};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let poses = vec![
        Pose::new([0.0, 0.0, 0.0], [0.3, 0.0, 1.0])?,
        Pose::new([20.0, 5.0, 0.0], [-0.1, 0.5, 1.0])?,
    ];
    let (reach, deviation) = (60.0, 1e-4);
    let laws = [
        ("SLERP", Law::Slerp),
        ("constant speed", Law::ConstantSpeed),
        ("rotary axes A/C", Law::Rotary(RotaryTable::Ac)),
        ("rotary axes B/C", Law::Rotary(RotaryTable::Bc)),
    ];
    // The holder end of the tool at a quarter of the time.
    let mut first = None;
    for (name, law) in laws {
        let path = Path::with_law(poses.clone(), law)?;
        let parts = path.segments(0, reach, deviation);
        let quarter = 0.25 * parts.len() as f64;
        let part = &parts[quarter as usize];
        // The parameter whose time it is, by bisection: time increases with the parameter.
        let (mut low, mut high) = (0.0, 1.0);
        while high - low > 1e-15 {
            let middle = 0.5 * (low + high);
            if part.time(middle) < quarter.fract() {
                low = middle
            } else {
                high = middle
            }
        }
        let (turn, tip) = part.at(low);
        let top = nalgebra::Vector3::from(tip) + turn.column(2) * reach;
        let from_slerp = (top - *first.get_or_insert(top)).norm();
        println!(
            "{name:16} {:3} parts, {from_slerp:8.4} mm from SLERP at {reach} mm above the tip",
            parts.len()
        );
    }
    Ok(())
}
