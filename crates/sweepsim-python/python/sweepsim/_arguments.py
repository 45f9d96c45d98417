"""From arguments to requests."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from ._errors import InputError
from ._sweepsim import Dexels, Tool

if TYPE_CHECKING:
    from ._types import File, Solid, SolidArrays, Tools


def source(program: File, name: str | None) -> dict[str, Any]:
    """Where a program or a job is: text has several lines, and all else is a file."""
    if isinstance(program, str) and "\n" in program:
        called = name or ("job.ron" if program.lstrip().startswith("Job(") else "program.nc")
        kind = "job" if called.lower().endswith(".ron") else "program"
        return {kind: {"name": called, "text": program}}
    if name is not None:
        raise InputError("name: is for programs given as text")
    return {"file": os.fspath(program)}


def tools(given: Tools | None) -> tuple[str | None, dict[int, Tool]]:
    """The file of a tool library, or the tools."""
    if given is None:
        return None, {}
    if isinstance(given, Mapping):
        return None, {number: tool if isinstance(tool, Tool) else Tool(tool) for number, tool in given.items()}
    return os.fspath(given), {}


def stock(given: Solid | str) -> tuple[Any, Dexels | SolidArrays | None]:
    """The stock in the notation of a request, or in memory."""
    if isinstance(given, (str, os.PathLike)):
        text = os.fspath(given)
        if text.lower() == "auto":
            return "auto", None
        if not text.startswith("block:"):
            return {"mesh": text}, None
        try:
            numbers = [float(word) for word in text.removeprefix("block:").split(",")]
        except ValueError:
            numbers = []
        if len(numbers) != 6 or not all(low < high for low, high in zip(numbers[:3], numbers[3:])):
            raise InputError(
                f"stock: {text!r}: expected the lower and the upper corner, like block:0,0,-20,60,40,0"
            )
        return {"block": [numbers[:3], numbers[3:]]}, None
    return None, solid(given)


def solid(given: Solid) -> Dexels | SolidArrays:
    """A solid in memory, with arrays as the native half takes them."""
    if isinstance(given, Dexels):
        return given
    import numpy as np

    mesh = cast("Sequence[Any]", given)
    if len(mesh) not in (2, 3):
        raise InputError("a mesh: expected its vertices and triangles")
    try:
        vertices = np.ascontiguousarray(mesh[0], dtype=np.float64)
        triangles = np.asarray(mesh[1])
        if triangles.size and (triangles.min() < 0 or triangles.max() > 0xFFFFFFFF):
            raise InputError("triangles: expected numbers of vertices")
        triangles = np.ascontiguousarray(triangles, dtype=np.uint32)
    except (TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"a mesh: {error}: expected arrays of numbers") from error
    for what, array in (("vertices", vertices), ("triangles", triangles)):
        if array.ndim != 2 or array.shape[1] != 3:
            raise InputError(f"{what}: an array of the shape {array.shape}: expected (n, 3)")
    finite = np.isfinite(vertices).all(axis=1)
    if not finite.all():
        raise InputError(f"vertices: row {int(np.argmin(finite))} is not finite")
    return vertices, triangles


def target(given: Solid | None) -> tuple[str | None, Dexels | SolidArrays | None]:
    """The file of a target, or the target in memory."""
    if given is None:
        return None, None
    if isinstance(given, (str, os.PathLike)):
        return os.fspath(given), None
    return None, solid(given)


def existing(file: File) -> str:
    """The name of a file that must be there."""
    if not Path(file).is_file():
        raise InputError(f"{os.fspath(file)}: there is no such file", os.fspath(file))
    return os.fspath(file)
