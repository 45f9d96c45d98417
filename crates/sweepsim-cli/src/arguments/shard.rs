//! Which shard of how many, given or taken from the environment that a scheduler sets.

use std::env;
use sweepsim_job::ShardNumber;

/// What schedulers call the index of a task.
const INDICES: [&str; 3] = [
    "SLURM_ARRAY_TASK_ID",
    "JOB_COMPLETION_INDEX",
    "AWS_BATCH_JOB_ARRAY_INDEX",
];

/// `3/64`; `auto/64` with the index of the environment; `auto` with the number of shards from there, too.
pub(super) fn parse(text: &str) -> Result<ShardNumber, String> {
    read(text, &|name| env::var(name).ok())
}

fn read(text: &str, variable: &dyn Fn(&str) -> Option<String>) -> Result<ShardNumber, String> {
    let expected = || "expected the shard from 0 and their number, like 3/64, or auto/64, or auto".to_owned();
    let number = |text: &str| text.trim().parse::<usize>().map_err(|_| expected());
    let (index, count) = match text.split_once('/') {
        Some(("auto", count)) => (found(variable)?.1, number(count)?),
        Some((index, count)) => (number(index)?, number(count)?),
        None if text == "auto" => {
            let (name, index) = found(variable)?;
            (index, counted(name, variable)?)
        }
        None => return Err(expected()),
    };
    ShardNumber::new(index, count)
}

/// The index that a scheduler gave, and what it calls it.
fn found(variable: &dyn Fn(&str) -> Option<String>) -> Result<(&'static str, usize), String> {
    let set = INDICES.iter().filter_map(|name| Some((*name, variable(name)?)));
    let set: Vec<_> = set.filter(|(_, value)| !value.is_empty()).collect();
    match &set[..] {
        [] => Err(format!("expected one of {} in the environment", INDICES.join(", "))),
        [(name, value)] => {
            let index = value.trim().parse();
            index
                .map(|index| (*name, index))
                .map_err(|_| format!("expected a whole number in {name}, not {value:?}"))
        }
        [(a, _), (b, _), ..] => Err(format!("both {a} and {b} are set: say which shard it is, like 3/64")),
    }
}

/// The number of tasks that the scheduler of this index knows.
fn counted(index: &str, variable: &dyn Fn(&str) -> Option<String>) -> Result<usize, String> {
    let number = |name: &str| variable(name).and_then(|value| value.trim().parse::<usize>().ok());
    let all = match index {
        // Only of an array that begins at 0 and has no gap: when a few tasks are run again, their number is not that of
        // all shards.
        "SLURM_ARRAY_TASK_ID" => number("SLURM_ARRAY_TASK_COUNT").filter(|count| {
            number("SLURM_ARRAY_TASK_MIN") == Some(0)
                && number("SLURM_ARRAY_TASK_MAX").is_some_and(|max| max + 1 == *count)
        }),
        "AWS_BATCH_JOB_ARRAY_INDEX" => number("AWS_BATCH_JOB_ARRAY_SIZE"),
        _ => None,
    };
    all.ok_or_else(|| format!("the number of shards does not follow from the environment ({index} is set): expected it in the option, like auto/64"))
}

#[cfg(test)]
mod tests {
    use super::INDICES;

    fn read(text: &str, set: &[(&str, &str)]) -> Result<(usize, usize), String> {
        let variable = |name: &str| {
            set.iter()
                .find(|(own, _)| *own == name)
                .map(|(_, value)| (*value).to_owned())
        };
        super::read(text, &variable).map(|shard| (shard.index(), shard.count()))
    }

    #[test]
    fn shards_are_numbered_from_0() {
        assert_eq!(read("0/1", &[]), Ok((0, 1)));
        assert_eq!(read("63/64", &[]), Ok((63, 64)));
        for bad in ["64/64", "1/0", "", "3", "a/3", "-1/3", "1/3/4", "0/100001", "auto/"] {
            assert!(read(bad, &[("SLURM_ARRAY_TASK_ID", "0")]).is_err(), "{bad}");
        }
    }

    #[test]
    fn schedulers_say_which() {
        for name in INDICES {
            assert_eq!(read("auto/8", &[(name, "5")]), Ok((5, 8)), "{name}");
            assert!(read("auto/5", &[(name, "5")]).is_err());
            assert!(read("auto/8", &[(name, "five")]).is_err());
        }
        assert!(read("auto/8", &[]).unwrap_err().contains("SLURM_ARRAY_TASK_ID"));
        assert!(
            read("auto/8", &[(INDICES[0], "1"), (INDICES[1], "2")])
                .unwrap_err()
                .contains("both")
        );
    }

    #[test]
    fn the_number_of_shards_is_taken_only_where_it_is_certain() {
        let slurm = |id, min, max, count| {
            [
                ("SLURM_ARRAY_TASK_ID", id),
                ("SLURM_ARRAY_TASK_MIN", min),
                ("SLURM_ARRAY_TASK_MAX", max),
                ("SLURM_ARRAY_TASK_COUNT", count),
            ]
        };
        assert_eq!(read("auto", &slurm("3", "0", "7", "8")), Ok((3, 8)));
        // Two tasks that are run again.
        assert!(
            read("auto", &slurm("3", "3", "5", "2"))
                .unwrap_err()
                .contains("auto/64")
        );
        let aws = [("AWS_BATCH_JOB_ARRAY_INDEX", "3"), ("AWS_BATCH_JOB_ARRAY_SIZE", "10")];
        assert_eq!(read("auto", &aws), Ok((3, 10)));
        assert!(read("auto", &[("JOB_COMPLETION_INDEX", "3")]).is_err());
    }
}
