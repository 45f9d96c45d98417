"""Exact swept volumes of milling tools: simulates and verifies NC programs.

>>> import sweepsim
>>> outcome = sweepsim.verify("part.nc", tools="tools.json", target="part.stl")  # doctest: +SKIP
>>> outcome.verdict  # doctest: +SKIP
'fail'

Lengths are in millimetres. Long calls leave the interpreter to other threads, end at Ctrl-C with `KeyboardInterrupt`,
and tell their progress.
"""

from ._compare import Comparison, compare
from ._errors import InputError
from ._outcome import Finding, Outcome, Reused, Statement
from ._program import Program, read_program
from ._run import simulate, sweep, verify
from ._solve import Roots, solve_system
from ._sweepsim import Dexels, Tool

__all__ = [
    "Comparison",
    "Dexels",
    "Finding",
    "InputError",
    "Outcome",
    "Program",
    "Reused",
    "Roots",
    "Statement",
    "Tool",
    "compare",
    "read_program",
    "simulate",
    "solve_system",
    "sweep",
    "verify",
]
