//! A tool beside the part, and a point of view that stays.

use sweepsim_dexel::{Grid, Mesh, Stock};
use sweepsim_picture::{Axis, CuttingPlane, Drawing, Image, View};

fn block(min: [f64; 3], max: [f64; 3]) -> Mesh {
    let grid = Grid::new([-5.0, -5.0], [45.0, 35.0], [50, 40]).unwrap();
    Stock::Block { min, max }.dexels(&grid).unwrap().surface().unwrap()
}

/// From above: 40 × 30 mm fill 160 × 120 pixels up to the margin.
fn from_above() -> View {
    let mut view = View::default();
    view.size = [160, 120];
    view.azimuth = -90.0;
    view.elevation = 90.0;
    view.orthographic = true;
    view.axes = false;
    view
}

fn at(image: &Image, x: f64, y: f64) -> [u8; 3] {
    let scale = 0.86 * 120.0 / 30.0;
    let place = [80.0 + (x - 20.0) * scale, 60.0 - (y - 15.0) * scale];
    image.pixel(place[0] as usize, place[1] as usize).unwrap()
}

fn warm([red, _, blue]: [u8; 3]) -> bool {
    red > blue
}

const WHOLE: [[f64; 3]; 2] = [[0.0; 3], [40.0, 30.0, 12.0]];

#[test]
fn the_point_of_view_stays_while_the_part_changes() {
    let (whole, rest) = (block(WHOLE[0], WHOLE[1]), block([0.0; 3], [20.0, 30.0, 12.0]));
    let view = from_above();
    // The box of the part is the box that it would be seen in anyway.
    let picture = view.draw(&Drawing::new(&whole).within(WHOLE));
    assert_eq!(picture, view.render(&whole));
    let picture = view.draw(&Drawing::new(&rest).within(WHOLE));
    let background = at(&picture, -1.5, 15.0);
    let light = |[red, green, blue]: [u8; 3]| u32::from(red) + u32::from(green) + u32::from(blue);
    assert!(light(at(&picture, 10.0, 15.0)) + 60 < light(background));
    assert!(light(at(&picture, 38.0, 15.0)) + 60 > light(background));
    // A part that is gone altogether leaves the background; boxes that are none are ignored.
    let nothing = view.draw(&Drawing::new(&Mesh::default()).within(WHOLE));
    assert_eq!(nothing.size(), [160, 120]);
    let backwards = [WHOLE[1], WHOLE[0]];
    for bad in [backwards, [[f64::NAN; 3]; 2], [[0.0; 3], [f64::INFINITY; 3]]] {
        assert_eq!(view.draw(&Drawing::new(&whole).within(bad)), view.render(&whole));
    }
}

#[test]
fn a_tool_is_drawn_beside_the_part_and_no_section_cuts_it() {
    let (part, tool) = (block(WHOLE[0], WHOLE[1]), block([30.0, 10.0, 12.0], [36.0, 20.0, 40.0]));
    let view = from_above();
    let sections = [CuttingPlane {
        axis: Axis::Z,
        at: 20.0,
    }];
    for picture in [
        view.draw(&Drawing::new(&part).tool(&tool)),
        view.draw(&Drawing::new(&part).tool(&tool).sections(&sections)),
    ] {
        // Brass on steel, and the part where it is without the tool.
        assert!(warm(at(&picture, 33.0, 15.0)));
        assert!(!warm(at(&picture, 20.0, 15.0)) && !warm(at(&picture, 2.0, 2.0)));
    }
    // What a section lays open is behind the tool.
    let open = [CuttingPlane { axis: Axis::Z, at: 6.0 }];
    let picture = view.draw(&Drawing::new(&part).tool(&tool).sections(&open));
    let [brass, clay] = [at(&picture, 33.0, 15.0), at(&picture, 20.0, 15.0)];
    assert!(warm(brass) && warm(clay) && brass != clay, "{brass:?} {clay:?}");
    // A tool that reaches behind the camera is left out, and no more.
    let huge = block([0.0; 3], [40.0, 30.0, 1e6]);
    let mut near = View::default();
    near.size = [160, 120];
    near.elevation = 80.0;
    assert_eq!(
        near.draw(&Drawing::new(&part).tool(&huge).within(WHOLE)).size(),
        [160, 120]
    );
    // Without a part, the tool fills the picture.
    let alone = view.draw(&Drawing::new(&Mesh::default()).tool(&tool));
    assert!(warm(alone.pixel(80, 60).unwrap()));
}
