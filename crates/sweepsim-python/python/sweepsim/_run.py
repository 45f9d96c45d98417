"""Programs, simulated and verified, and tools, swept."""

from __future__ import annotations

import json
from operator import index
from typing import TYPE_CHECKING, Any

from . import _arguments, _sweepsim
from ._errors import InputError
from ._outcome import Outcome
from ._sweepsim import Dexels, Tool

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from ._types import File, Progress, Solid, Tools


def _run(
    task: str,
    program: File,
    *,
    name: str | None,
    tools: Tools | None,
    stock: Solid | str | None,
    target: Solid | None = None,
    options: Mapping[str, Any],
    dialect: Mapping[str, Any],
    cache: File | None = None,
    progress: Progress | None,
) -> _sweepsim.Outcome:
    library, given_tools = _arguments.tools(tools)
    asked_stock, given_stock = (None, None) if stock is None else _arguments.stock(stock)
    asked_target, given_target = _arguments.target(target)
    source = _arguments.source(program, name)
    # A job says itself what its stock is: "auto" is the default of programs.
    is_job = "job" in source or str(source.get("file", "")).lower().endswith(".ron")
    reading = {key: value for key, value in dialect.items() if value is not None}
    own: dict[str, Any] = {"dialect": reading} if reading else {}
    if library is not None:
        own["tools"] = library
    if asked_stock is not None and not (is_job and asked_stock == "auto"):
        own["stock"] = asked_stock
    if asked_target is not None:
        own["target"] = asked_target
    request: dict[str, Any] = {"input": source, "task": task, "program": own}
    request.update((key, value) for key, value in options.items() if value is not None)
    return _sweepsim.run(json.dumps(request), given_tools, given_stock, given_target, cache, progress)


def verify(
    program: File,
    *,
    tools: Tools | None = None,
    stock: Solid | str = "auto",
    target: Solid | None = None,
    machine: str | None = None,
    limits: tuple[float, float] | None = None,
    cell: float | None = None,
    cells: tuple[int, int] | None = None,
    controller: str | None = None,
    clearance: float | None = None,
    directions: str | None = None,
    proof: bool = True,
    moves: bool = False,
    cache: File | None = None,
    name: str | None = None,
    progress: Progress | None = None,
) -> Outcome:
    """Judges every move of a program, in its order.

    :param program: the file of a program or of a job (``.ron``), or the text of one, which has several lines.
    :param tools: a tool library, or tools by their numbers: ``{1: "Flat(radius: 5, length: 30)"}``.
    :param stock: ``"auto"``: as the program says, or a block around its feed moves;
        ``"block:0,0,-20,60,40,0"``: from the lower to the upper corner; a file; dexels; or a mesh.
    :param target: the part that is wanted: a file, or a mesh.
    :param machine: the file of a machine, or the name of a ready one.
    :param limits: how deep gouges and how high remaining material may be.
    :param cell: the distance of the dexels, or nearly so.
    :param cells: the number of dexels along x and y, instead.
    :param controller: the control that the program is written for.
    :param clearance: how near shanks and holders may come to the workpiece and to fixtures.
    :param directions: ``"xyz"`` or ``"z"``: the directions of dexels that moves are judged along.
    :param proof: whether to prove what can be proven between the lines.
    :param moves: whether to tell what each move does, as ``moves.csv`` when the outcome is saved.
    :param cache: a folder that keeps what is found, so that a changed program is judged from the change on only:
        the same results, sooner. Give a program that is a text the same name each time.
    :param name: what a program given as text is called; its extension tells its format.
    :param progress: called with what is done, of how much (0 if that is not known yet), and the name of the phase.
    :raises InputError: what is given cannot be used, with file, line and column.
    :raises KeyboardInterrupt: after Ctrl-C.
    """
    judging: dict[str, Any] = {"proof": proof, "moves": moves}
    if clearance is not None:
        judging["clearance"] = clearance
    options = {"limits": limits, "cell": cell, "cells": cells, "directions": directions, "judging": judging}
    dialect = {"machine": machine, "controller": controller}
    return Outcome(
        _run(
            "verify",
            program,
            name=name,
            tools=tools,
            stock=stock,
            target=target,
            options=options,
            dialect=dialect,
            cache=cache,
            progress=progress,
        )
    )


def simulate(
    program: File,
    *,
    tools: Tools | None = None,
    stock: Solid | str = "auto",
    machine: str | None = None,
    cell: float | None = None,
    cells: tuple[int, int] | None = None,
    controller: str | None = None,
    name: str | None = None,
    progress: Progress | None = None,
) -> Outcome:
    """Moves the tools of a program through the stock. Arguments are those of `verify`."""
    return Outcome(
        _run(
            "simulate",
            program,
            name=name,
            tools=tools,
            stock=stock,
            options={"cell": cell, "cells": cells},
            dialect={"machine": machine, "controller": controller},
            progress=progress,
        )
    )


def sweep(
    tool: Tool | str,
    poses: ArrayLike,
    *,
    min: tuple[float, float],
    max: tuple[float, float],
    cells: tuple[int, int],
    tolerance: float = 1e-6,
    progress: Progress | None = None,
) -> Dexels:
    """The volume that a tool sweeps from pose to pose, on a grid.

    :param tool: a `Tool`, or its notation.
    :param poses: where the tip is, and where the axis points (n × 6); or tips alone (n × 3), with the axis along z.
    :param min: the lower corner of the grid.
    :param max: its upper corner.
    :param cells: the number of dexels along x and y.
    :param tolerance: that of interval ends.
    """
    import numpy as np

    try:
        rows = np.asarray(poses, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"poses: {error}: expected an array of numbers") from error
    if rows.ndim != 2 or rows.shape[1] not in (3, 6) or len(rows) == 0:
        raise InputError(f"poses: an array of the shape {rows.shape}: expected (n, 3) or (n, 6)")
    if not np.isfinite(rows).all():
        raise InputError(f"poses: row {int(np.argmin(np.isfinite(rows).all(axis=1)))} is not finite")
    if rows.shape[1] == 3:
        rows = np.hstack([rows, np.tile([0.0, 0.0, 1.0], (len(rows), 1))])
    table = ",".join(f"(({x!r},{y!r},{z!r}),({i!r},{j!r},{k!r}))" for x, y, z, i, j, k in rows.tolist())
    corners = [f"({float(x)!r},{float(y)!r})" for x, y in (min, max)]
    columns, lines = (index(number) for number in cells)
    job = f"""Job(
    tolerance: {float(tolerance)!r},
    grid: Grid(min: {corners[0]}, max: {corners[1]}, cells: ({columns}, {lines})),
    stock: Block(min: (0, 0, 0), max: (1, 1, 1)),
    paths: [Path(tool: 1, poses: [{table}])],
)
"""
    given = tool if isinstance(tool, Tool) else Tool(tool)
    request = {"input": {"job": {"name": "sweep.ron", "text": job}}, "task": "sweep"}
    return _sweepsim.run(json.dumps(request), {1: given}, None, None, None, progress).part()
