"""What arguments may be."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeAlias, Union

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from ._sweepsim import Dexels, Tool

File: TypeAlias = Union[str, "PathLike[str]"]
"""The name of a file."""
Progress: TypeAlias = "Callable[[int, int, str], object]"
"""Called with what is done, of how much (0 if that is not known yet), and the name of the phase."""
Tools: TypeAlias = "Union[File, Mapping[int, Union[Tool, str]]]"
"""A tool library, or tools by their numbers, each a `Tool` or its notation."""
Mesh: TypeAlias = "tuple[ArrayLike, ArrayLike]"
"""The vertices (n × 3) and the triangles (m × 3) of a closed mesh."""
Solid: TypeAlias = "Union[File, Dexels, Mesh, tuple[ArrayLike, ArrayLike, Any]]"
"""A solid: a file, dexels, or a mesh, with its normals or not."""
MeshArrays: TypeAlias = "tuple[NDArray[np.float64], NDArray[np.uint32], NDArray[np.float32]]"
"""Vertices (n × 3), triangles (m × 3) counter-clockwise seen from outside, and normals at the vertices (n × 3)."""
SolidArrays: TypeAlias = "tuple[NDArray[np.float64], NDArray[np.uint32]]"
