//! Certificates: what was proven, written so that others can check it, and the check.

use super::asked::material::is_guessed;
use super::asked::solids;
use super::asked::{Asked, AskedAll};
use super::proof::Certified;
use crate::base::JobError;
use crate::request::{Input, Request};
use crate::session::Plan;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use sweepsim_check::{Certificate, Checked, Claim, FileDigest, Measure, Question, digest_of};
use sweepsim_formats::io_reason;

/// Larger files are no certificates.
const MOST_BYTES: u64 = 1 << 31;

/// The text of a certificate. `None` if there is nothing to certify, or the request has no notation.
pub(crate) fn text(plan: &Plan, certified: Option<&Certified>) -> Result<Option<String>, JobError> {
    let Some(certified) = certified else {
        return Ok(None);
    };
    // Solids that are given in code have no notation.
    let Ok(request) = serde_json::to_value(&plan.request) else {
        return Ok(None);
    };
    let made_by = format!("sweepsim {}", env!("CARGO_PKG_VERSION"));
    let Certified { scene, claims } = certified.clone();
    let certificate = Certificate::new(made_by, request, digests(plan)?, scene, claims);
    let text = certificate.written();
    Ok(Some(text.map_err(|error| {
        JobError::run(format!("cannot make the certificate: {error}"))
    })?))
}

/// The digests of the files that a request names, and of the programs and the target of its job.
fn digests(plan: &Plan) -> Result<Vec<FileDigest>, JobError> {
    let name = plan.request.input.name();
    let folder = name.parent().unwrap_or(Path::new(""));
    let mut files: BTreeSet<PathBuf> = plan.request.files().into_iter().collect();
    let mut all = Vec::new();
    match &plan.request.input {
        Input::File(file) => drop(files.insert(file.clone())),
        Input::Program { text, .. } | Input::Job { text, .. } => all.push(FileDigest {
            file: short(name, folder),
            sha256: digest_of(text.as_bytes()),
        }),
    }
    files.extend(plan.job.target.iter().map(|target| target.file.clone()));
    for path in &plan.job.paths {
        files.insert(folder.join(&path.source));
        files.extend(path.files.iter().cloned());
    }
    // Sources are also parts of a job, and machines names of ready ones.
    for file in files.iter().filter(|file| file.is_file()) {
        all.push(FileDigest {
            file: short(file, folder),
            sha256: digest_of(&read(file)?),
        });
    }
    all.sort_by(|a, b| (&a.file, &a.sha256).cmp(&(&b.file, &b.sha256)));
    all.dedup();
    Ok(all)
}

fn short(file: &Path, folder: &Path) -> String {
    file.strip_prefix(folder).unwrap_or(file).display().to_string()
}

fn read(file: &Path) -> Result<Vec<u8>, JobError> {
    let read = std::fs::metadata(file).and_then(|data| {
        if data.len() > MOST_BYTES {
            return Err(std::io::Error::other("it is too large"));
        }
        std::fs::read(file)
    });
    read.map_err(|error| JobError::file(file, format!("cannot be read: {}", io_reason(&error))))
}

/// What a checker says of a certificate.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct CheckedCertificate {
    /// What made it.
    pub made_by: String,
    /// The file of the job or the program that was read again.
    pub input: PathBuf,
    /// Of each of its statements.
    pub statements: Vec<CheckedStatement>,
}

/// What a checker says of an answer to a question.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct CheckedStatement {
    /// What was asked: `gouge`, `excess`, `holder`, `fixture`, `rapid` or `collision`; of fixtures, there is a question
    /// for each solid.
    pub about: String,
    /// What was measured.
    pub measure: Measure,
    /// What is measured should be no more. It is less than 0 of distances, as the bound is.
    pub limit: f64,
    /// The bound that is claimed, and what is attained at a witness; none where nothing can be checked.
    pub claimed: Option<(f64, Option<f64>)>,
    /// What was found.
    pub checked: Checked,
}

impl CheckedStatement {
    /// Whether it is proven that nothing goes beyond the limit.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.checked.is_proven() && self.claimed.is_some_and(|(bound, _)| bound <= self.limit)
    }
}

impl CheckedCertificate {
    /// Whether all statements hold, and there is one.
    #[must_use]
    pub fn holds(&self) -> bool {
        !self.statements.is_empty() && self.statements.iter().all(CheckedStatement::holds)
    }
}

/// Checks a certificate: reads its files again, and recomputes every bound with the arithmetic of `sweepsim-check`.
///
/// Relative names of files refer to the current folder, if the job or the program is there; otherwise to the folder of
/// the certificate, or the nearest one around it where they are.
///
/// # Errors
/// [`JobError`]: it is not a certificate, a file cannot be read, or it does not belong to these files.
pub fn check(file: &Path, threads: usize) -> Result<CheckedCertificate, JobError> {
    let certificate = Certificate::read(&read(file)?).map_err(|error| JobError::file(file, error))?;
    let Certificate {
        made_by,
        request,
        files,
        scene,
        claims,
        ..
    } = certificate;
    let request: Request = serde_json::from_value(request)
        .map_err(|error| JobError::file(file, format!("the request of the certificate is not readable: {error}")))?;
    let plan = found(request, file).plan()?;
    let input = plan.request.input.name().to_owned();
    let other = |what: String| JobError::file(file, format!("does not belong to these files: {what}"));
    let there = digests(&plan)?;
    let is_there = |stated: &&FileDigest| {
        let same = |own: &FileDigest| own.sha256 == stated.sha256 && base(&own.file) == base(&stated.file);
        there.iter().any(same)
    };
    if let Some(changed) = files.iter().find(|stated| !is_there(stated)) {
        return Err(other(format!("{} has changed, or is not there", changed.file)));
    }
    let asked = AskedAll::new(&plan.job, &plan.request, is_guessed(&plan));
    // A checker of heights takes it as given that triangles do not cross.
    let is_height = |asked: &&Asked| asked.measure == Measure::Height;
    let heights = asked.statements.iter().filter(is_height);
    let fault = heights.flat_map(|asked| &asked.obstacles).find_map(|number| {
        let soup = asked.obstacles[*number].triangles.as_ref();
        let solid = soup
            .map_err(String::clone)
            .and_then(|soup| solids::of_mesh(soup, "the target", 0.0, (None, &())));
        solid.err()
    });
    let own = asked.scene();
    drop(asked);
    if own.digest() != scene || own.questions.len() != claims.len() {
        return Err(other("targets, tools, paths, fixtures or limits are others".into()));
    }
    let checked = |(question, claim): (&Question, Option<Claim>)| CheckedStatement {
        about: question.about.clone(),
        measure: question.measure,
        limit: question.limit,
        claimed: claim
            .as_ref()
            .map(|claim| (claim.bound, claim.witness.as_ref().map(|witness| witness.depth))),
        checked: claim.map_or_else(Checked::default, |claim| match &fault {
            Some(_) if question.measure == Measure::Height => {
                let mut refused = Checked::default();
                refused.wrong.clone_from(&fault);
                refused
            }
            _ => sweepsim_check::check(&own, question, &claim, threads),
        }),
    };
    Ok(CheckedCertificate {
        made_by,
        input,
        statements: own.questions.iter().zip(claims).map(checked).collect(),
    })
}

fn base(file: &str) -> Option<&std::ffi::OsStr> {
    Path::new(file).file_name()
}

/// The same request, with the names of its files as they are found from here.
fn found(request: Request, certificate: &Path) -> Request {
    let Input::File(input) = &request.input else {
        return request;
    };
    if input.is_absolute() || input.is_file() {
        return request;
    }
    let around = std::path::absolute(certificate).unwrap_or_else(|_| certificate.to_owned());
    let folder = around.ancestors().skip(1).find(|folder| folder.join(input).is_file());
    match folder {
        Some(folder) => request.within(folder),
        None => request,
    }
}
