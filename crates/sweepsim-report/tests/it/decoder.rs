//! Reads the embedded data of a page as `docs/report.md` describes it.

use serde_json::Value;
use std::collections::BTreeMap;

/// The embedded data of a page.
pub struct Data {
    pub head: Value,
    arrays: BTreeMap<String, Vec<i64>>,
    /// Arrays of bytes as they are.
    pub texts: BTreeMap<String, Vec<u8>>,
}

/// The content of the script element with an id.
fn element<'a>(html: &'a str, id: &str) -> &'a str {
    let mark = format!("id=\"{id}\">");
    let start = html.find(&mark).expect("the element is there") + mark.len();
    &html[start..start + html[start..].find("</script>").expect("it ends")]
}

fn base64(text: &str) -> Vec<u8> {
    let value = |c: u8| match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        _ => panic!("{c} is no digit of base64"),
    };
    let (mut bits, mut count, mut bytes) = (0_u32, 0, Vec::new());
    for c in text.bytes().filter(|c| *c != b'=') {
        bits = bits << 6 | u32::from(value(c));
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
            bits &= (1 << count) - 1;
        }
    }
    bytes
}

impl Data {
    pub fn of(html: &str) -> Self {
        let head: Value = serde_json::from_str(element(html, "head")).expect("JSON");
        let bytes = base64(element(html, "arrays"));
        let (mut arrays, mut texts, mut at) = (BTreeMap::new(), BTreeMap::new(), 0);
        for entry in head["arrays"].as_array().expect("a list") {
            let field = |name: &str| entry[name].as_u64().expect("a number") as usize;
            let name = entry["name"].as_str().expect("a name").to_owned();
            let packed = &bytes[at..at + field("bytes")];
            at += field("bytes");
            let plain = miniz_oxide::inflate::decompress_to_vec_zlib(packed).expect("zlib");
            let (width, signed) = match entry["kind"].as_str() {
                Some("U8") => {
                    assert_eq!(plain.len(), field("count"));
                    texts.insert(name, plain);
                    continue;
                }
                Some("I8") => (1, true),
                Some("U16") => (2, false),
                Some("I16") => (2, true),
                Some("U32") => (4, false),
                other => panic!("kind {other:?}"),
            };
            let count = field("count");
            assert_eq!(plain.len(), width * count);
            let range = 1_i64 << (8 * width);
            let mut before = 0;
            let numbers = (0..count).map(|k| {
                let step: i64 = (0..width).map(|p| i64::from(plain[p * count + k]) << (8 * p)).sum();
                before = (before + step).rem_euclid(range);
                if signed && before >= range / 2 {
                    before - range
                } else {
                    before
                }
            });
            arrays.insert(name, numbers.collect());
        }
        assert_eq!(at, bytes.len(), "no bytes are left over");
        Self { head, arrays, texts }
    }

    pub fn array(&self, name: &str) -> &[i64] {
        self.arrays.get(name).unwrap_or_else(|| panic!("no array {name}"))
    }

    pub fn has(&self, name: &str) -> bool {
        self.arrays.contains_key(name)
    }

    /// A number of the head, by its path.
    pub fn number(&self, path: &str) -> f64 {
        self.head
            .pointer(path)
            .and_then(Value::as_f64)
            .unwrap_or_else(|| panic!("no number {path}"))
    }

    /// Intervals of each line of a layer, as heights.
    pub fn lines(&self, names: [&str; 3]) -> Vec<Vec<[f64; 2]>> {
        let height = |steps: i64| self.number("/height/from") + steps as f64 * self.number("/height/step");
        let [counts, lower, upper] = names.map(|name| self.array(name));
        assert_eq!(
            (lower.len(), lower.len()),
            (upper.len(), counts.iter().sum::<i64>() as usize)
        );
        let mut k = 0..lower.len();
        let line = |count: &i64| {
            let own = k.by_ref().take(*count as usize);
            own.map(|k| [height(lower[k]), height(upper[k])]).collect()
        };
        counts.iter().map(line).collect()
    }
}
