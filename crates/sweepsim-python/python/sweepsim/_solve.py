"""Systems of equations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from . import _sweepsim
from ._errors import InputError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_NAMES = "xyzwuvst"


@dataclass(frozen=True, eq=False)
class Roots:
    """All roots of a system in a box: each lies in one of the enclosures, or in one of the unresolved boxes."""

    variables: tuple[str, ...]
    """The names of the columns."""
    points: NDArray[np.float64]
    """The roots, to machine precision (n × d)."""
    enclosures: NDArray[np.float64]
    """A box around each that holds exactly one root: lower and upper corner (n × 2 × d)."""
    unresolved: NDArray[np.float64]
    """Boxes that may hold further roots (m × 2 × d): with none, it is certain that there are no others."""

    def __len__(self) -> int:
        """The number of roots."""
        return len(self.points)


def solve_system(
    equations: Sequence[str],
    box: Mapping[str, tuple[float, float]] | Sequence[tuple[float, float]],
    *,
    boxes: int | None = None,
) -> Roots:
    """Finds all roots of as many equations as unknowns in a box, with a certificate for each.

    :param equations: ``"x^2 + y^2 = 1"``, or what is to be 0: ``"x^2 + y^2 - 1"``.
    :param box: the range of each unknown by its name, ``{"a": (0, 1), "b": (0, 1)}``; without names they are
        x, y, z, w, u, v, s and t.
    :param boxes: the most boxes to look at: what is left then is unresolved.
    """
    import numpy as np

    if isinstance(box, Mapping):
        variables, domain = list(box.keys()), list(box.values())
    else:
        variables, domain = list(_NAMES[: len(box)]), list(box)
        if len(domain) > len(_NAMES):
            raise InputError(f"a box of {len(domain)} ranges: expected at most {len(_NAMES)}")
    ranges = [(float(low), float(high)) for low, high in domain]
    points, enclosures, unresolved = _sweepsim.solve_system(list(equations), variables, ranges, boxes)
    return Roots(tuple(variables), points, np.stack(enclosures, axis=1), np.stack(unresolved, axis=1))
