//! The columns of a row in which a triangle may be: of a long and narrow one that lies aslant, few of those between its ends.

/// Where all three values are at least 0, among `count` columns: `values` in the first of them, which grow by `grow` from each to the next.
///
/// Returns the first column and the one after the last.
pub(crate) fn inside(count: i64, values: [i64; 3], grow: [i64; 3]) -> [i64; 2] {
    let (mut from, mut to) = (0, count);
    for (value, grow) in values.into_iter().zip(grow) {
        match grow {
            // The least n for which value + n · grow ≥ 0.
            1.. => from = from.max(-(value.div_euclid(grow))),
            0 if value >= 0 => {}
            0 => to = 0,
            // The largest one: of a negative divisor, the quotient by Euclid's division of −value is rounded up.
            _ => to = to.min(value.div_euclid(-grow) + 1),
        }
    }
    let from = from.min(count);
    [from, to.max(from)]
}

/// The part of a range of columns in which a value may be at least 0: it is `value` in column 0, and grows by `slope`. Where either is not a number, all of it.
pub(crate) fn narrowed([from, to]: [f64; 2], value: f64, slope: f64) -> [f64; 2] {
    if slope > 0.0 {
        [from.max((-value / slope).floor()), to]
    } else if slope < 0.0 {
        [from, to.min((-value / slope).ceil())]
    } else if value < 0.0 {
        [from, from - 1.0]
    } else {
        [from, to]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_those_where_all_values_are_at_least_0() {
        for count in [0, 1, 5] {
            for code in 0..7_i64.pow(4) {
                let [a, b, c, d] = [0, 1, 2, 3].map(|k| code / 7_i64.pow(k) % 7 - 3);
                let (values, grow) = ([3 * a, b, 2], [c, d, 0]);
                let all = |column: i64| (0..3).all(|k| values[k] + column * grow[k] >= 0);
                let [from, to] = inside(count, values, grow);
                let found: Vec<i64> = (from..to).collect();
                let expected: Vec<i64> = (0..count).filter(|column| all(*column)).collect();
                assert_eq!(found, expected, "{count} {values:?} {grow:?}");
            }
        }
    }

    /// Nothing is left out, and hardly anything else is left in.
    #[test]
    fn ranges_are_narrowed_to_where_values_may_be_at_least_0() {
        for (value, slope) in [
            (-5.0, 2.0),
            (5.0, -2.0),
            (-6.0, 2.0),
            (1e9, -1e8),
            (-1e9, 1e-3),
            (-1e-30, 0.0),
            (0.0, 0.0),
        ] {
            let [from, to] = narrowed([2.0, 20.0], value, slope);
            let may = |column: &i32| value + slope * f64::from(*column) >= 0.0;
            let expected: Vec<i32> = (2..=20).filter(may).collect();
            let within = |column: f64| from <= column && column <= to;
            assert!(
                expected.iter().all(|column| within(f64::from(*column))),
                "{value} {slope}"
            );
            let found = (2..=20).filter(|column| within(f64::from(*column))).count();
            assert!(found <= expected.len() + 1, "{value} {slope}: {found}");
        }
        for (value, slope) in [
            (f64::NAN, 1.0),
            (1.0, f64::NAN),
            (f64::NAN, f64::NAN),
            (f64::INFINITY, f64::INFINITY),
        ] {
            assert_eq!(narrowed([2.0, 20.0], value, slope), [2.0, 20.0]);
        }
    }
}
