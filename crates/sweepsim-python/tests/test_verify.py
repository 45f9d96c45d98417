"""Programs, judged and simulated."""

import csv
import json
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from conftest import left_behind

import sweepsim

TOOLS = {1: "Flat(radius: 6, length: 20)"}
BLOCK = "block:0,0,-10,40,20,0"


def box(low: list[float], high: list[float]) -> tuple[np.ndarray, np.ndarray]:
    """The mesh of a block."""
    corners = np.array([[[low, high][k >> a & 1][a] for a in range(3)] for k in range(8)])
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return corners, np.array([t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))])


def test_a_job_is_judged() -> None:
    good = sweepsim.verify("fixtures/verify/bracket.ron", proof=False)
    assert good.verdict == "pass" and good.findings == [] and good.statements == []
    bad = sweepsim.verify(Path("fixtures/verify/bracket-faulty.ron"), proof=False)
    assert bad.verdict == "fail"
    kinds = [finding.kind for finding in bad.findings]
    assert kinds == [entry["kind"] for entry in bad.report["findings"]]
    assert {"fixture", "rapid", "gouge", "collision", "excess"} <= set(kinds)
    lines = Path("fixtures/verify/bracket-faulty.nc").read_text().splitlines()
    of_lines = [finding for finding in bad.findings if finding.line]
    assert len(of_lines) >= 7
    assert all(lines[finding.line - 1].strip() == finding.text for finding in of_lines)
    assert bad.answer is not None and bad.answer.startswith("FAIL: ")


def test_a_text_is_judged_with_tools_stock_and_target_in_memory(facing: str) -> None:
    target = box([0, 0, -10], [40, 20, -2])
    outcome = sweepsim.verify(
        facing, tools=TOOLS, stock=BLOCK, target=target, limits=(0.05, 0.1), cells=(80, 40), name="facing.nc"
    )
    [finding] = [finding for finding in outcome.findings if finding.kind == "gouge" and finding.line == 8]
    assert (finding.text, finding.file, finding.tool) == ("G1 X-8", "facing.nc", 1)
    assert finding.depth == pytest.approx(0.5, abs=1e-6)
    [gouge] = [statement for statement in outcome.statements if statement.about == "gouge"]
    assert gouge.state == "refuted" and gouge.enclosure[0] <= 0.5 <= gouge.enclosure[1] + 1e-9
    assert gouge.witness is not None and gouge.witness["line"] in (7, 8)
    # The same target with the depth that was cut is kept.
    deeper = sweepsim.simulate(facing, tools=TOOLS, stock=BLOCK, cells=(80, 40))
    assert deeper.verdict is None and deeper.answer is None and deeper.findings == []
    again = sweepsim.verify(facing, tools=TOOLS, stock=BLOCK, cells=(80, 40), target=deeper.mesh(), proof=False)
    assert again.verdict == "pass", again.answer


def test_what_is_left_is_the_stock_of_the_next_program(facing: str) -> None:
    first = sweepsim.simulate(facing, tools=TOOLS, stock=BLOCK, cells=(80, 40))
    second = sweepsim.simulate(facing, tools=TOOLS, stock=first.part)
    assert first.report["volume_removed"] > 1000
    assert second.report["volume_removed"] == pytest.approx(0, abs=1e-6)
    assert second.part.cells == (80, 40)


def test_cells_by_their_size(facing: str) -> None:
    fine = sweepsim.simulate(facing, tools=TOOLS, stock=BLOCK, cell=0.25)
    assert fine.part.cells == (160, 80) and fine.part.spacing == (0.25, 0.25)
    with pytest.raises(sweepsim.InputError, match="cell"):
        sweepsim.simulate(facing, tools=TOOLS, stock=BLOCK, cell=0.25, cells=(10, 10))


def test_an_outcome_is_saved_whole(facing: str, tmp_path: Path) -> None:
    target = box([0, 0, -10], [40, 20, -2])
    outcome = sweepsim.verify(facing, tools=TOOLS, stock=BLOCK, target=target, cells=(80, 40), proof=False)
    folder = tmp_path / "new" / "folder"
    names = outcome.save(folder)
    assert sorted(names) == ["dexels.csv", "part.ply", "part.png", "report.html", "report.json"]
    assert sorted(names) == left_behind(folder)
    report = json.loads((folder / "report.json").read_text())
    assert report["findings"] == outcome.report["findings"] != [] and report["verdict"] == "fail"
    with open(folder / "dexels.csv") as file:
        rows = [(int(row["i"]), int(row["j"]), float(row["z0"]), float(row["z1"])) for row in csv.DictReader(file)]
    part = outcome.part
    assert len(rows) == len(part) == 3200
    assert np.array_equal(part.lines, [row[:2] for row in rows])
    assert np.array_equal(part.intervals, [row[2:] for row in rows])
    assert outcome.save(tmp_path, ["binary"]) == ["part.dexels"]
    read = sweepsim.Dexels.read(tmp_path / "part.dexels")
    assert np.array_equal(read.intervals, part.intervals) and np.array_equal(read.moves, part.moves)


class Tags(HTMLParser):
    """The tags of a page, and its text."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[str] = []
        self.words = ""
        self.feed(html)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        if tag != "img":
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words += data


def test_a_notebook_shows_picture_and_findings(facing: str) -> None:
    text = facing.replace("G1 X-8\n", "G1 X-8 (<b>deep</b>)\n")
    outcome = sweepsim.verify(
        text, tools=TOOLS, stock=BLOCK, target=box([0, 0, -10], [40, 20, -2]), limits=(0.05, 0.1), cells=(80, 40)
    )
    page = Tags(outcome._repr_html_())
    assert page.tags.count("img") == 1 and page.tags.count("tr") == 1 + len(outcome.findings)
    assert "b" not in page.tags and "(<b>deep</b>)" in page.words
    assert outcome.answer is not None and outcome.answer in page.words
    assert outcome.picture.startswith(b"\x89PNG")
    assert outcome.answer in repr(outcome)


def test_a_changed_program_is_judged_from_the_change_on(tmp_path: Path) -> None:
    def program(depth: float) -> str:
        """Twenty rows, of which the eighteenth is this deep."""
        depths = [depth if row == 17 else 1 for row in range(20)]
        rows = [f"G0 X-8 Y{row}\nG1 Z-{z} F600\nG1 X48\nG0 Z5" for row, z in enumerate(depths)]
        return "\n".join(["G21 G90", "T1 M6", "S8000 M3", "G0 Z5", *rows, "M30", ""])

    text, changed = program(1), program(1.5)

    def judged(program: str, cache: Path | None) -> sweepsim.Outcome:
        target = box([0, 0, -10], [40, 20, -1.2])
        return sweepsim.verify(
            program, tools=TOOLS, stock=BLOCK, target=target, limits=(0.05, 0.1), cells=(40, 20), cache=cache
        )

    first = judged(text, tmp_path)
    assert first.reused is not None and first.reused.again == first.reused.moves and first.reused.notes == []
    again = judged(text, tmp_path).reused
    assert again is not None and again.again == 0
    second, without = judged(changed, tmp_path), judged(changed, None)
    assert without.reused is None
    assert second.reused is not None and 0 < second.reused.again < second.reused.moves / 2
    assert second.findings == without.findings and second.findings != first.findings
    assert second.statements == without.statements
    assert (second.part.intervals == without.part.intervals).all()
    # A cache that cannot be is done without, and that is said.
    (tmp_path / "file").write_text("")
    spoilt = judged(text, tmp_path / "file")
    assert spoilt.findings == first.findings
    assert spoilt.reused is not None and spoilt.reused.notes != []
