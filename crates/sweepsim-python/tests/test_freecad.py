"""The add-on, in a FreeCAD without a window, on one of its example jobs."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest
from conftest import ROOT

import sweepsim

EXAMPLES = [
    Path("/usr/share/freecad/Mod/Path/PathTests/boxtest.fcstd"),
    Path("/usr/share/freecad/Mod/CAM/CAMTests/boxtest.fcstd"),
]
EXAMPLE = next((file for file in EXAMPLES if file.is_file()), None)
COMMAND = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")

SCRIPT = """
import json, sys
sys.path[:0] = {folders!r}
import FreeCAD, sweepsim_cam
job = FreeCAD.openDocument({example!r}).Job

def told(found):
    findings = [(finding.kind, finding.depth, operation and operation.Label) for finding, operation in found.findings]
    return [found.outcome.verdict, found.outcome.report["moves"], findings]

print()
print("FOUND", json.dumps(told(sweepsim_cam.verify(job, cell=0.2))))
# A larger tool than the one that the paths were made for.
job.Tools.Group[0].Tool.Diameter = 8
print()
print("FOUND", json.dumps(told(sweepsim_cam.verify(job, cell=0.2))))
job.Tools.Group[0].Tool.ShapeName = "unheard of"
try:
    sweepsim_cam.verify(job)
except Exception as error:
    print()
    print("FOUND", json.dumps([type(error).__name__, str(error)]))
"""


@pytest.mark.skipif(COMMAND is None or EXAMPLE is None, reason="FreeCAD is not installed, or without its examples")
def test_a_job_of_freecad_is_verified(tmp_path: Path) -> None:
    # FreeCAD has a Python and a NumPy of its own.
    (tmp_path / "sweepsim").symlink_to(Path(sweepsim.__file__).parent)
    folders = [str(ROOT / "crates" / "sweepsim-python" / "freecad"), str(tmp_path)]
    script = tmp_path / "script.py"
    script.write_text(SCRIPT.format(folders=folders, example=str(EXAMPLE)))
    done = subprocess.run([COMMAND, str(script)], capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL)
    found = [json.loads(line[6:]) for line in done.stdout.splitlines() if line.startswith("FOUND ")]
    assert len(found) == 3, done.stdout[-2000:] + done.stderr[-2000:]
    # The example cuts around a cube, and leaves the millimetre above it: nothing else is wrong.
    verdict, moves, findings = found[0]
    assert verdict == "fail" and moves > 20
    assert {kind for kind, _, _ in findings} == {"excess"}
    assert max(depth for _, depth, _ in findings) > 0.9
    # 1.5 mm of the radius cut into it, by the operation that is named.
    verdict, _, findings = found[1]
    gouges = [(depth, operation) for kind, depth, operation in findings if kind == "gouge"]
    assert len(gouges) > 3 and {operation for _, operation in gouges} == {"Profile"}
    assert max(depth for depth, _ in gouges) == pytest.approx(1.5, abs=0.01)
    assert found[2][0] == "InputError" and "unheard of" in found[2][1]
