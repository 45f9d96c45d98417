"""What the tests share."""

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(autouse=True)
def at_root(monkeypatch: pytest.MonkeyPatch) -> None:
    """Files are named from the root of the repository on."""
    monkeypatch.chdir(ROOT)


@pytest.fixture
def facing() -> str:
    """Faces a block, 2 mm deep in two passes. The second is too deep."""
    return "G21 G90\nT1 M6\nS8000 M3\nG0 X-8 Y5 Z5\nG0 Z-2\nG1 X48 F600\nG1 Y15 Z-2.5\nG1 X-8\nG0 Z5\nM30\n"


def left_behind(folder: Path) -> list[str]:
    """The files of a folder."""
    return sorted(os.listdir(folder)) if folder.exists() else []
