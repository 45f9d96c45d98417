//! An outcome, or the error in its place, as continuous integration shows it.

use super::outcome::{Outcome, Written};
use crate::base::{JobError, sentences, words};
use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use sweepsim_formats::{
    Annotation, AnnotationLevel, CiCase, CiProgram, FormatError, Job, NotLookedAt, Report, ReportedFinding, Statement,
    StatementState,
};

/// The most annotations of a case: code hosts refuse files with too many.
const MOST: usize = 500;

/// The kinds of findings, in the order of their cases, and what a program needs so that some can be made.
const KINDS: [(&str, Option<Need>); 9] = [
    ("gouge", None),
    ("excess", None),
    ("collision", None),
    ("fixture", None),
    ("rapid", None),
    ("spindle", Some((has_spindle, "a program that starts the spindle"))),
    ("feed", Some((has_feed, "a program with feeds"))),
    (
        "machine",
        Some((has_bodies, "a machine with bodies (--machine, or `machine` in the job)")),
    ),
    (
        "limit",
        Some((has_limits, "a machine with limits (--machine, or `machine` in the job)")),
    ),
];

/// What needs no stock.
const WITHOUT_STOCK: [&str; 3] = ["fixture", "machine", "limit"];
/// What all others need.
const ON_LINES: &str = "stock on the lines of the dexels";

/// Whether a job has it, and what it is.
type Need = (fn(&Job) -> bool, &'static str);

fn has_spindle(job: &Job) -> bool {
    job.paths.iter().any(|path| !path.spindle_stopped.is_empty())
}

fn has_feed(job: &Job) -> bool {
    job.paths.iter().any(|path| !path.no_feed.is_empty())
}

fn has_bodies(job: &Job) -> bool {
    let mut machines = job.paths.iter().filter_map(|path| path.on_machine.as_ref());
    machines.any(|on| !on.bodies.is_empty())
}

fn has_limits(job: &Job) -> bool {
    job.paths.iter().any(|path| path.has_limits)
}

impl Outcome {
    /// A case for each kind of harm: with what was found, with what is open, or with what would be needed to look at
    /// it. `root`: the whole name of the folder that files are named from, where they are below it.
    #[must_use]
    pub fn ci(&self, written: &Written, root: &Path) -> CiProgram {
        let (plan, report) = (self.plan(), &written.report);
        let input = plan.request().input().name();
        let names = Names {
            folder: input.parent().unwrap_or(Path::new("")),
            program: program(plan.job(), input),
            root,
        };
        let mut all = CiProgram::new(below(input, root));
        all.seconds = plan.began.elapsed().as_secs_f64();
        let stopped = plan.request().judging.first && !self.findings().is_empty();
        for (kind, need) in KINDS {
            let is_unmet = words::unmet(report).is_some() && !WITHOUT_STOCK.contains(&kind);
            let found = found(kind, report, &names);
            let missing = report.scope.iter().flat_map(|scope| &scope.not_looked_at);
            let missing: Vec<_> = missing
                .filter(|missing| missing.kinds.iter().any(|own| own == kind))
                .collect();
            let whole = missing.iter().find(|missing| !missing.partly);
            let needs = match need {
                _ if stopped => Some("a run without --first"),
                Some((has, needs)) if !has(plan.job()) => Some(needs),
                _ if is_unmet && !is_stated(kind, report) => Some(ON_LINES),
                _ => whole.map(|missing| missing.needs.as_str()),
            };
            all.cases.push(match needs {
                Some(needs) if found.is_empty() => CiCase::skipped(kind, needs),
                _ => CiCase::looked_at(kind, found),
            });
            let rest = missing.iter().filter(|missing| missing.partly);
            let rest = rest.map(|missing: &&NotLookedAt| (format!("{kind}: {}", missing.about), &missing.needs));
            all.cases.extend(rest.map(|(name, needs)| CiCase::skipped(name, needs)));
        }
        if !written.certified {
            let message =
                "Some dexels are unresolved: what happens on these lines is not known. The report lists them.";
            let open = Annotation::new("unresolved", AnnotationLevel::Open, message, names.program());
            all.cases.push(CiCase::looked_at("unresolved", vec![open]));
        }
        if let Some(why) = words::unmet(report) {
            let message = words::capital(&why);
            let open = Annotation::new("unresolved", AnnotationLevel::Open, message, names.program());
            all.cases.push(CiCase::looked_at("unresolved", vec![open]));
        }
        all
    }
}

impl JobError {
    /// The case of a job or a program that cannot be judged. `root`: as for [`Outcome::ci`].
    #[must_use]
    pub fn ci(&self, input: &Path, root: &Path) -> CiProgram {
        let whole = |message| Annotation::new("input", AnnotationLevel::Input, message, below(input, root));
        let of_format = |error: &FormatError| {
            let file = below(error.file().unwrap_or(input), root);
            let message = error.problem().to_string();
            let mut one = Annotation::new("input", AnnotationLevel::Input, message, file);
            if let Some(position) = error.position() {
                one = one.at(Some(position.line), Some(position.excerpt.clone()));
                one.columns = Some([position.column, position.column + position.width]);
            }
            one
        };
        let annotations = match self {
            Self::Format(error) => std::iter::once(error).chain(error.further()).map(of_format).collect(),
            error => vec![whole(error.to_string())],
        };
        let mut all = CiProgram::new(below(input, root));
        all.cases
            .push(CiCase::looked_at("input", few(annotations, below(input, root))));
        all
    }
}

/// How files are named.
struct Names<'a> {
    /// The names in the report are below it.
    folder: &'a Path,
    /// What has no line is about it.
    program: PathBuf,
    root: &'a Path,
}

impl Names<'_> {
    fn program(&self) -> PathBuf {
        below(&self.program, self.root)
    }

    /// A sentence about a line that the report names, or about the program.
    fn annotation(&self, kind: &str, level: AnnotationLevel, message: String, place: Place) -> Annotation {
        match place {
            (Some(file), Some(line), text) => {
                let file = below(&self.folder.join(file), self.root);
                Annotation::new(kind, level, message, file).at(Some(line), text.cloned())
            }
            _ => Annotation::new(kind, level, message, self.program()),
        }
    }
}

/// A file, a line and its text, as the report has them.
type Place<'a> = (Option<&'a String>, Option<usize>, Option<&'a String>);

/// What was found of a kind, on the lines and between them.
fn found<'r>(kind: &str, report: &'r Report, names: &Names) -> Vec<Annotation> {
    let harm = |message, place: Place<'r>| names.annotation(kind, AnnotationLevel::Harm, message, place);
    let findings = report.findings.iter().flatten().filter(|finding| finding.kind == kind);
    let finding = |finding: &'r ReportedFinding| {
        let message = format!("{}: {}", sentences::title(finding), sentences::harm(finding, report));
        harm(message, (finding.file.as_ref(), finding.line, finding.text.as_ref()))
    };
    let mut all: Vec<Annotation> = findings.map(finding).collect();
    for statement in report
        .statements
        .iter()
        .flatten()
        .filter(|statement| kind_of(statement) == kind)
    {
        let message = words::capital(&words::proven(statement));
        match statement.state {
            StatementState::Proven => {}
            StatementState::Refuted => {
                let witness = statement.witness.as_ref();
                let place = witness.map(|own| (own.file.as_ref(), own.line, own.text.as_ref()));
                all.push(harm(message, place.unwrap_or_default()));
            }
            StatementState::Open => {
                let places = statement
                    .open
                    .iter()
                    .map(|place| (place.file.as_ref(), place.line, None));
                let mut places: BTreeSet<Place> = places.collect();
                if places.is_empty() {
                    places.insert(Place::default());
                }
                let open = |place| names.annotation(kind, AnnotationLevel::Open, message.clone(), place);
                all.extend(places.into_iter().map(open));
            }
        }
    }
    let has_harm = all.iter().any(|annotation| annotation.level == AnnotationLevel::Harm);
    // Where no move is to blame.
    let regions = report
        .regions
        .iter()
        .flatten()
        .filter(|region| region.kind == kind && !has_harm);
    all.extend(regions.map(|region| {
        let (depth, place) = (words::measure(region.depth), words::point(region.place));
        harm(
            format!("The part deviates from its target by {depth} mm at {place}"),
            Place::default(),
        )
    }));
    few(all, names.program())
}

/// The kind of the findings of a statement that does not hold.
fn kind_of(statement: &Statement) -> &str {
    match statement.about.as_str() {
        "holder" => "collision",
        about => about,
    }
}

/// Whether there is a statement about a kind of harm: lines or not, it was looked at.
fn is_stated(kind: &str, report: &Report) -> bool {
    report
        .statements
        .iter()
        .flatten()
        .any(|statement| kind_of(statement) == kind)
}

/// The first of many, and how many more there are. What does harm comes first.
fn few(mut all: Vec<Annotation>, file: PathBuf) -> Vec<Annotation> {
    all.sort_by_key(|annotation| annotation.level == AnnotationLevel::Open);
    if let Some(first) = all.get(MOST) {
        let more = words::count((all.len() - MOST) as u64);
        let message = format!("… and {more} more of this kind: the report lists them");
        let last = Annotation::new(first.rule.clone(), first.level, message, file);
        all.truncate(MOST);
        all.push(last);
    }
    all
}

/// The program of a job, if there is one file of it; or the job.
fn program(job: &Job, input: &Path) -> PathBuf {
    let mut files = job.paths.iter().map(|path| path.files.first());
    let first = files.next().flatten();
    match first.filter(|_| files.all(|file| file == first)) {
        Some(file) => file.clone(),
        None => input.to_owned(),
    }
}

/// The name of a file from a folder on, if it is below it, without `.` and `..`.
fn below(file: &Path, root: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in root.join(file).components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => drop(plain.pop()),
            part => plain.push(part),
        }
    }
    match plain.strip_prefix(root) {
        Ok(inner) => inner.to_owned(),
        Err(_) => plain,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_formats::{OpenPlace, ReportedRegion};

    #[test]
    fn files_are_named_from_the_root() {
        let named = |file: &str| below(Path::new(file), Path::new("/shop/parts")).display().to_string();
        assert_eq!(named("a.nc"), "a.nc");
        assert_eq!(named("jobs/../nc/./a.nc"), "nc/a.nc");
        assert_eq!(named("/shop/parts/nc/a.nc"), "nc/a.nc");
        assert_eq!(named("../other/a.nc"), "/shop/other/a.nc");
    }

    fn about(kind: &str, report: &Report) -> Vec<(AnnotationLevel, PathBuf, Option<usize>)> {
        let names = Names {
            folder: Path::new("nc"),
            program: "nc/main.nc".into(),
            root: Path::new("/shop"),
        };
        let all = found(kind, report, &names).into_iter();
        all.map(|one| (one.level, one.file, one.line)).collect()
    }

    /// What is open is a warning at each of its lines, once; without lines it is about the program.
    #[test]
    fn open_statements_are_at_their_lines() {
        let mut holder = Statement::new("holder", 0.001);
        for line in [Some(7), Some(5), Some(7)] {
            let mut place = OpenPlace::default();
            (place.file, place.line) = (Some("sub.nc".to_owned()), line);
            holder.open.push(place);
        }
        let mut report = Report::default();
        report.statements = Some(vec![holder, Statement::new("excess", 0.1)]);
        let open = |line| (AnnotationLevel::Open, PathBuf::from("nc/sub.nc"), Some(line));
        assert_eq!(about("collision", &report), [open(5), open(7)]);
        assert_eq!(
            about("excess", &report),
            [(AnnotationLevel::Open, "nc/main.nc".into(), None)]
        );
        assert_eq!(about("gouge", &report), []);
    }

    /// A deviation counts where neither a move nor a statement is to blame.
    #[test]
    fn no_deviation_is_lost() {
        let mut region = ReportedRegion::default();
        (region.kind, region.depth) = ("gouge".to_owned(), 0.3);
        let mut report = Report::default();
        report.regions = Some(vec![region]);
        let program = (AnnotationLevel::Harm, PathBuf::from("nc/main.nc"), None);
        assert_eq!(about("gouge", &report), [program]);
        let mut finding = ReportedFinding::default();
        (finding.kind, finding.file, finding.line) = ("gouge".to_owned(), Some("main.nc".to_owned()), Some(3));
        report.findings = Some(vec![finding]);
        assert_eq!(
            about("gouge", &report),
            [(AnnotationLevel::Harm, "nc/main.nc".into(), Some(3))]
        );
    }

    #[test]
    fn of_many_some_are_named_and_the_rest_counted() {
        let open = Annotation::new("rapid", AnnotationLevel::Open, "open", "a.nc");
        let harm = Annotation::new("rapid", AnnotationLevel::Harm, "harm", "a.nc");
        let mut all = vec![open; MOST + 1200];
        all.push(harm.clone());
        let all = few(all, "a.nc".into());
        assert_eq!((all.len(), &all[0]), (MOST + 1, &harm));
        assert!(all[MOST].message.contains("1,201 more"), "{}", all[MOST].message);
        assert_eq!(few(vec![harm.clone()], "a.nc".into()), [harm]);
    }
}
