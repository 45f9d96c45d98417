"""How parts differ."""

from __future__ import annotations

import json
import os
from base64 import b64encode
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from . import _arguments, _sweepsim
from ._errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ._sweepsim import Dexels
    from ._types import Progress, Solid, SolidArrays


@dataclass(frozen=True)
class Comparison:
    """How a part differs from a target."""

    report: Mapping[str, Any]
    """Volumes, distances, and regions beyond the limits, as in ``comparison.json``."""
    picture: bytes = field(repr=False)
    """The part coloured by distance, as PNG."""

    def _repr_html_(self) -> str:
        image = b64encode(self.picture).decode("ascii")
        report = self.report
        words = f"excess {report['excess_volume']:.6g} mm³, missing {report['missing_volume']:.6g} mm³"
        source = f"data:image/png;base64,{image}"
        return f'<div><p>{words}</p><img alt="deviation" style="max-width:640px" src="{source}"></div>'


def compare(
    a: Solid,
    b: Solid,
    *,
    limits: tuple[float, float] | None = None,
    cells: tuple[int, int] | None = None,
    tolerance: float = 1e-6,
    progress: Progress | None = None,
) -> Comparison:
    """Compares a part with a target, each a file, dexels or a mesh.

    :param limits: how deep and how high regions are that the report lists. Without them, 0.1 mm each.
    :param cells: the number of dexels, where neither part has a grid.
    :param tolerance: distances up to this count as 0.
    """
    if limits is not None and not all(limit >= 0 for limit in limits):
        raise InputError("limits: expected a number of millimetres, 0 or greater")
    if not tolerance >= 0:
        raise InputError("tolerance: expected a number of millimetres, 0 or greater")
    names: list[str] = []
    given: list[Dexels | SolidArrays | None] = []
    for solid, name in ((a, "a"), (b, "b")):
        is_file = isinstance(solid, (str, os.PathLike))
        names.append(_arguments.existing(solid) if isinstance(solid, (str, os.PathLike)) else name)
        given.append(None if is_file else _arguments.solid(solid))
    request: dict[str, Any] = {
        "part": names[0],
        "target": names[1],
        "tolerance": tolerance,
        "limits": None if limits is None else {"both": list(limits)},
        "range": None,
        "grid": {} if cells is None else {"cells": cells},
        "view": {},
    }
    report, picture = _sweepsim.compare(json.dumps(request), given[0], given[1], progress)
    return Comparison(json.loads(report), picture)
