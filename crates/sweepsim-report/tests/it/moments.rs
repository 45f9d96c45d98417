//! The surface of the workpiece during the program, as embedded.

use crate::decoder::Data;
use sweepsim_props::*;
use sweepsim_report::{Area, DexelLayer, LayerEnd, Page, Scene, Surface, SurfaceCourse};

const MOMENTS: u16 = 9;

fn page(course: SurfaceCourse) -> Page {
    let area = Area {
        min: [0.0; 2],
        max: [4.0, 3.0],
        cells: [4, 3],
    };
    let block = |_, _, line: &mut Vec<[LayerEnd; 2]>| {
        line.push([0.0, 2.0].map(|z| LayerEnd {
            deviation: 3.0,
            ..LayerEnd::at(z, [0.0, 0.0, 1.0])
        }));
    };
    let mut scene = Scene::new(DexelLayer::new(area, block));
    scene.surface_course = Some(course);
    let mut page = Page::new("moments");
    page.scene = Some(scene);
    page
}

/// A strip of triangles, the number of each is that of its first corner, with these spans.
fn strip(spans: &[(u16, u16)]) -> SurfaceCourse {
    let count = spans.len() as u32;
    let place = |n: u32| [f64::from(n), f64::from(n * n % 7), f64::from(n % 3)];
    SurfaceCourse {
        clocks: (1..=MOMENTS).map(|n| 2.0 * f64::from(n)).collect(),
        surface: Surface {
            vertices: (0..count + 2).map(place).collect(),
            normals: vec![[0.0, 0.6, 0.8]; spans.len() + 2],
            deviations: (0..count + 2).map(|n| 0.01 * n as f32).collect(),
            makers: (0..count).map(|n| n % 5).collect(),
            triangles: (0..count).map(|n| [n, n + 1, n + 2]).collect(),
            ..Surface::default()
        },
        spans: spans.iter().map(|(from, long)| [*from, from + long]).collect(),
    }
}

/// By the clock of each moment, and the start: the first corners of the triangles there, with their makers.
fn found(data: &Data) -> Vec<(f64, Vec<(i64, i64)>)> {
    let clocks = data.head["surface_course"]["clocks"].as_array().unwrap();
    let clocks = [0.0]
        .into_iter()
        .chain(clocks.iter().map(|clock| clock.as_f64().unwrap()));
    let [from, to] = ["course.from", "course.to"].map(|name| data.array(name));
    let scale = |field: &str| data.number(&format!("/surface_course/places/0/{field}"));
    let x = |corner: i64| scale("from") + data.array("course.x")[corner as usize] as f64 * scale("step");
    let all = || data.array("course.corners").as_chunks::<3>().0.iter().enumerate();
    let at = |(moment, clock): (usize, f64)| {
        let is_there = |(n, _): &(usize, &[i64; 3])| (from[*n]..to[*n]).contains(&(moment as i64));
        let told = |(_, corners): (usize, &[i64; 3])| {
            let first = corners.iter().map(|corner| x(*corner).round() as i64).min().unwrap();
            let maker = data.array("course.maker")[corners[2] as usize];
            let deviation = data.array("course.deviation")[corners[0] as usize] as f64 * data.number("/deviation");
            assert!((deviation - 0.01 * x(corners[0])).abs() < 1e-3);
            (first, maker)
        };
        let mut told: Vec<_> = all().filter(is_there).map(told).collect();
        told.sort_unstable();
        (clock, told)
    };
    clocks.enumerate().map(at).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// The triangles at each moment come back, however many moments had to be left out; the last is always there.
    #[test]
    fn the_surface_of_each_moment_comes_back(spans in collection::vec((0..MOMENTS, 1..MOMENTS), 30..200), few in any::<bool>()) {
        let spans: Vec<(u16, u16)> = spans.into_iter().map(|(from, long)| (from, long.min(MOMENTS + 1 - from))).collect();
        let mut page = page(strip(&spans));
        let whole = Data::of(&page.html());
        let size = |data: &Data| data.head["arrays"].as_array().unwrap().iter().map(|own| own["bytes"].as_u64().unwrap()).sum::<u64>() as usize;
        // Less and less, until something does not fit.
        page.most_bytes = page.html().len() + 200_000;
        while few && !page.html().contains("it leaves out") {
            page.most_bytes -= size(&whole) / 10;
        }
        let html = page.html();
        let data = Data::of(&html);
        if data.head["surface_course"].is_null() {
            prop_assert!(few);
            prop_assert!(html.contains("it leaves out the workpiece during the program"));
            return Ok(());
        }
        let all = found(&data);
        prop_assert_eq!(few, html.contains(&format!("all but {} of 9 moments", all.len() - 1)));
        prop_assert_eq!(few, all.len() < 10);
        prop_assert_eq!(all.last().map(|(clock, _)| *clock), Some(18.0));
        for (clock, triangles) in all {
            let moment = (clock / 2.0).round() as u16;
            let is_there = |(_, (from, long)): &(usize, &(u16, u16))| (*from..from + long).contains(&moment);
            let wanted: Vec<(i64, i64)> = spans.iter().enumerate().filter(is_there).map(|(n, _)| (n as i64, n as i64 % 5)).collect();
            prop_assert_eq!(triangles, wanted, "at {}", moment);
        }
    }
}
