//! Programs in memory are judged as those in files.

use crate::walls::{PROGRAM, complete, request, slotted};
use std::fs;
use sweepsim_job::{Memory, Output, Request};

#[test]
fn a_program_in_memory_is_judged_as_in_a_file() {
    let target = slotted([15.1, 25.0], -4.0);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("slot.nc");
    fs::write(&file, PROGRAM).unwrap();
    let of_file = complete(Request::from_file(&file), target.clone());
    let [memory, file] = [request(target), of_file].map(|request| request.plan().unwrap().run(&()).unwrap());
    assert_eq!(memory.findings(), file.findings());
    assert_eq!(memory.findings()[0].text.as_deref(), Some("G1 X68 F500"));
    let csv = |outcome: &sweepsim_job::Outcome| {
        let mut made = Memory::default();
        outcome.write_to(&mut made, &[Output::Dexels], &()).unwrap();
        made.0
    };
    assert_eq!(csv(&memory), csv(&file));
}

#[test]
fn errors_of_programs_in_memory_have_their_line() {
    let request = Request::from_program("bad.nc", "G21\nG1 X1 F100\nG1 X2 @3\n");
    let error = request.plan().unwrap_err().to_string();
    assert!(error.starts_with("bad.nc:3:"), "{error}");
}
