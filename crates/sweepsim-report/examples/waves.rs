//! Writes a page of a million dexels, to see how large it is and how fast it opens:
//! `--example waves -- waves.html 1000`.

#[path = "../tests/it/waves.rs"]
mod waves;

fn main() -> std::io::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().unwrap_or_else(|| "waves.html".to_owned());
    let side = arguments.next().and_then(|side| side.parse().ok()).unwrap_or(1000);
    let html = waves::page(side).html();
    println!("{file}: {} bytes", html.len());
    std::fs::write(file, html)
}
