"""What a run found."""

from __future__ import annotations

import json
import os
from base64 import b64encode
from dataclasses import dataclass, field
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from . import _sweepsim
    from ._sweepsim import Dexels
    from ._types import File, MeshArrays, Progress

_MOST_ROWS = 100


@dataclass(frozen=True)
class Finding:
    """Something that a program does and should not."""

    kind: str
    """``collision``, ``rapid``, ``fixture``, ``gouge``, ``excess``, ``spindle``, ``feed``,
    ``machine`` or ``limit``."""
    line: int | None
    """The line of the program, from 1."""
    text: str | None
    """Its text."""
    depth: float
    """How deep it goes, in millimetres."""
    place: tuple[float, float, float]
    """Where."""
    time: float | None
    """When it begins, from 0 to 1 in the move."""
    volume: float
    """The volume, in cubic millimetres."""
    file: str | None
    """The program's file."""
    tool: int | None
    """The tool's number."""
    body: str | None
    """The shank or holder that touches, if it is not the cutter."""
    path: int | None
    """The path of the job, from 0."""
    move: int | None
    """The move of the path, from 0."""
    near: bool
    """Nothing is touched: it only comes nearer than it should."""
    details: Mapping[str, Any] = field(repr=False, compare=False)
    """All of it, as in ``report.json``."""

    @classmethod
    def _of(cls, entry: Mapping[str, Any]) -> Finding:
        names = ("line", "text", "time", "file", "tool", "body", "path", "move")
        return cls(
            kind=entry["kind"],
            depth=entry["depth"],
            volume=entry["volume"],
            place=tuple(entry["place"]),
            near=entry.get("near", False),
            details=entry,
            **{name: entry.get(name) for name in names},
        )


@dataclass(frozen=True)
class Statement:
    """Something that was asked for at every time of the program and in every place."""

    about: str
    """``gouge``, ``excess``, ``fixture``, ``holder``, ``collision``, ``rapid`` or ``machine``."""
    limit: float
    """The limit, in millimetres."""
    enclosure: tuple[float, float]
    """The largest depth or height, or the smallest distance, lies between these."""
    state: str
    """``proven``, ``refuted`` or ``open``."""
    witness: Mapping[str, Any] | None
    """Where one end of the enclosure is attained: ``file``, ``line``, ``text``, ``time``, ``place``, ``body``."""
    open: tuple[Mapping[str, Any], ...]
    """Where it is not known whether it holds: ``file``, ``line``, ``time``, ``box``; at most 100 of these places."""
    measure: str
    """``depth``, ``height`` or ``distance``."""

    @classmethod
    def _of(cls, entry: Mapping[str, Any]) -> Statement:
        low, high = entry["enclosure"]
        return cls(
            about=entry["about"],
            limit=entry["limit"],
            enclosure=(low, high),
            state=entry["state"],
            witness=entry.get("witness"),
            open=tuple(entry.get("open", ())),
            measure=entry.get("measure", "depth"),
        )


@dataclass(frozen=True)
class Reused:
    """What a run with a cache had to judge again."""

    again: int
    """Moves that were judged again."""
    moves: int
    """All moves."""
    notes: list[str]
    """What is wrong with the cache, if anything: it was then done without."""


class Outcome:
    """What a run found: verdict, findings, and the part."""

    def __init__(self, native: _sweepsim.Outcome) -> None:
        self._native = native

    @cached_property
    def report(self) -> dict[str, Any]:
        """The report, as ``report.json`` has it but for what is said of the files."""
        report: dict[str, Any] = json.loads(self._native.report())
        return report

    @property
    def verdict(self) -> str | None:
        """``"pass"``, ``"fail"`` or ``"undecided"``; None if the program was not judged."""
        verdict: str | None = self.report.get("verdict")
        return verdict

    @property
    def answer(self) -> str | None:
        """The verdict in one line, as the command says it."""
        return self._native.answer()

    @cached_property
    def findings(self) -> list[Finding]:
        """What is wrong with the program, in its order."""
        return [Finding._of(entry) for entry in self.report.get("findings") or ()]

    @cached_property
    def statements(self) -> list[Statement]:
        """What is proven, refuted or open between the lines."""
        return [Statement._of(entry) for entry in self.report.get("statements") or ()]

    @property
    def is_certified(self) -> bool:
        """Whether every dexel is certified."""
        return self._native.certified()

    @property
    def found(self) -> list[str]:
        """What was found in the program, its project or its tool library."""
        return self._native.notes()[0]

    @property
    def guessed(self) -> list[str]:
        """What nobody says and was guessed, each with its reason."""
        return self._native.notes()[1]

    @property
    def reused(self) -> Reused | None:
        """What was known from earlier runs; None without a cache."""
        reused = self._native.reused()
        return None if reused is None else Reused(*reused)

    @cached_property
    def part(self) -> Dexels:
        """What is left of the stock, on the lines along z."""
        return self._native.part()

    def mesh(self) -> MeshArrays:
        """The surface of the part with sharp walls, as ``part.ply`` has it: vertices, triangles and normals."""
        return self._native.mesh()

    @cached_property
    def picture(self) -> bytes:
        """The picture of the part, as PNG."""
        return self._native.picture()

    @property
    def certificate(self) -> str | None:
        """What was proven, for ``sweepsim check``; None if nothing was, or if solids were given in memory."""
        return self._native.certificate()

    def save(
        self,
        folder: File,
        outputs: Iterable[str] = ("dexels", "mesh", "picture", "report", "certificate"),
        *,
        progress: Progress | None = None,
    ) -> list[str]:
        """Writes outputs to a folder, which is made if it does not exist, and returns the names of the files.

        Each file is written completely or not at all.

        :param outputs: some of ``dexels``, ``mesh``, ``picture``, ``report``, ``binary``, ``tridexels``, ``step``, ``certificate``.
        """
        return self._native.save(os.fspath(folder), json.dumps(list(outputs)), progress)

    def __repr__(self) -> str:
        said = self.answer or f"{self.report['moves']} moves, {self.report.get('volume_removed') or 0:.6g} mm³ removed"
        return f"<sweepsim.Outcome {self.report.get('job', '')}: {said}>"

    def _repr_html_(self) -> str:
        """The picture and the findings, for notebooks."""
        title = escape(self.answer or repr(self)[1:-1])
        colour = {"pass": "#2e7d32", "fail": "#c62828"}.get(self.verdict or "", "#555")
        image = b64encode(self.picture).decode("ascii")
        rows = "".join(map(_row, self.findings[:_MOST_ROWS]))
        more = len(self.findings) - _MOST_ROWS
        table = ""
        if rows:
            head = "".join(f"<th>{name}</th>" for name in ("kind", "line", "text", "depth in mm", "place"))
            table = f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"
        if more > 0:
            table += f"<p>… and {more} more</p>"
        statements = "".join(
            f"<li>{escape(s.about)}: {escape(s.state)} (limit {s.limit:g} mm)</li>" for s in self.statements
        )
        proofs = f"<ul>{statements}</ul>" if statements else ""
        return (
            f'<div><p style="color:{colour};font-weight:bold">{title}</p>'
            f'<img alt="the part" style="max-width:640px" src="data:image/png;base64,{image}">{table}{proofs}</div>'
        )


def _row(finding: Finding) -> str:
    place = "({:.3f}, {:.3f}, {:.3f})".format(*finding.place)
    cells = (finding.kind, finding.line or "", finding.text or "", f"{finding.depth:.4g}", place)
    return "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in cells) + "</tr>"
