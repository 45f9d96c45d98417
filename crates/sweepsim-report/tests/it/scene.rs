//! Round trips of the embedded data, and its size.

use crate::decoder::Data;
use sweepsim_props::*;
use sweepsim_report::{
    Area, Course, DexelLayer, KeyFrame, LayerEnd, Page, ProgramText, Scene, Surface, Track, TrackPoint,
};

type Lines = Vec<Vec<[LayerEnd; 2]>>;

fn layer(area: Area, lines: &Lines) -> DexelLayer {
    DexelLayer::new(area, |i, j, line| line.extend_from_slice(&lines[i * area.cells[1] + j]))
}

fn end() -> impl Strategy<Value = LayerEnd> {
    let normal =
        prop::array::uniform3(-1.0_f32..1.0).prop_filter("not short", |n| n.iter().map(|c| c * c).sum::<f32>() > 0.1);
    let deviation = prop_oneof![Just(f32::NAN), -3.0_f32..3.0];
    (normal, deviation, 0_u32..100_000).prop_map(|(normal, deviation, maker)| {
        let size = normal.iter().map(|c| c * c).sum::<f32>().sqrt();
        LayerEnd {
            normal: normal.map(|c| c / size),
            deviation,
            maker,
            ..LayerEnd::at(0.0, [0.0; 3])
        }
    })
}

/// Up to three intervals on each line, from the lowest up.
fn lines(count: usize) -> impl Strategy<Value = Lines> {
    let interval = (0.05_f64..3.0, 0.05_f64..9.0, end(), end());
    let line = collection::vec(interval, 0..4).prop_map(|parts| {
        let mut z = -7.0;
        let place = |(gap, length, lower, upper): (f64, f64, LayerEnd, LayerEnd)| {
            let (low, high) = (z + gap, z + gap + length);
            z = high;
            [LayerEnd { z: low, ..lower }, LayerEnd { z: high, ..upper }]
        };
        parts.into_iter().map(place).collect()
    });
    collection::vec(line, count)
}

/// A unit vector from the two numbers of its octahedron.
fn unfolded([u, v]: [f64; 2]) -> [f64; 3] {
    let z = 1.0 - u.abs() - v.abs();
    let t = (-z).max(0.0);
    let [x, y] = [u - t.copysign(u), v - t.copysign(v)];
    let size = (x * x + y * y + z * z).sqrt();
    [x / size, y / size, z / size]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Heights come back to half a step, normals to a degree and a half, deviations to half a step, makers exactly.
    #[test]
    fn the_part_comes_back(cells in (1_usize..6, 1_usize..6), all in lines(25)) {
        let area = Area { min: [-3.0, 2.0], max: [5.0, 9.0], cells: [cells.0, cells.1] };
        let mut page = Page::new("part");
        let mut scene = Scene::new(layer(area, &all));
        scene.limits = Some([0.02, 0.1]);
        page.scene = Some(scene);
        let data = Data::of(&page.html());
        let step = data.number("/height/step");
        let found = data.lines(["part.counts", "lower", "upper"]);
        prop_assert_eq!(found.len(), cells.0 * cells.1);
        let mut k = 0;
        for (found, line) in found.iter().zip(&all) {
            prop_assert_eq!(found.len(), line.len());
            for (found, own) in found.iter().zip(line) {
                for (side, name) in ["lower", "upper"].iter().enumerate() {
                    prop_assert!((found[side] - own[side].z).abs() <= 0.5001 * step, "{} and {}", found[side], own[side].z);
                    let packed = ["u", "v"].map(|axis| data.array(&format!("{name}.{axis}"))[k] as f64 / 127.0);
                    let normal = own[side].normal.map(f64::from);
                    let cosine: f64 = unfolded(packed).iter().zip(normal).map(|(a, b)| a * b).sum();
                    prop_assert!(cosine > 1.5_f64.to_radians().cos(), "{}", cosine);
                    prop_assert_eq!(data.array(&format!("{name}.maker"))[k], i64::from(own[side].maker));
                    if data.has("lower.deviation") {
                        let steps = data.array(&format!("{name}.deviation"))[k];
                        let deviation = f64::from(own[side].deviation);
                        let error = (steps as f64 * data.number("/deviation") - deviation).abs();
                        let good = if deviation.is_nan() { steps == -32_768 } else { error <= 0.5001 * data.number("/deviation") };
                        prop_assert!(good, "{} and {}", steps, deviation);
                    } else {
                        prop_assert!(own[side].deviation.is_nan());
                    }
                }
                k += 1;
            }
        }
    }

    /// The workpiece at each moment comes back, however many moments had to be joined.
    #[test]
    fn the_course_comes_back(start in lines(12), changes in collection::vec(collection::btree_map(0_u32..12, lines(1), 1..5), 1..9), few in any::<bool>()) {
        let area = Area { min: [0.0; 2], max: [4.0, 3.0], cells: [4, 3] };
        let heights = |line: &[[LayerEnd; 2]]| line.iter().map(|ends| ends.map(|end| end.z)).collect::<Vec<_>>();
        let measured = |line: &[[LayerEnd; 2]]| line.iter().map(|ends| (ends.map(|end| end.z), ends.map(|end| end.deviation))).collect::<Vec<_>>();
        // Without joining, every end that is embedded is known.
        let pushed: Vec<[f32; 2]> = changes.iter().flatten().flat_map(|(_, own)| own[0].iter().map(|ends| ends.map(|end| end.deviation))).collect();
        let mut state: Vec<Vec<[f64; 2]>> = start.iter().map(|line| heights(line)).collect();
        let mut states = vec![state.clone()];
        let mut frames = Vec::new();
        for (n, change) in changes.iter().enumerate() {
            let mut frame = KeyFrame::new(n as f64 + 1.0);
            for (line, own) in change {
                state[*line as usize] = heights(&own[0]);
                frame.push_measured(*line, measured(&own[0]));
            }
            frames.push(frame);
            states.push(state.clone());
        }
        let mut page = Page::new("course");
        let mut scene = Scene::new(layer(area, &start));
        scene.course = Some(Course { start: layer(area, &start), frames });
        page.scene = Some(scene);
        if few {
            // Less than all moments need, more than the rest does.
            let whole = page.html().len();
            page.scene.as_mut().unwrap().course.as_mut().unwrap().frames.truncate(1);
            let least = page.html().len();
            page.scene.as_mut().unwrap().course.as_mut().unwrap().frames = {
                let mut again = Vec::new();
                for (n, change) in changes.iter().enumerate() {
                    let mut frame = KeyFrame::new(n as f64 + 1.0);
                    for (line, own) in change {
                        frame.push_measured(*line, measured(&own[0]));
                    }
                    again.push(frame);
                }
                again
            };
            page.most_bytes = (whole + least) / 2 + 100_000;
        }
        let data = Data::of(&page.html());
        if data.head["course"].is_null() {
            prop_assert!(few);
            return Err(TestCaseError::reject("nothing of the course is left"));
        }
        let step = data.number("/height/step");
        let mut now = data.lines(["start.counts", "start.lower", "start.upper"]);
        let clocks: Vec<f64> = data.head["course"]["clocks"].as_array().unwrap().iter().map(|c| c.as_f64().unwrap()).collect();
        prop_assert_eq!(clocks.last().copied(), Some(changes.len() as f64));
        let height = |steps: i64| data.number("/height/from") + steps as f64 * step;
        let (mut at, mut k) = (0, 0);
        for (clock, size) in clocks.iter().zip(data.array("frames.size")) {
            for _ in 0..*size {
                let line = data.array("frames.line")[at] as usize;
                let count = data.array("frames.counts")[at] as usize;
                now[line] = (k..k + count).map(|k| [height(data.array("frames.lower")[k]), height(data.array("frames.upper")[k])]).collect();
                (at, k) = (at + 1, k + count);
            }
            for (found, own) in now.iter().zip(&states[*clock as usize]) {
                prop_assert_eq!(found.len(), own.len());
                for (found, own) in found.iter().flatten().zip(own.iter().flatten()) {
                    prop_assert!((found - own).abs() <= 0.5001 * step, "{} {}", found, own);
                }
            }
        }
        prop_assert_eq!((at, k), (data.array("frames.line").len(), data.array("frames.lower").len()));
        if data.has("frames.lower.deviation") {
            let step = data.number("/deviation");
            prop_assert_eq!(data.array("start.lower.deviation").len(), data.array("start.lower").len());
            prop_assert_eq!(data.array("frames.upper.deviation").len(), k);
            for (k, own) in pushed.iter().enumerate().filter(|_| clocks.len() == changes.len()) {
                for (name, deviation) in ["frames.lower.deviation", "frames.upper.deviation"].iter().zip(own) {
                    let steps = data.array(name)[k];
                    // What the start does not reach is cut off at the last step.
                    let error = (steps as f64 * step - f64::from(*deviation)).abs();
                    let good = if deviation.is_nan() { steps == -32_768 } else { error <= 0.5001 * step || steps.abs() == 32_767 };
                    prop_assert!(good, "{} and {}", steps, deviation);
                }
            }
        } else {
            prop_assert!(start.iter().flatten().flatten().all(|end| end.deviation.is_nan()));
        }
    }
}

/// Corners come back to half a step, deviations too, and what made each triangle exactly; triangles without a corner
/// are left out.
#[test]
fn the_surface_comes_back() {
    let place = |n: u32| {
        [
            f64::from(n % 7) * 1.3,
            f64::from(n / 7) * 0.7 - 2.0,
            f64::from(n * n % 11),
        ]
    };
    let count = 49;
    let mut surface = Surface {
        vertices: (0..count).map(place).collect(),
        normals: (0..count)
            .map(|n| if n % 2 == 0 { [0.0, 0.6, 0.8] } else { [1.0, 0.0, 0.0] })
            .collect(),
        deviations: (0..count)
            .map(|n| if n % 5 == 0 { f32::NAN } else { n as f32 * 0.01 - 0.2 })
            .collect(),
        whole: 500,
        farthest: 0.25,
        ..Surface::default()
    };
    for n in 0..40 {
        surface.triangles.push([n, n + 1, n + 8]);
        surface.makers.push(n % 3);
        surface.triangles.push([n, n + 8, n + 7]);
        surface.makers.push(100 + n);
    }
    surface.triangles.push([0, 1, count]);
    surface.makers.push(9);
    let mut page = Page::new("surface");
    let area = Area {
        min: [0.0; 2],
        max: [1.0; 2],
        cells: [1, 1],
    };
    let mut scene = Scene::new(DexelLayer::new(area, |_, _, _| {}));
    scene.limits = Some([0.02, 0.1]);
    scene.surface = Some(surface.clone());
    page.scene = Some(scene);
    let html = page.html();
    assert!(html.contains("The part is drawn by 81 triangles of 500, from which the farthest corner is 0.25 mm."));
    let data = Data::of(&html);
    assert_eq!(
        (data.number("/surface/triangles"), data.number("/surface/farthest")),
        (80.0, 0.25)
    );
    let corners = data.array("surface.corners");
    let step = data.number("/deviation");
    for (n, own) in corners.chunks(3).enumerate() {
        let old = surface.triangles[n];
        assert_eq!(
            data.array("surface.maker")[own[2] as usize],
            i64::from(surface.makers[n]),
            "{n}"
        );
        // The same triangle, the same way round.
        let place = |v: i64| {
            ["x", "y", "z"].map(|name| {
                let k = name.as_bytes()[0] - b'x';
                let scale = |field: &str| data.number(&format!("/surface/places/{k}/{field}"));
                scale("from") + data.array(&format!("surface.{name}"))[v as usize] as f64 * scale("step")
            })
        };
        let is_near = |v: i64, old: u32| (0..3).all(|k| (place(v)[k] - surface.vertices[old as usize][k]).abs() < 1e-3);
        let turn = (0..3).find(|turn| (0..3).all(|k| is_near(own[k], old[(k + turn) % 3])));
        let turn = turn.unwrap_or_else(|| panic!("triangle {n}"));
        for k in 0..3 {
            let steps = data.array("surface.deviation")[own[k] as usize];
            let deviation = f64::from(surface.deviations[old[(k + turn) % 3] as usize]);
            let good = if deviation.is_nan() {
                steps == -32_768
            } else {
                (steps as f64 * step - deviation).abs() <= 0.5001 * step
            };
            assert!(good, "{steps} and {deviation}");
        }
    }
    assert_eq!(corners.len(), 240);
    // Few corners need a copy.
    assert!(
        data.array("surface.x").len() < 49 + 40,
        "{}",
        data.array("surface.x").len()
    );
}

#[test]
fn the_track_comes_back() {
    let up = [0.0, 0.0, 1.0];
    let point = |n: u32| TrackPoint {
        clock: f64::from(n) * 1.5,
        tip: [f64::from(n), -2.0 * f64::from(n), 100.0],
        axis: if n == 2 { [0.6, 0.0, 0.8] } else { up },
        number: n / 2,
        rapid: n == 3,
        begins: n == 0,
        tool: (n > 2).into(),
    };
    let mut page = Page::new("track");
    let mut scene = Scene::new(DexelLayer::new(
        Area {
            min: [0.0; 2],
            max: [1.0; 2],
            cells: [1, 1],
        },
        |_, _, _| {},
    ));
    scene.track = Some(Track {
        points: (0..5).map(point).collect(),
        lines: vec![(0, 7), (0, 9), (1, 1)],
        unit: "s".to_owned(),
    });
    let text = |name: &str, text: &str| ProgramText {
        name: name.to_owned(),
        text: text.to_owned(),
    };
    scene.programs = vec![text("a.nc", "G0 X1\nG1 <b>ü</b>"), text("b.nc", "</script>")];
    page.scene = Some(scene);
    let data = Data::of(&page.html());
    for n in 0..5_usize {
        let own = point(n as u32);
        let value = |name: &str, scale: &str| {
            data.number(&format!("/track/{scale}/from"))
                + data.array(name)[n] as f64 * data.number(&format!("/track/{scale}/step"))
        };
        assert!((value("track.clock", "clock") - own.clock).abs() < 1e-6);
        for (k, name) in ["track.x", "track.y", "track.z"].iter().enumerate() {
            assert!((value(name, &format!("tip/{k}")) - own.tip[k]).abs() < 1e-5);
        }
        let axis = unfolded(["track.u", "track.v"].map(|name| data.array(name)[n] as f64 / 32_767.0));
        assert!((0..3).all(|k| (axis[k] - own.axis[k]).abs() < 1e-4), "{axis:?}");
        assert_eq!(data.array("track.move")[n], i64::from(own.number));
        assert_eq!(
            data.array("track.flags")[n],
            i64::from(own.rapid) + 2 * i64::from(own.begins)
        );
        assert_eq!(data.array("track.tool")[n], i64::from(own.tool));
    }
    assert_eq!(data.array("moves.line"), [7, 9, 1]);
    assert_eq!(data.texts["programs"], "G0 X1\nG1 <b>ü</b>\0</script>".as_bytes());
}

/// Pseudo-random numbers (Vigna's SplitMix64), for data that does not compress.
fn noise(seed: &mut u64) -> u64 {
    *seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (*seed ^ (*seed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Noise cannot be compressed: what cannot be kept is left out, and said.
#[test]
fn noise_fits_as_well() {
    let area = Area {
        min: [0.0; 2],
        max: [100.0; 2],
        cells: [300, 300],
    };
    let mut seed = 5;
    let mut end = |low: f64| {
        let n = noise(&mut seed);
        LayerEnd {
            z: low + (n % 100_003) as f64 / 1e4,
            normal: [0.6, 0.0, if n & 1 == 0 { 0.8 } else { -0.8 }],
            deviation: (n >> 20) as f32 / 1e12,
            maker: (n >> 40) as u32,
        }
    };
    let part = DexelLayer::new(area, |_, _, line| {
        line.push([end(0.0), end(20.0)]);
        line.push([end(40.0), end(60.0)]);
    });
    let mut page = Page::new("noise");
    page.scene = Some(Scene::new(part));
    let whole = page.html();
    page.most_bytes = 1_200_000;
    let html = page.html();
    assert!(
        whole.len() > 3_000_000 && html.len() <= page.most_bytes,
        "{} {}",
        whole.len(),
        html.len()
    );
    assert!(
        html.contains("it leaves out normals of the surface; all but every "),
        "what is left out is said"
    );
    let data = Data::of(&html);
    assert!(!data.has("lower.u") && data.has("lower.maker"));
    // The lines that remain are where they were.
    let cells = data.number("/part/cells/0");
    let spacing = (data.number("/part/max/0") - data.number("/part/min/0")) / cells;
    let first = data.number("/part/min/0") + 0.5 * spacing;
    assert!((first - 100.0 / 600.0).abs() < 1e-9, "{first}");
    let nth = spacing / (100.0 / 300.0);
    assert!((nth - nth.round()).abs() < 1e-9 && nth > 1.5, "{spacing}");
}

/// With normals, deviations and moves. `cargo run -p sweepsim-report --example waves` writes the same page to a file.
#[test]
#[ignore = "takes some seconds"]
fn a_million_dexels_are_small() {
    let html = crate::waves::page(1000).html();
    assert!(html.len() < 7_000_000, "{} bytes", html.len());
    let data = Data::of(&html);
    assert!(data.has("lower.u") && data.has("upper.deviation"));
    assert_eq!(data.array("part.counts").len(), 1_000_000);
}
