//! The faces of a target that is a STEP file, and how the part deviates on them.

use sweepsim_formats::FaceDeviation;
use sweepsim_job::words;

/// The most faces that are listed.
const FACES: usize = 10;

/// A line for each face on which the part deviates, the worst first; for all if they are few.
pub(super) fn by_face(faces: &[FaceDeviation], file: &str, line: &mut impl FnMut(&str, &str)) {
    let deviates = |face: &&FaceDeviation| face.gouge > 0.0 || face.excess > 0.0;
    let mut listed: Vec<&FaceDeviation> = faces
        .iter()
        .filter(|face| faces.len() <= FACES || deviates(face))
        .collect();
    listed.sort_by(|a, b| b.gouge.max(b.excess).total_cmp(&a.gouge.max(a.excess)));
    for face in listed.iter().take(FACES) {
        let [gouge, excess, mean, rms] = [face.gouge, face.excess, face.mean, face.rms].map(length);
        let area = words::measure(face.area);
        let of = format!("{} ({})", face.face, face.kind);
        let what = if face.area > 0.0 {
            format!("{of}: gouge {gouge}, excess {excess}, mean {mean}, RMS {rms} mm, over {area} mm²")
        } else if deviates(face) {
            format!("{of}: gouge at least {gouge}, excess at least {excess} mm; no mean, as it is along the dexels")
        } else {
            format!("{of}: not known, as it is along the dexels")
        };
        line("face", &what);
    }
    if listed.len() > FACES {
        line("", &format!("… and {} more, all in {file}", listed.len() - FACES));
    }
}

/// A distance. Values below the rounding errors of millimetres in `f64` are shown as 0.
pub(super) fn length(value: f64) -> String {
    words::measure(if value.abs() < 1e-10 { 0.0 } else { value })
}
