"""Programs as arrays."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from . import _sweepsim

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ._types import File


@dataclass(frozen=True, eq=False)
class Program:
    """The poses of a program in their order, one a row, each with the move that ends there. Arcs are chords."""

    tips: NDArray[np.float64] = field(repr=False)
    """Where the tip is, in millimetres (n × 3)."""
    axes: NDArray[np.float64] = field(repr=False)
    """Where the axis points, a unit vector (n × 3)."""
    rapid: NDArray[np.bool_] = field(repr=False)
    """Whether the move is a rapid."""
    joined: NDArray[np.bool_] = field(repr=False)
    """Whether the tool moves here from the pose before: not at the first one, or after a tool change."""
    feed: NDArray[np.float64] = field(repr=False)
    """The feed as the program gives it; NaN where it gives none."""
    feed_mode: NDArray[np.uint8] = field(repr=False)
    """What the feed counts: 94 units per minute, 95 units per revolution, 93 moves per minute."""
    tool: NDArray[np.int64] = field(repr=False)
    """The tool's number; -1 where none is selected."""
    line: NDArray[np.int64] = field(repr=False)
    """The line of the file, from 1."""
    file: NDArray[np.int64] = field(repr=False)
    """The file: an index of ``files``."""
    files: list[str]
    """The files that were read, the main program first."""
    title: str | None
    """The name or title that the program gives itself."""
    units: str
    """``mm`` or ``inch``: the unit of the program's words."""
    controller: str | None
    """The control that it was read for."""
    format: str | None
    """The format that it was read as."""
    notes: list[tuple[int, str]] = field(repr=False)
    """What was ignored or assumed, each with its first line."""

    def __len__(self) -> int:
        """The number of poses."""
        return len(self.tips)


def read_program(
    path_or_text: File,
    *,
    controller: str | None = None,
    machine: str | None = None,
    format: str | None = None,
    lenient: bool = False,
    name: str = "program.nc",
) -> Program:
    """Reads a program: G-code, Siemens, Heidenhain, APT or CLSF, or a table of poses.

    :param path_or_text: a file, or the text of a program, which has several lines.
    :param controller: the control that it is written for. Without one, as the program says.
    :param machine: the file of a machine, or the name of a ready one.
    :param format: the format, if its content does not tell.
    :param lenient: whether to go on after problems of the program, and list them in the notes.
    :param name: what a program given as text is called; its extension tells its format.
    :raises InputError: with file, line and column; ``further`` has the other problems of the program.
    """
    asked = {"controller": controller, "machine": machine, "format": format, "lenient": lenient}
    dialect = json.dumps({key: value for key, value in asked.items() if value is not None})
    is_text = isinstance(path_or_text, str) and "\n" in path_or_text
    text = str(path_or_text) if is_text else None
    return Program(**_sweepsim.read_program(name if is_text else os.fspath(path_or_text), text, dialect))
