//! Lists tools with the patches and edges of their boundaries.

use sweepsim_motion::{Apt, Barrel, Dovetail, Lens, Lollipop, Tool};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let drill = Apt {
        d: 10.0,
        r: 0.0,
        e: 5.0,
        f: 0.0,
        a: 31.0,
        b: 0.0,
        h: 40.0,
    };
    let taper = Apt {
        d: 5.832_662_348,
        r: 1.0,
        e: 2.0,
        f: 1.0,
        a: 0.0,
        b: 5.0,
        h: 40.0,
    };
    let tools = [
        ("ball", Tool::ball(5.0, 40.0)?),
        ("flat", Tool::flat(5.0, 40.0)?),
        ("bull", Tool::bull(5.0, 1.0, 40.0)?),
        (
            "lollipop",
            Tool::lollipop(Lollipop {
                radius: 5.0,
                neck: 2.0,
                length: 40.0,
            })?,
        ),
        (
            "dovetail",
            Tool::dovetail(Dovetail {
                radius: 8.0,
                angle: 60.0,
                height: 5.0,
                neck: 3.0,
                length: 40.0,
            })?,
        ),
        (
            "barrel",
            Tool::barrel(Barrel {
                radius: 5.0,
                flank: 60.0,
                height: 20.0,
                corner: 0.0,
                length: 40.0,
            })?,
        ),
        (
            "lens",
            Tool::lens(Lens {
                radius: 5.0,
                bottom: 20.0,
                corner: 0.0,
                length: 40.0,
            })?,
        ),
        ("APT drill", Tool::apt(&drill)?.0),
        ("APT taper", Tool::apt(&taper)?.0),
    ];
    for (name, tool) in tools {
        println!(
            "{name:10} {:2} patches, {:2} sharp edges, reaches {:5.2} from its tip",
            tool.patches().len(),
            tool.edges().len(),
            tool.reach()
        );
    }
    // A barrel: its flank of radius 20 cuts the bottom plane.
    let barrel = Apt {
        d: 12.0,
        r: 20.0,
        e: -14.0,
        f: 10.0,
        a: 0.0,
        b: 0.0,
        h: 40.0,
    };
    for warning in Tool::apt(&barrel)?.1 {
        println!("APT barrel: {warning}");
    }
    Ok(())
}
