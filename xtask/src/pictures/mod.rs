//! `cargo xtask pictures`: draws the pictures of the docs anew.

mod envelope;
mod figures;
mod machines;
mod runs;

use crate::workspace;
use std::path::PathBuf;
use sweepsim_picture::Image;

/// Draws the pictures whose names contain `filter`, or all.
pub fn draw(filter: Option<&str>) -> Result<(), String> {
    let wanted = |name: &str| filter.is_none_or(|part| name.contains(part));
    let mut drawn = 0;
    for (name, make) in figures::FIGURES {
        if wanted(name) {
            store(name, &make()?)?;
            drawn += 1;
        }
    }
    let mut built = false;
    for run in runs::RUNS {
        if wanted(run.name) {
            if !built {
                runs::build()?;
                built = true;
            }
            store(run.name, &run.image()?)?;
            drawn += 1;
        }
    }
    if wanted(machines::NAME) {
        if !built {
            runs::build()?;
        }
        store(machines::NAME, &machines::image()?)?;
        drawn += 1;
    }
    match (drawn, filter) {
        (0, Some(part)) => Err(format!("no picture's name contains {part:?}")),
        _ => Ok(()),
    }
}

fn folder() -> PathBuf {
    workspace::root().join("docs/pictures")
}

fn store(name: &str, image: &Image) -> Result<(), String> {
    let file = folder().join(format!("{name}.png"));
    let about = |error: std::io::Error| format!("{}: {error}", file.display());
    let png = image.png().map_err(about)?;
    println!("{name}.png: {} kB", png.len() / 1000);
    std::fs::write(&file, png).map_err(about)
}

/// Images of one size, in rows of `columns`.
fn sheet(images: &[Image], columns: usize) -> Result<Image, String> {
    let [width, height] = images.first().ok_or("a sheet of nothing")?.size();
    let rows = images.len().div_ceil(columns);
    let size = [columns * width, rows * height];
    let mut rgb = vec![255; 3 * size[0] * size[1]];
    for (number, image) in images.iter().enumerate() {
        if image.size() != [width, height] {
            return Err("the images of a sheet differ in size".to_owned());
        }
        let (left, top) = (number % columns * width, number / columns * height);
        for (row, pixels) in image.rgb().chunks(3 * width).enumerate() {
            let start = 3 * ((top + row) * size[0] + left);
            rgb[start..start + 3 * width].copy_from_slice(pixels);
        }
    }
    Image::new(size, rgb).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sheet_has_the_images_in_rows() {
        let image = |shade: u8| Image::new([2, 1], vec![shade; 6]).unwrap();
        let sheet = sheet(&[image(1), image(2), image(3)], 2).unwrap();
        assert_eq!(sheet.size(), [4, 2]);
        let at = |column, row| sheet.pixel(column, row).unwrap()[0];
        assert_eq!([at(0, 0), at(3, 0), at(1, 1), at(2, 1)], [1, 2, 3, 255]);
    }
}
