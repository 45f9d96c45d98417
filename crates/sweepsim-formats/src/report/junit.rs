//! Findings as JUnit XML, which build servers show as tests: a suite for each program, a case for each kind of harm.
//!
//! The elements and attributes are those that Jenkins and others agree on.

use super::{Annotation, AnnotationLevel, CiCase, CiProgram};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};
use std::io;

/// All cases of some programs.
///
/// # Errors
/// Those of writing to memory; none are known.
pub fn to_junit(programs: &[CiProgram]) -> io::Result<String> {
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 4);
    writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let seconds = programs.iter().map(|program| program.seconds).sum();
    let counts = Counts::of(programs.iter().flat_map(|program| &program.cases));
    let all = writer
        .create_element("testsuites")
        .with_attribute(("name", "sweepsim verify"));
    let all = all.with_attributes(
        counts
            .attributes(seconds)
            .iter()
            .map(|(name, value)| (*name, value.as_str())),
    );
    all.write_inner_content(|writer| programs.iter().try_for_each(|program| suite(writer, program)))?;
    let mut text = String::from_utf8(writer.into_inner()).map_err(io::Error::other)?;
    text.push('\n');
    Ok(text)
}

type Xml = Writer<Vec<u8>>;

fn suite(writer: &mut Xml, program: &CiProgram) -> io::Result<()> {
    let name = clean(&program.file.display().to_string());
    let counts = Counts::of(&program.cases).attributes(program.seconds);
    let suite = writer.create_element("testsuite").with_attribute(("name", &*name));
    let suite = suite.with_attributes(counts.iter().map(|(name, value)| (*name, value.as_str())));
    suite.write_inner_content(|writer| program.cases.iter().try_for_each(|own| case(writer, &name, own)))?;
    Ok(())
}

fn case(writer: &mut Xml, class: &str, case: &CiCase) -> io::Result<()> {
    let name = line(&case.name);
    let element = writer.create_element("testcase");
    let element = element.with_attributes([("classname", class), ("name", &name)]);
    let (tag, message) = match (came(case), &case.needs, &case.annotations[..]) {
        (Came::Skipped, Some(needs), _) => ("skipped", format!("not looked at: needs {needs}")),
        (Came::Failed, _, [first, ..]) => ("failure", first.message.clone()),
        (Came::Undecided, _, [first, ..]) => ("error", first.message.clone()),
        _ => return element.write_empty().map(drop),
    };
    element.write_inner_content(|writer| {
        let message = line(&message);
        let inner = writer.create_element(tag).with_attribute(("message", &*message));
        let Some(first) = case.annotations.first() else {
            return inner.write_empty().map(drop);
        };
        let all: Vec<String> = case.annotations.iter().map(sentence).collect();
        let inner = inner.with_attribute(("type", &*first.rule));
        inner
            .write_text_content(BytesText::new(&clean(&all.join("\n"))))
            .map(drop)
    })?;
    Ok(())
}

/// An annotation with its place, as compilers write it.
fn sentence(annotation: &Annotation) -> String {
    let file = annotation.file.display();
    let place = match annotation.line {
        Some(line) => format!("{file}:{line}"),
        None => file.to_string(),
    };
    let text = annotation.text.as_ref().map(|text| format!(" | {text}"));
    format!("{place}: {}{}", annotation.message, text.unwrap_or_default())
}

/// What came of a case.
#[derive(PartialEq)]
enum Came {
    Passed,
    Failed,
    Undecided,
    Skipped,
}

fn came(case: &CiCase) -> Came {
    let has = |level| case.annotations.iter().any(|annotation| annotation.level == level);
    if has(AnnotationLevel::Harm) {
        Came::Failed
    } else if !case.annotations.is_empty() {
        Came::Undecided
    } else if case.needs.is_some() {
        Came::Skipped
    } else {
        Came::Passed
    }
}

/// How many cases came to what.
struct Counts([usize; 4]);

impl Counts {
    fn of<'a>(cases: impl IntoIterator<Item = &'a CiCase>) -> Self {
        let mut counts = [0; 4];
        for case in cases {
            counts[0] += 1;
            match came(case) {
                Came::Passed => {}
                Came::Failed => counts[1] += 1,
                Came::Undecided => counts[2] += 1,
                Came::Skipped => counts[3] += 1,
            }
        }
        Self(counts)
    }

    fn attributes(&self, seconds: f64) -> [(&'static str, String); 5] {
        let [tests, failures, errors, skipped] = self.0.map(|count| count.to_string());
        [
            ("tests", tests),
            ("failures", failures),
            ("errors", errors),
            ("skipped", skipped),
            ("time", format!("{seconds:.3}")),
        ]
    }
}

/// Text without the characters that XML 1.0 does not allow (§2.2).
fn clean(text: &str) -> String {
    let allowed = |c: char| match c {
        '\t' | '\n' | '\r' => c,
        '\0'..='\x1f' | '\u{fffe}' | '\u{ffff}' => '\u{fffd}',
        c => c,
    };
    text.chars().map(allowed).collect()
}

/// The same in one line, for an attribute.
fn line(text: &str) -> String {
    clean(text).replace(['\t', '\n', '\r'], " ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use quick_xml::Reader;

    /// Elements with their attributes, and texts, in their order.
    fn parsed(text: &str) -> Vec<String> {
        let (mut reader, mut all) = (Reader::from_str(text), Vec::new());
        let mut inside = String::new();
        loop {
            match reader.read_event().unwrap() {
                Event::Start(tag) | Event::Empty(tag) => {
                    let attribute = |found: Result<quick_xml::events::attributes::Attribute, _>| {
                        let found = found.unwrap();
                        let value = quick_xml::escape::unescape(&found.value).unwrap();
                        format!(" {}={value}", found.key.as_ref())
                    };
                    let name = tag.name().as_ref().to_owned();
                    all.push(name + &tag.attributes().map(attribute).collect::<String>());
                }
                Event::Text(found) => inside += &found,
                Event::GeneralRef(found) => inside += &format!("&{};", &*found),
                Event::End(_) => {
                    let found = std::mem::take(&mut inside);
                    if !found.trim().is_empty() {
                        all.push(quick_xml::escape::unescape(found.trim()).unwrap().into_owned());
                    }
                }
                Event::Eof => return all,
                _ => {}
            }
        }
    }

    #[test]
    fn cases_are_counted_and_told_apart() {
        let mut program = CiProgram::new("a&b.nc");
        program.seconds = 1.25;
        let harm = Annotation::new("gouge", AnnotationLevel::Harm, "deeper than \"0.1\" < 0.2", "a&b.nc");
        let harm = harm.at(Some(8), Some("G1 <X>\u{1b}".into()));
        let open = Annotation::new("rapid", AnnotationLevel::Open, "open\nwhether", "a&b.nc");
        program.cases = vec![
            CiCase::looked_at("gouge", vec![harm.clone(), open.clone()]),
            CiCase::looked_at("rapid", vec![open]),
            CiCase::skipped("fixture", "`fixtures` in the job"),
            CiCase::looked_at("excess", Vec::new()),
        ];
        let text = to_junit(&[program, CiProgram::new("b.nc")]).unwrap();
        let expected = [
            "testsuites name=sweepsim verify tests=4 failures=1 errors=1 skipped=1 time=1.250",
            "testsuite name=a&b.nc tests=4 failures=1 errors=1 skipped=1 time=1.250",
            "testcase classname=a&b.nc name=gouge",
            "failure message=deeper than \"0.1\" < 0.2 type=gouge",
            "a&b.nc:8: deeper than \"0.1\" < 0.2 | G1 <X>\u{fffd}\na&b.nc: open\nwhether",
            "testcase classname=a&b.nc name=rapid",
            "error message=open whether type=rapid",
            "a&b.nc: open\nwhether",
            "testcase classname=a&b.nc name=fixture",
            "skipped message=not looked at: needs `fixtures` in the job",
            "testcase classname=a&b.nc name=excess",
            "testsuite name=b.nc tests=0 failures=0 errors=0 skipped=0 time=0.000",
        ];
        assert_eq!(parsed(&text), expected, "{text}");
    }
}
