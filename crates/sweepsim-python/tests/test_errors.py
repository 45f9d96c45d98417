"""What is wrong, and where."""

import os
import pickle
from pathlib import Path

import numpy as np
import pytest

import sweepsim
from sweepsim import InputError


def test_a_program_is_wrong_at_a_line_and_a_column(tmp_path: Path) -> None:
    file = tmp_path / "wrong.nc"
    file.write_text("G21 G90\nG1 X1 F100\nG1 X2 Q#\n")
    for call in (sweepsim.read_program, sweepsim.verify, sweepsim.simulate):
        with pytest.raises(InputError) as caught:
            call(file)
        error = caught.value
        assert (error.file, error.line, error.column) == (str(file), 3, 8)
        assert str(error).startswith(f"{file}:3:8: ") and "expected" in str(error)
        assert isinstance(error, ValueError)
        same = pickle.loads(pickle.dumps(error))
        assert (str(same), same.line, same.column) == (str(error), 3, 8)


def test_all_problems_of_a_program() -> None:
    with pytest.raises(InputError) as caught:
        sweepsim.read_program("G21 G90\nG1 X1 F100\nG733 X2\nG1 X3\nG744 X4\n")
    assert caught.value.line == 3
    assert [error.line for error in caught.value.further] == [5]


@pytest.mark.parametrize("argument", ["controller", "format"])
def test_a_control_or_a_format_that_does_not_exist(argument: str) -> None:
    with pytest.raises(InputError, match=f'the {argument} is "somehow", but must be one of '):
        sweepsim.read_program("G21 G90\nG1 X1 Y0 Z0 F100\n", **{argument: "somehow"})  # type: ignore[arg-type]


def test_limits_of_comparisons() -> None:
    part = sweepsim.sweep("Ball(radius: 1, length: 5)", [[0, 0, 0]], min=(-2, -2), max=(2, 2), cells=(8, 8))
    for wrong in ({"limits": (-1, 1)}, {"limits": (0, float("nan"))}, {"tolerance": -1.0}, {"tolerance": float("nan")}):
        with pytest.raises(InputError, match="^(limits|tolerance): expected a number of millimetres"):
            sweepsim.compare(part, part, **wrong)  # type: ignore[arg-type]


def test_a_job_is_wrong_at_a_line_and_a_column() -> None:
    job = "Job(\n    stock: Block(min: (0, 0, 0), max: (1, 1, 1)),\n    tools: {1: Ball(radius: -1, length: 9)},\n    paths: [],\n)"
    with pytest.raises(InputError) as caught:
        sweepsim.simulate(job)
    assert (caught.value.file, caught.value.line) == ("job.ron", 3)


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ({"program": "nothing.nc"}, "no such file"),
        ({"program": "fixtures/verify/bracket.ron", "stock": "block:0,0,0,1,1,1"}, "stock"),
        ({"program": "fixtures/verify/bracket.nc", "stock": "block:0,0,0,1,1"}, "lower and the upper corner"),
        ({"program": "fixtures/verify/bracket.nc", "tools": {1: "Flat(radius: 5)"}}, "length"),
        ({"program": "fixtures/verify/bracket.nc", "tools": "nothing.json"}, "nothing.json"),
        ({"program": "fixtures/verify/bracket.ron", "cell": -1.0}, "positive"),
        ({"program": "fixtures/verify/bracket.ron", "cells": (10**9, 10**9)}, "cells|dexels"),
        ({"program": "fixtures/verify/bracket.ron", "cell": float("nan")}, "^cell: expected a finite number$"),
        ({"program": "fixtures/verify/bracket.ron", "cell": "wide"}, '^cell: invalid type: string "wide"'),
        ({"program": "fixtures/verify/bracket.ron", "clearance": float("inf")}, "^clearance: expected a finite number$"),
        ({"program": "fixtures/verify/bracket.ron", "limits": (-1.0, 0.0)}, "limits"),
        ({"program": "fixtures/verify/bracket.ron", "limits": (0.0, float("nan"))}, "^limits: expected a finite number$"),
        ({"program": "fixtures/verify/bracket.ron", "limits": (0.1,)}, "^limits: invalid length 1"),
        ({"program": "fixtures/verify/bracket.nc", "stock": (np.eye(3) * np.nan, [[0, 1, 2]])}, "^vertices: row 0"),
        ({"program": "fixtures/verify/bracket.ron", "directions": "w"}, "xyz"),
        ({"program": "fixtures/verify/bracket.ron", "target": (np.eye(3), [[0, 1, 7]])}, "beyond the last"),
        ({"program": "fixtures/verify/bracket.ron", "target": (np.eye(3), [[0, 1, 2]])}, "closed"),
        ({"program": "fixtures/verify/bracket.ron", "target": (np.eye(2), [[0, 1, 2]])}, "shape"),
        ({"program": "fixtures/verify/bracket.ron", "name": "x.ron"}, "text"),
    ],
)
def test_arguments_that_cannot_be_used(arguments: dict, word: str) -> None:
    with pytest.raises(InputError, match=word):
        sweepsim.verify(**arguments)


def test_sweeps_and_systems_that_cannot_be() -> None:
    grid = {"min": (0, 0), "max": (1, 1), "cells": (4, 4)}
    for poses in ([], [[1, 2]], [[1, 2, float("nan")]], [["a", "b", "c"]], [[0, 0, 0, 0, 0, 0], [1, 0, 0, 0, 0, 1]]):
        with pytest.raises(InputError):
            sweepsim.sweep("Ball(radius: 1, length: 5)", poses, **grid)
    with pytest.raises(InputError):
        sweepsim.sweep("Ball(radius: 1, length: 5)", [[0, 0, 0]], min=(0, 0), max=(0, 1), cells=(4, 4))
    for equations, box in [(["x +"], [(0, 1)]), (["x", "y"], [(0, 1)]), (["x"], [(1, 0)]), (["q"], [(0, 1)])]:
        with pytest.raises(InputError):
            sweepsim.solve_system(equations, box)
    with pytest.raises(TypeError):
        sweepsim.sweep("Ball(radius: 1, length: 5)", [[0, 0, 0]], min=(0, 0), max=(1, 1), cells=(4.5, 4))  # type: ignore[arg-type]
    with pytest.raises(InputError, match="line 1, column"):
        sweepsim.Tool("Flat(radius: 5)")


@pytest.mark.skipif(os.geteuid() == 0, reason="nothing is forbidden to root")
def test_a_folder_that_cannot_be_written_to(tmp_path: Path, facing: str) -> None:
    outcome = sweepsim.simulate(facing, tools={1: "Flat(radius: 6, length: 20)"}, stock="block:0,0,-10,40,20,0")
    tmp_path.chmod(0o500)
    with pytest.raises((InputError, OSError)):
        outcome.save(tmp_path / "x")


def test_a_file_in_place_of_a_folder(tmp_path: Path, facing: str) -> None:
    outcome = sweepsim.simulate(
        facing, tools={1: "Flat(radius: 6, length: 20)"}, stock="block:0,0,-10,40,20,0", cells=(8, 8)
    )
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="folder|directory"):
        outcome.save(tmp_path / "file")
    with pytest.raises(InputError):
        outcome.save(tmp_path, ["everything"])
