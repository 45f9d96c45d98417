//! Pictures: the same at any number of threads, plausible, and whole.

use sweepsim_cli::picture::{Image, View, png, render};
use sweepsim_dexel::{Grid, Interval, Mesh, Source, Stock, surface};

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
            let source = Source {
                path: 0,
                segment: 0,
                t: 0.5,
            };
            groove.lower.source = source;
            groove.upper.source = source;
            dexels.subtract(index, &[groove]);
        }
    }
    surface(&dexels)
}

fn pixel(image: &Image, x: usize, y: usize) -> [u8; 3] {
    let at = 3 * (y * image.size[0] + x);
    [image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]]
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
fn a_part_fills_the_picture() {
    let empty = render(&Mesh::default(), SIZE);
    let image = render(&block(false), SIZE);
    assert_eq!(image.rgb.len(), 3 * SIZE[0] * SIZE[1]);
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
        assert_eq!(image.rgb.len(), 3 * image.size[0] * image.size[1]);
    }
}

#[test]
fn a_png_has_the_pixels() {
    let image = render(&block(true), [64, 48]);
    let bytes = png(&image).unwrap();
    let mut reader = ::png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), (64, 48));
    assert_eq!(pixels, image.rgb);
    let wrong = Image {
        size: [64, 49],
        rgb: image.rgb,
    };
    assert!(png(&wrong).is_err());
}

#[test]
fn nothing_gives_a_background() {
    let image = render(&Mesh::default(), SIZE);
    assert_eq!(image.rgb.len(), SIZE[0] * SIZE[1] * 3);
    for pixel in image.rgb.chunks_exact(3) {
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
    let view = View {
        azimuth: f64::INFINITY,
        elevation: f64::NAN,
        opening: 1e9,
        margin: -1.0,
        size: [1, 300],
        ..View::default()
    };
    assert_eq!(view.render(&mesh).rgb.len(), 900);
    // From the other side the part is still seen.
    let view = View {
        size: SIZE,
        azimuth: 120.0,
        ..View::default()
    };
    assert!(view.render(&block(true)) != render(&Mesh::default(), SIZE));
}
