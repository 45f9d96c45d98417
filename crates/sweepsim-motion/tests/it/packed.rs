//! Packed rows and paths hold what was put in, to the last bit.

use sweepsim_motion::{
    Law, Move, PackedRows, Path, PathBuilder, Pose, RotaryTable, TableTurns, TipArc, TipCourse, Turning,
};
use sweepsim_props::*;

/// Numbers as programs have them, and any others.
fn column() -> impl Strategy<Value = Vec<f64>> {
    const ROWS: usize = 300;
    let decimals = (0..8, 1.0..1000.0_f64, any::<u64>(), prop_oneof![Just(1.0), Just(25.4)]).prop_map(
        |(places, step, seed, unit)| {
            let scale = 10_f64.powi(places);
            let mut state = seed | 1;
            let mut at = 0.0;
            (0..ROWS)
                .map(|row| {
                    state ^= state << 13;
                    state ^= state >> 7;
                    state ^= state << 17;
                    // Now and then far away, as rapids are.
                    let far = if row % 47 == 46 { 1e4 } else { 1.0 };
                    at += step * far * ((state % 2001) as f64 / 1000.0 - 1.0);
                    format!("{:.*}", places as usize, at / scale)
                        .parse::<f64>()
                        .unwrap_or(0.0)
                        * unit
                })
                .collect::<Vec<f64>>()
        },
    );
    prop_oneof![
        decimals,
        any::<f64>().prop_map(|value| vec![value; ROWS]),
        (any::<i32>(), -1000..1000).prop_map(|(from, step)| (0..ROWS as i32)
            .map(|k| f64::from(from) + f64::from(step * k))
            .collect()),
        collection::vec(any::<u64>().prop_map(f64::from_bits), ROWS),
        collection::vec(-1.0..1.0, ROWS),
        collection::vec(
            prop_oneof![
                Just(0.0),
                Just(-0.0),
                Just(f64::NAN),
                Just(f64::INFINITY),
                Just(9e15),
                Just(-1e300),
                Just(5e-324)
            ],
            ROWS
        ),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn rows_come_back_to_the_last_bit([a, b, c] in [column(), column(), column()], count in 0..300_usize, from in 0..300_usize) {
        let rows: Vec<[f64; 3]> = (0..count).map(|row| [a[row], b[row], c[row]]).collect();
        let packed: PackedRows<3> = rows.iter().copied().collect();
        let bits = |row: &[f64; 3]| row.map(f64::to_bits);
        prop_assert_eq!(packed.len(), count);
        prop_assert!(packed.iter().map(|row| bits(&row)).eq(rows.iter().map(bits)));
        for (k, row) in rows.iter().enumerate() {
            prop_assert_eq!(packed.get(k).map(|row| bits(&row)), Some(bits(row)));
        }
        prop_assert!(packed.get(count).is_none());
        let from = from.min(count);
        prop_assert!(packed.range(from..count).map(|row| bits(&row)).eq(rows[from..].iter().map(bits)));
        prop_assert!(packed.into_iter().map(|row| bits(&row)).eq(rows.iter().map(bits)));
    }
}

/// A program's course: lines, then arcs, of many moves, whose axis turns if asked for.
fn course(count: usize, turns: bool) -> (Vec<Pose>, Vec<Move>) {
    let (mut poses, mut moves) = (Vec::new(), Vec::new());
    for k in 0..count {
        let row = (k / 100) as f64;
        let along = if row % 2.0 == 0.0 { k % 100 } else { 99 - k % 100 };
        let tip = [
            0.1 * along as f64,
            0.25 * row,
            (1000.0 * (0.3 * k as f64).sin()).round() / 1000.0,
        ];
        let lean = if turns { 0.2 * (0.01 * k as f64).cos() } else { 0.0 };
        poses.push(Pose::new(tip, [lean, 0.1 * lean, 1.0]).unwrap());
        if let [.., from, to] = &poses[..] {
            let middle: [f64; 3] = std::array::from_fn(|c| 0.5 * (from.tip()[c] + to.tip()[c]));
            let arc = TipArc::between(
                [from.tip()[0], from.tip()[1], 0.0],
                [to.tip()[0], to.tip()[1], 0.0],
                middle,
                [0.0, 0.0, 1.0],
                1,
            );
            moves.push(match arc {
                Ok(arc) if k > count / 2 && k % 7 == 0 => Move::arc(arc),
                Ok(arc) if k > count / 2 && k % 7 <= 2 => Move {
                    course: TipCourse::Carried(match k % 7 {
                        1 => TableTurns::new(arc),
                        _ => TableTurns::new(arc).on(arc.reversed()),
                    }),
                    turning: Turning::Even,
                },
                _ if k % 11 == 0 => Move::straight(Turning::Even),
                _ => Move::default(),
            });
        }
    }
    (poses, moves)
}

fn built(poses: &[Pose], moves: &[Move], law: Law) -> Path {
    let mut builder = PathBuilder::default();
    for (k, pose) in poses.iter().enumerate() {
        let way = k.checked_sub(1).and_then(|k| moves.get(k).copied());
        builder.push(*pose, way.unwrap_or_default());
    }
    assert_eq!(builder.len(), poses.len());
    builder.finish(law).unwrap()
}

/// Everything that a path says of itself, in both forms.
fn same(packed: &Path, plain: &Path) {
    assert_eq!((packed.moves(), packed.size()), (plain.moves(), plain.size()));
    assert!(packed.poses_in_order(17).eq(plain.poses()[17..].iter().copied()));
    for number in (0..plain.moves()).step_by(37) {
        assert_eq!(
            (packed.pose(number), packed.way(number)),
            (plain.pose(number), plain.way(number))
        );
        assert_eq!(packed.tip_length(number), plain.tip_length(number));
        assert_eq!(packed.rests(number, number + 1), plain.rests(number, number + 1));
        let segments = |path: &Path| format!("{:?}", path.segments(number, 5.0, 1e-3));
        assert_eq!(segments(packed), segments(plain));
    }
    let part = 4_000..plain.moves() - 5;
    assert_eq!(packed.part(part.clone()), plain.part(part));
    let mut next = 0;
    for (first, stretch) in packed.stretches(1_000) {
        assert_eq!(first, next);
        assert_eq!(*stretch, plain.part(first..first + stretch.moves()));
        next += stretch.moves();
    }
    assert_eq!(next, plain.moves());
    assert_eq!(packed.poses(), plain.poses());
}

#[test]
fn a_long_path_is_the_same_packed() {
    for (count, turns) in [(6_000, false), (9_001, true)] {
        let (poses, moves) = course(count, turns);
        let plain = Path::with_moves(poses.clone(), moves.clone()).unwrap();
        let packed = built(&poses, &moves, Law::Slerp);
        same(&packed, &plain);
        let turn = nalgebra::Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
        let moved = |path: &Path| path.moved(&turn, [1.0, 2.0, 0.3]).unwrap();
        same(&moved(&packed), &moved(&plain));
        for law in [Law::Slerp, Law::ConstantSpeed, Law::Rotary(RotaryTable::Ac)] {
            let plain = Path::with_law(poses.clone(), law).unwrap();
            same(&built(&poses, &[], law), &plain);
        }
    }
}

#[test]
fn a_long_path_is_refused_where_it_would_be_unpacked() {
    let (mut poses, _) = course(6_000, false);
    poses[5_500] = Pose::new(poses[5_500].tip(), [0.0, 0.0, -1.0]).unwrap();
    let mut builder = PathBuilder::default();
    poses.iter().for_each(|pose| builder.push(*pose, Move::default()));
    assert_eq!(builder.finish(Law::Slerp), Path::new(poses.clone()));
    // A side cannot be packed, and must not be mixed with poses that have none.
    let (mut poses, _) = course(6_000, false);
    poses[5_500] = Pose::with_side(poses[5_500].tip(), [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]).unwrap();
    let mut builder = PathBuilder::default();
    poses.iter().for_each(|pose| builder.push(*pose, Move::default()));
    assert_eq!(builder.finish(Law::Slerp), Path::new(poses));
}

#[test]
fn decimals_that_change_little_take_a_few_bytes() {
    let mut rows = PackedRows::default();
    for k in 0..64_000 {
        let height = (2e4 * (0.001 * f64::from(k)).sin()).round() / 1e4;
        rows.push([
            (f64::from(k % 1000) * 0.05 * 1e3).round() / 1e3,
            (0.2 * f64::from(k / 1000) * 1e3).round() / 1e3,
            height,
            0.0,
            0.0,
            1.0,
        ]);
    }
    let each = rows.bytes() as f64 / rows.len() as f64;
    assert!(each < 5.0, "{each}");
}
