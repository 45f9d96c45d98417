//! Numbers and findings for people.

pub use super::numbers::{bytes, clock, count, counted, direction, length, measure, point, seconds};
use sweepsim_formats::{Measure, Report, ReportedFinding, Scope, Statement, StatementState, Verdict};

/// How many of each kind were found, in words.
#[must_use]
pub fn found(findings: &[ReportedFinding]) -> Vec<String> {
    let mut counts: Vec<(&str, u64)> = Vec::new();
    let touching = findings.iter().filter(|finding| !finding.near);
    for finding in touching {
        match counts.iter_mut().find(|(kind, _)| *kind == finding.kind) {
            Some((_, count)) => *count += 1,
            None => counts.push((&finding.kind, 1)),
        }
    }
    let near = findings.iter().filter(|finding| finding.near).count() as u64;
    let near = (near > 0).then(|| format!("{} nearer than it should be", counted(near, "move")));
    counts
        .iter()
        .map(|(kind, count)| match *kind {
            "collision" => counted(*count, "collision"),
            "rapid" => format!("{} through material", counted(*count, "rapid move")),
            "fixture" => format!("{} into a fixture", counted(*count, "move")),
            "gouge" => counted(*count, "gouging move"),
            "excess" => format!("{} with material left", counted(*count, "place")),
            "spindle" => format!("{} with the spindle stopped", counted(*count, "cut")),
            "machine" => counted(*count, "machine collision"),
            "limit" => format!("{} beyond the machine's limits", counted(*count, "move")),
            "feed" => format!("{} without a feed", counted(*count, "cut")),
            kind => counted(*count, kind),
        })
        .chain(near)
        .collect()
}

/// The name of a set-up, if there are set-ups.
#[must_use]
pub fn setup_name(report: &Report, number: Option<usize>) -> Option<&str> {
    let setups = report.setups.as_deref()?;
    Some(&setups.get(number?)?.name)
}

/// Whether there is a statement about each kind of harm that was looked for.
#[must_use]
pub fn is_everywhere(report: &Report) -> bool {
    report.scope.as_ref().is_some_and(|scope| scope.extent == "everywhere")
}

/// What was looked at between the lines.
#[must_use]
pub fn between(report: &Report) -> String {
    match report.statements.as_deref() {
        None | Some([]) => "nothing between them".to_owned(),
        Some(statements) if is_everywhere(report) => format!("between them, {}", abouts(statements)),
        Some(statements) => format!("between them, only {}", abouts(statements)),
    }
}

/// The verdict in one line, if a program was judged.
#[must_use]
pub fn answer(report: &Report) -> Option<String> {
    let findings = report.findings.as_deref().unwrap_or_default();
    let verdict = report.verdict?;
    if let (Verdict::Undecided, Some(why)) = (verdict, unmet(report)) {
        return Some(format!("UNDECIDED: {why}"));
    }
    Some(match verdict {
        Verdict::Undecided => {
            let open = report.statements.iter().flatten();
            let open = open.filter(|statement| statement.state == StatementState::Open);
            let places = open.map(|statement| statement.open_count.max(1) as u64).sum();
            let places = counted(places, "place");
            format!("UNDECIDED at {places}: nothing was found on the dexels' lines that does harm")
        }
        Verdict::Pass => passed(report),
        Verdict::Fail if findings.is_empty() => "FAIL: the part deviates from its target".to_owned(),
        Verdict::Fail => format!("FAIL: {}", found(findings).join(", ")),
    })
}

/// The verdict of a program of which nothing was found that does harm, and all that was stated is proven.
#[must_use]
pub fn passed(report: &Report) -> String {
    let nothing = "nothing was found on them that does harm";
    match report.statements.as_deref() {
        None | Some([]) => format!("PASS on the dexels' lines only: {nothing}"),
        Some(all) if is_everywhere(report) => format!("PASS, proven everywhere: {}", abouts(all)),
        Some(all) => {
            let about = abouts(all);
            format!("PASS on the dexels' lines only ({about}: proven everywhere): {nothing}")
        }
    }
}

/// Why nothing was judged, if there was no material.
#[must_use]
pub fn unmet(report: &Report) -> Option<String> {
    let why = report.scope.as_ref()?.unmet.as_ref()?;
    Some(format!("nothing was looked at, since {why}"))
}

/// Text that begins with a capital letter.
#[must_use]
pub fn capital(text: &str) -> String {
    let mut rest = text.chars();
    let first = rest.next().into_iter().flat_map(char::to_uppercase);
    first.chain(rest).collect()
}

/// What a statement is about.
#[must_use]
pub fn about(statement: &Statement) -> &str {
    match statement.about.as_str() {
        "gouge" => "gouges",
        "fixture" => "fixtures",
        "holder" => "shanks and holders beside the target",
        "collision" => "shanks and holders beside the stock",
        "rapid" => "rapids",
        "machine" => "the machine's bodies",
        about => about,
    }
}

/// The word for the place where a statement's extreme is: `deepest`.
#[must_use]
pub fn extreme(measure: Measure) -> &'static str {
    match measure {
        Measure::Distance => "nearest",
        Measure::Height => "highest",
        _ => "deepest",
    }
}

/// What statements are about: `gouges, excess and fixtures`.
#[must_use]
pub fn abouts(statements: &[Statement]) -> String {
    let mut names: Vec<&str> = Vec::new();
    for statement in statements {
        let name = about(statement);
        if !names.contains(&name) {
            names.push(name);
        }
    }
    match names.split_last() {
        Some((last, [])) => (*last).to_owned(),
        Some((last, first)) => format!("{} and {last}", first.join(", ")),
        None => String::new(),
    }
}

/// A statement in one sentence.
#[must_use]
pub fn proven(statement: &Statement) -> String {
    let [least, most] = statement.enclosure;
    let limit = format!("{} mm", measure(statement.limit));
    // What is claimed, and what is the case if it does not hold.
    let (claim, broken) = match (statement.about.as_str(), statement.measure) {
        ("excess", _) => (
            format!("nothing that hangs together with the target stands higher above it than {limit}"),
            format!("material stands higher above the target than {limit}"),
        ),
        ("fixture", Measure::Distance) => (
            format!("no shank or holder comes nearer to a fixture than {limit}"),
            format!("a shank or holder comes nearer to a fixture than {limit}"),
        ),
        ("fixture", _) => (
            format!("nothing goes deeper into a fixture than {limit}"),
            format!("a tool goes deeper into a fixture than {limit}"),
        ),
        ("holder", Measure::Distance) => (
            format!("no shank or holder comes nearer to the target than {limit}"),
            format!("a shank or holder comes nearer to the target than {limit}"),
        ),
        ("holder", _) => (
            format!("no shank or holder goes deeper into the target than {limit}"),
            format!("a shank or holder goes deeper into the target than {limit}"),
        ),
        ("collision", Measure::Distance) => (
            format!("no shank or holder comes nearer to the stock, as it is at that time, than {limit}"),
            format!("a shank or holder comes nearer to the stock, as it is at that time, than {limit}"),
        ),
        ("collision", _) => (
            format!("no shank or holder goes deeper into the stock, as it is at that time, than {limit}"),
            format!("a shank or holder goes deeper into the stock, as it is at that time, than {limit}"),
        ),
        ("machine", _) if statement.limit > 0.0 => (
            format!("no bodies of the machine come nearer to each other, to the tool or to the raw stock than {limit}"),
            format!("bodies of the machine come nearer to each other, to the tool or to the raw stock than {limit}"),
        ),
        ("machine", _) => (
            "no bodies of the machine touch each other, the tool or the raw stock".to_owned(),
            "bodies of the machine touch each other, the tool or the raw stock".to_owned(),
        ),
        ("rapid", _) => (
            format!("no rapid goes deeper into the stock, as it is at that time, than {limit}"),
            format!("a rapid goes deeper into the stock, as it is at that time, than {limit}"),
        ),
        _ => (
            format!("no cutter goes deeper into the target than {limit}"),
            format!("a cutter goes deeper into the target than {limit}"),
        ),
    };
    let bounds = [
        (least > 0.0).then(|| format!("at least {} mm", measure(least))),
        // What touches is no distance.
        (most < f64::MAX && (most > 0.0 || statement.measure != Measure::Distance))
            .then(|| format!("at most {} mm", measure(most))),
    ];
    let [lower, upper] = bounds;
    let known = match statement.measure {
        Measure::Distance => lower.clone(),
        _ => upper.clone(),
    };
    let both = [lower, upper].into_iter().flatten().collect::<Vec<_>>().join(", ");
    let mut text = match (statement.state, &statement.reason) {
        (StatementState::Proven, _) => format!("everywhere and at all times, {claim}: {}", known.unwrap_or(both)),
        (StatementState::Refuted, _) if both.is_empty() => broken,
        (StatementState::Refuted, _) => format!("{broken}: {both}"),
        (StatementState::Open, Some(reason)) => format!("OPEN whether {broken}: {reason}"),
        (StatementState::Open, None) => {
            let places = counted(statement.open_count as u64, "place");
            let known = known.map_or_else(String::new, |known| format!("{known}, "));
            format!("OPEN whether {broken}: {known}not known in {places}")
        }
    };
    if let Some(witness) = &statement.witness {
        let [x, y, z] = witness.place.map(|c| format!("{c:.3}"));
        text += &format!("; {} known at ({x}, {y}, {z})", extreme(statement.measure));
        text += &match (&witness.file, witness.line, witness.path, witness.r#move) {
            (Some(file), Some(line), ..) => format!(" by {file}:{line}"),
            (.., Some(path), Some(number)) => format!(" by path {path}, move {number}"),
            _ => String::new(),
        };
    }
    text
}

/// The lines that were looked at: `along x and y, 0.5 mm apart, …`.
#[must_use]
pub fn looked_at(scope: &Scope) -> String {
    // Directions with lines equally far apart are named together.
    let mut groups: Vec<([String; 2], Vec<&str>)> = Vec::new();
    for lines in &scope.lines {
        let spacing = lines.spacing.map(length);
        match groups.iter_mut().find(|(other, _)| *other == spacing) {
            Some((_, along)) => along.push(&lines.along),
            None => groups.push((spacing, vec![&lines.along])),
        }
    }
    let group = |([a, b], along): &([String; 2], Vec<&str>)| {
        let along = match along.split_last() {
            Some((last, [])) => (*last).to_owned(),
            Some((last, first)) => format!("{} and {last}", first.join(", ")),
            None => String::new(),
        };
        let apart = if a == b { a.clone() } else { format!("{a} × {b}") };
        format!("along {along} {apart} mm apart")
    };
    groups.iter().map(group).collect::<Vec<_>>().join(", ")
}
