//! Pictures are deterministic, plausible, and complete.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use sweepsim_dexel::{Grid, Interval, Mesh, Source, Stock};
use sweepsim_picture::{Axis, CuttingPlane, Drawing, Image, View, legend, render};

const SIZE: [usize; 2] = [160, 120];

/// A block with a groove that a tool has cut, if `cut`.
fn block(cut: bool) -> Mesh {
    let grid = Grid::new([0.0, 0.0], [40.0, 30.0], [40, 30]).unwrap();
    let stock = Stock::Block {
        min: [0.0; 3],
        max: [40.0, 30.0, 12.0],
    };
    let mut dexels = stock.dexels(&grid).unwrap();
    if cut {
        for index in 0..grid.len() {
            let mut groove = Interval::between(5.0, 20.0);
            let source = Source::Cut {
                path: 0,
                segment: 0,
                t: 0.5,
            };
            groove.lower.source = source;
            groove.upper.source = source;
            dexels.subtract(index, &[groove]).unwrap();
        }
    }
    dexels.surface().unwrap()
}

fn pixel(image: &Image, x: usize, y: usize) -> [u8; 3] {
    image.pixel(x, y).unwrap()
}

fn view_with(change: impl FnOnce(&mut View)) -> View {
    let mut view = View::default();
    change(&mut view);
    view
}

#[test]
fn the_bytes_do_not_depend_on_the_threads() {
    let mesh = block(true);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| render(&mesh, SIZE))
    };
    assert!(on(1) == on(3));
}

#[test]
fn a_picture_ends_when_it_is_no_longer_wanted() {
    let mesh = block(true);
    let view = view_with(|view| view.size = SIZE);
    let shares = Mutex::new(Vec::new());
    let whole = view.draw_while(&Drawing::new(&mesh), &|share| {
        shares.lock().unwrap().push(share);
        ControlFlow::Continue(())
    });
    assert!(whole == Some(view.render(&mesh)));
    let mut shares = shares.into_inner().unwrap();
    shares.sort_by(f64::total_cmp);
    let steps = shares.len();
    assert!(steps > 50, "{steps}");
    // Every share once: the number of steps is what was announced.
    for (k, share) in shares.iter().enumerate() {
        assert!((share - k as f64 / steps as f64).abs() < 1e-12, "{share}");
    }
    // Given up at any step, hardly any other is begun.
    for limit in [0, 1, 20, steps - 1] {
        let asked = AtomicUsize::new(0);
        let none = view.draw_while(&Drawing::new(&mesh), &|_| {
            if asked.fetch_add(1, Ordering::Relaxed) < limit {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        });
        assert!(none.is_none());
        let more = asked.into_inner() - limit;
        assert!(more <= rayon::current_num_threads().max(1), "{limit}: {more}");
    }
}

#[test]
fn a_part_fills_the_picture() {
    let empty = render(&Mesh::default(), SIZE);
    let image = render(&block(false), SIZE);
    assert_eq!(image.rgb().len(), 3 * SIZE[0] * SIZE[1]);
    let differs = |x: usize, y: usize| {
        let (a, b) = (pixel(&image, x, y), pixel(&empty, x, y));
        (0..3).map(|k| a[k].abs_diff(b[k])).max() > Some(40)
    };
    let places = || (0..SIZE[0]).flat_map(|x| (0..SIZE[1]).map(move |y| (x, y)));
    let covered = places().filter(|(x, y)| differs(*x, *y)).count();
    let part = covered as f64 / (SIZE[0] * SIZE[1]) as f64;
    assert!((0.25..0.8).contains(&part), "{part}");
    // Nine tenths of the height or of the width.
    let reach = |of: &dyn Fn((usize, usize)) -> usize| {
        let seen = || places().filter(|(x, y)| differs(*x, *y)).map(of);
        seen().max().unwrap() - seen().min().unwrap()
    };
    let (wide, high) = (
        reach(&|p| p.0) as f64 / SIZE[0] as f64,
        reach(&|p| p.1) as f64 / SIZE[1] as f64,
    );
    assert!(
        wide < 0.95 && high < 0.95 && (wide > 0.85 || high > 0.85),
        "{wide} {high}"
    );
}

#[test]
fn what_is_cut_is_warm_and_stock_is_cool() {
    let middle = |mesh: &Mesh| pixel(&render(mesh, SIZE), SIZE[0] / 2, SIZE[1] / 2);
    let ([red, _, blue], [stock_red, _, stock_blue]) = (middle(&block(true)), middle(&block(false)));
    assert!(red > blue, "{red} {blue}");
    assert!(stock_blue > stock_red, "{stock_red} {stock_blue}");
}

#[test]
fn odd_meshes_and_sizes_are_drawn() {
    let bad = Mesh {
        vertices: vec![
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [f64::NAN; 3],
            [0.0, 1.0, 0.0],
            [1e300, 0.0, 0.0],
        ],
        normals: vec![],
        cut: vec![],
        triangles: vec![[0, 1, 2], [0, 1, 9], [0, 0, 0], [0, 1, 3], [0, 3, 4]],
    };
    for size in [[1, 1], [0, 7], [3, 200]] {
        let image = render(&bad, size);
        assert_eq!(image.rgb().len(), 3 * image.size()[0] * image.size()[1]);
    }
}

#[test]
fn a_png_has_the_pixels() {
    let image = render(&block(true), [64, 48]);
    let bytes = image.png().unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), (64, 48));
    assert_eq!(pixels, image.rgb());
    let rgb = image.rgb().to_vec();
    assert!(Image::new([64, 49], rgb.clone()).is_err());
    assert!(Image::new([0, 0], Vec::new()).is_err());
    assert_eq!(Image::new([64, 48], rgb), Ok(image));
}

/// A closed box: outside 40 × 30 × 12, with a cavity that is seen by a section only.
fn hollow() -> Mesh {
    let grid = Grid::new([0.0, 0.0], [40.0, 30.0], [40, 30]).unwrap();
    let block = |min: [f64; 3], max: [f64; 3]| Stock::Block { min, max };
    let solid = Stock::Difference(
        block([0.0; 3], [40.0, 30.0, 12.0]).into(),
        vec![block([10.0, 10.0, 4.0], [30.0, 20.0, 8.0])],
    );
    solid.dexels(&grid).unwrap().surface().unwrap()
}

#[test]
fn sections_lay_open_the_inside() {
    let mesh = hollow();
    let view = view_with(|view: &mut View| {
        view.size = SIZE;
        view.azimuth = -90.0;
        view.elevation = 90.0;
        view.orthographic = true;
    });
    let sections = [CuttingPlane { axis: Axis::Z, at: 6.0 }];
    let open = view.draw(&Drawing::new(&mesh).sections(&sections));
    let closed = view.render(&mesh);
    let at = |image: &Image, x: f64, y: f64| {
        // The box fills the free part of the picture's width or height: 40 mm are 4/3 of 30.
        let scale = 0.86 * 120.0 / 30.0;
        let place = [80.0 + (x - 20.0) * scale, 60.0 - (y - 15.0) * scale];
        pixel(image, place[0] as usize, place[1] as usize)
    };
    let warm = |[red, _, blue]: [u8; 3]| red > blue;
    // The lid is steel, the plane of the section is clay, the cavity's floor is steel.
    for (x, y, inside) in [
        (3.0, 3.0, true),
        (37.0, 27.0, true),
        (20.0, 25.0, true),
        (20.0, 15.0, false),
        (13.0, 12.0, false),
    ] {
        assert!(!warm(at(&closed, x, y)), "{x} {y} {:?}", at(&closed, x, y));
        assert_eq!(warm(at(&open, x, y)), inside, "{x} {y} {:?}", at(&open, x, y));
    }
    // Below the cavity, and where there is nothing.
    let cut = |at: f64| {
        let sections = [
            CuttingPlane { axis: Axis::Z, at },
            CuttingPlane {
                axis: Axis::X,
                at: f64::NAN,
            },
        ];
        view.draw(&Drawing::new(&mesh).sections(&sections))
    };
    assert!(warm(at(&cut(2.0), 20.0, 15.0)));
    assert!(cut(-1.0) == view.render(&Mesh::default()));
    // From below it is the other half that is left.
    let mut below = view;
    below.elevation = -90.0;
    let open = below.draw(&Drawing::new(&mesh).sections(&[CuttingPlane { axis: Axis::Z, at: 2.0 }]));
    assert!(warm(at(&open, 20.0, 15.0)));
}

#[test]
fn parallel_lines_stay_parallel() {
    let mesh = hollow();
    // How wide the box is in each row of the picture, seen from the front and above: it is bluer than all around it.
    let widths = |orthographic: bool| -> Vec<usize> {
        let view = view_with(|view: &mut View| {
            view.size = [400, 300];
            view.azimuth = -90.0;
            view.elevation = 30.0;
            view.field_of_view = 60.0;
            view.orthographic = orthographic;
            view.axes = false;
        });
        let image = view.render(&mesh);
        let steel = |x: usize, y: usize| {
            let [red, _, blue] = pixel(&image, x, y);
            blue > red.saturating_add(22)
        };
        let rows = (0..300).map(|y| (0..400).filter(|x| steel(*x, y)).count());
        rows.filter(|width| *width > 100).collect()
    };
    let spread = |widths: &[usize]| widths.iter().max().unwrap() - widths.iter().min().unwrap();
    let (level, lens) = (widths(true), widths(false));
    assert!(level.len() > 100 && lens.len() > 100, "{} {}", level.len(), lens.len());
    // The first and the last row are covered in part.
    let inner = &level[2..level.len() - 2];
    assert!(spread(inner) <= 2 && spread(&lens) > 40, "{level:?} {lens:?}");
}

#[test]
fn values_have_the_colours_of_the_scale() {
    let mesh = hollow();
    let picture = |value: f32, range: f32| {
        let view = view_with(|view: &mut View| {
            view.size = SIZE;
            view.legend = legend::WIDTH;
        });
        let values = vec![value; mesh.vertices.len()];
        let mut image = view.draw(&Drawing::new(&mesh).values(&values, range));
        let plain = image.clone();
        legend::draw(&mut image, range);
        // The scale is beside the part.
        let changed = (0..SIZE[0] * SIZE[1]).filter(|k| image.rgb()[3 * k..3 * k + 3] != plain.rgb()[3 * k..3 * k + 3]);
        assert!(changed.map(|k| k % SIZE[0]).min() > Some(SIZE[0] * 3 / 4));
        pixel(&image, SIZE[0] * 43 / 100, SIZE[1] / 2)
    };
    let [high, low, middle, none] = [0.05, -0.05, 0.0, f32::NAN].map(|value| picture(value, 0.05));
    assert!(high[0] > high[2] + 60, "{high:?}");
    assert!(low[2] > low[0] + 60, "{low:?}");
    assert!(middle.iter().all(|c| *c > 150), "{middle:?}");
    assert!(none.iter().all(|c| *c < 130), "{none:?}");
    assert_eq!(picture(9.0, 0.05), high);
}

#[test]
fn nothing_gives_a_background() {
    let image = render(&Mesh::default(), SIZE);
    assert_eq!(image.rgb().len(), SIZE[0] * SIZE[1] * 3);
    for pixel in image.rgb().chunks_exact(3) {
        assert!(pixel.iter().all(|c| *c > 150), "{pixel:?}");
        assert!(
            pixel.iter().max().unwrap() - pixel.iter().min().unwrap() < 30,
            "{pixel:?}"
        );
    }
    // Brighter at the top.
    let middle = SIZE[0] / 2;
    assert!(pixel(&image, middle, 0)[1] > pixel(&image, middle, SIZE[1] - 1)[1]);
}

#[test]
fn odd_views_do_no_harm() {
    let mut mesh = block(true);
    mesh.normals[20] = [f32::NAN; 3];
    let view = view_with(|view: &mut View| {
        view.azimuth = f64::INFINITY;
        view.elevation = f64::NAN;
        view.field_of_view = 1e9;
        view.margin = -1.0;
        view.size = [1, 300];
    });
    assert_eq!(view.render(&mesh).rgb().len(), 900);
    // From the other side the part is still seen.
    let view = view_with(|view: &mut View| {
        view.size = SIZE;
        view.azimuth = 120.0;
    });
    assert!(view.render(&block(true)) != render(&Mesh::default(), SIZE));
}

#[test]
fn axes_and_scale_stand_in_the_corner() {
    let mesh = block(true);
    let with = |axes: bool, orthographic: bool| {
        view_with(|view| (view.size, view.axes, view.orthographic) = ([480, 360], axes, orthographic)).render(&mesh)
    };
    for orthographic in [false, true] {
        let (drawn, plain) = (with(true, orthographic), with(false, orthographic));
        let places = (0..480).flat_map(|x| (0..360).map(move |y| (x, y)));
        let marked: Vec<_> = places
            .filter(|(x, y)| pixel(&drawn, *x, *y) != pixel(&plain, *x, *y))
            .collect();
        assert!(marked.len() > 200, "{}", marked.len());
        assert!(marked.iter().all(|(x, y)| *x < 200 && *y > 280));
    }
    // From the front in parallel projection the scale is as long as it says.
    let front = |axes: bool| {
        view_with(|view| {
            (view.size, view.axes, view.orthographic) = ([480, 360], axes, true);
            (view.azimuth, view.elevation) = (-90.0, 0.0);
        })
    };
    let [drawn, plain, empty] = [
        front(true).render(&mesh),
        front(false).render(&mesh),
        front(false).render(&Mesh::default()),
    ];
    let differ = |a: &Image, b: &Image, x: usize, y: usize, by: u8| {
        let (a, b) = (pixel(a, x, y), pixel(b, x, y));
        (0..3).any(|k| a[k].abs_diff(b[k]) > by)
    };
    let marked = |y: usize| (0..480).filter(|x| differ(&drawn, &plain, *x, y, 20)).count();
    let scale = (335..352).map(marked).max().unwrap() as f64;
    let covered = (0..480).filter(|x| (0..330).any(|y| differ(&plain, &empty, *x, y, 60)));
    let part = covered.count() as f64;
    // 5 mm of the block's 40.
    assert!((scale / part * 40.0 - 5.0).abs() < 0.3, "{scale} {part}");
}
