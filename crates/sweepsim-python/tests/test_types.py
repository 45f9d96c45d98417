"""The types that the package promises."""

import subprocess
import sys
from pathlib import Path

import sweepsim

USE = """
from pathlib import Path
import numpy as np
import sweepsim

outcome = sweepsim.verify(Path("a.nc"), tools={1: sweepsim.Tool("x"), 2: "y"}, limits=(0.1, 0.2))
reveal_type(outcome.findings[0].line)
reveal_type(outcome.part.intervals)
reveal_type(outcome.mesh())
sweepsim.simulate("a.nc", stock=outcome.part, progress=lambda done, total, phase: print(done, total, phase))
sweepsim.compare(outcome.part, outcome.mesh())
sweepsim.solve_system(["x"], {"x": (0.0, 1.0)})
sweepsim.verify(3)  # wrong
sweepsim.verify("a.nc", limit=(1, 2))  # wrong
"""


def mypy(*arguments: str) -> str:
    done = subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True)
    return done.stdout + done.stderr


def test_what_is_written_with_it_is_checked(tmp_path: Path) -> None:
    (tmp_path / "use.py").write_text(USE)
    found = mypy("mypy", "--strict", "--cache-dir", str(tmp_path), str(tmp_path / "use.py"))
    lines = USE.splitlines()
    wrong = [number for number, line in enumerate(lines, 1) if line.endswith("# wrong")]
    errors = [int(line.split(":")[1]) for line in found.splitlines() if ": error:" in line]
    assert errors == wrong, found
    assert 'Revealed type is "int | None"' in found or 'Revealed type is "builtins.int | None"' in found, found


def test_the_package_itself_is_checked() -> None:
    package = Path(__file__).parents[1] / "python" / "sweepsim"
    found = mypy("mypy", "--strict", str(package))
    assert found.startswith("Success"), found


def test_the_stub_says_what_the_library_has() -> None:
    found = mypy("mypy.stubtest", "sweepsim._sweepsim")
    assert found.startswith("Success"), found


def test_all_is_documented() -> None:
    for name in sweepsim.__all__:
        thing = getattr(sweepsim, name)
        assert thing.__doc__, name
        for own in vars(thing) if isinstance(thing, type) else ():
            member = getattr(thing, own)
            if not own.startswith("_") and callable(member):
                assert member.__doc__, f"{name}.{own}"
