//! The ready machines, as frames of a short program on each.

use super::runs::{command, read, shown};
use super::sheet;
use crate::workspace;
use std::fs;
use sweepsim_nc::Machine;
use sweepsim_picture::Image;

pub const NAME: &str = "machines";

/// Sizes that suit all of them.
const SIZES: &str = ",table=320,travel=500x400x450,zero=60,length=120";
/// Machines in a row.
const COLUMNS: usize = 5;

/// All ready machines in the order of their names, each with its axes turned a little, over a block.
pub fn image() -> Result<Image, String> {
    let out = workspace::root().join("out/pictures").join(NAME);
    fs::create_dir_all(&out).map_err(|error| format!("{}: {error}", out.display()))?;
    let mut images = Vec::new();
    for name in Machine::names() {
        let machine = Machine::named(name).and_then(|machine| machine.kinematics);
        let machine = machine.ok_or_else(|| format!("{name}: no axes"))?;
        let turns: String = machine.rotary().map(|axis| format!(" {}25", axis.letter)).collect();
        let program = format!(
            "(T1 D=20. CR=0. - ZMIN=0. - flat end mill)\nG21 G90\nT1 M6\nS900 M3\nG0 X0 Y0\nG0 Z120{turns}\nG1 Z110 F900\nM30\n"
        );
        let file = out.join(format!("{name}.nc"));
        fs::write(&file, program).map_err(|error| format!("{}: {error}", file.display()))?;
        let folder = out.join(name);
        let on = format!("{name}{SIZES}");
        command(&[
            "simulate",
            &shown(&file),
            "--machine",
            &on,
            "--stock",
            "block:-60,-45,-60,60,45,0",
            "--cells",
            "60x45",
            "--frames",
            "2",
            "--size",
            "260x240",
            "--no-axes",
            "--camera",
            "-50,24",
            "--only",
            "dexels",
            "--out",
            &shown(&folder),
        ])?;
        images.push(read(&folder.join("frame-0002.png"))?);
    }
    sheet(&images, COLUMNS)
}
