//! The columns of a row in which a triangle may be: of a long and narrow one that lies aslant, few of those between its
//! ends.

/// Up to so many columns are counted: divisions would take longer.
const NARROW: i64 = 12;

/// Where all three values are at least 0, among `count` columns: `values` in the first of them, which grow by `grow`
/// from each to the next.
///
/// Returns the first column and the one after the last.
pub(crate) fn inside(count: i64, values: [i64; 3], grow: [i64; 3]) -> [i64; 2] {
    if count <= NARROW {
        return counted(count, values, grow);
    }
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

/// The same, column by column.
fn counted(count: i64, mut values: [i64; 3], grow: [i64; 3]) -> [i64; 2] {
    let mut column = 0;
    let mut next = |values: &mut [i64; 3], wanted: bool| {
        while column < count && values.iter().all(|value| *value >= 0) != wanted {
            for (value, grow) in values.iter_mut().zip(grow) {
                *value += grow;
            }
            column += 1;
        }
        column
    };
    [next(&mut values, true), next(&mut values, false)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_those_where_all_values_are_at_least_0() {
        for count in [0, 1, 5, NARROW + 1] {
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
}
