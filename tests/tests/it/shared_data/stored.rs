//! The stored systems: polynomial systems with known answers.

use super::folder;
use super::solver_support::expression::{Expression, Polynomial, parse};
use sweepsim_solve::{Enclosure, Equation, System};
use sweepsim_spline::Bernstein;

/// One of the stored systems.
#[derive(Clone, Debug)]
pub struct Stored {
    pub name: String,
    pub bounds: Vec<Enclosure>,
    /// Absent where the system is given by coefficients.
    pub expressions: Vec<Expression>,
    pub forms: Vec<Bernstein>,
    pub expected: serde_json::Value,
    pub tags: Vec<String>,
    pub dimension: u64,
    pub roots: Vec<Vec<f64>>,
}

/// All of them.
pub fn all() -> Vec<Stored> {
    let text = std::fs::read_to_string(folder().join("systems/systems.json")).expect("the stored systems");
    let systems: Vec<serde_json::Value> = serde_json::from_str(&text).unwrap();
    systems.iter().map(read).collect()
}

fn read(json: &serde_json::Value) -> Stored {
    let strings = |v: &serde_json::Value| -> Vec<String> {
        v.as_array()
            .map(|a| a.iter().map(|x| x.as_str().unwrap().to_owned()).collect())
            .unwrap_or_default()
    };
    let numbers =
        |v: &serde_json::Value| -> Vec<f64> { v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect() };
    let variables = strings(&json["vars"]);
    let bounds = json["box"].as_array().unwrap().iter().map(&numbers);
    let bounds: Vec<Enclosure> = bounds.map(|b| Enclosure::new(b[0], b[1]).unwrap()).collect();
    let expressions = strings(&json["equations"])
        .iter()
        .map(|e| parse(e, &variables))
        .collect();
    let forms = json["bernstein_text"].as_str().map(coefficients).unwrap_or_default();
    Stored {
        name: json["name"].as_str().unwrap().to_owned(),
        bounds,
        expressions,
        forms,
        expected: json["expected"].clone(),
        tags: strings(&json["tags"]),
        dimension: json["solution_dim"].as_u64().unwrap(),
        roots: json["roots"]
            .as_array()
            .map(|r| r.iter().map(numbers).collect())
            .unwrap_or_default(),
    }
}

fn coefficients(text: &str) -> Vec<Bernstein> {
    let mut lines = text.lines();
    let count: Vec<usize> = lines
        .next()
        .unwrap()
        .split_whitespace()
        .map(|x| x.parse().unwrap())
        .collect();
    let mut lines = lines.skip(count[0]);
    (0..count[1])
        .map(|_| {
            let degrees: Vec<usize> = lines
                .next()
                .unwrap()
                .split_whitespace()
                .map(|x| x.parse().unwrap())
                .collect();
            let values = lines
                .next()
                .unwrap()
                .split_whitespace()
                .map(|x| x.parse().unwrap())
                .collect();
            Bernstein::new(&degrees, values).unwrap()
        })
        .collect()
}

impl Stored {
    /// The equations over the stored box; `None` unless polynomial.
    pub fn equations(&self) -> Option<Vec<Equation>> {
        if !self.forms.is_empty() {
            return Some(self.forms.iter().map(Equation::from).collect());
        }
        let n = self.bounds.len();
        let polynomials: Option<Vec<Polynomial>> = self.expressions.iter().map(|e| Polynomial::of(e, n)).collect();
        Some(polynomials?.iter().map(|p| p.equation(&self.bounds)).collect())
    }

    /// The system over the stored box; `None` unless polynomial.
    pub fn system(&self) -> Option<System> {
        Some(System::mapped(&self.bounds, self.equations()?).unwrap())
    }
}
