"""The examples of the documentation, run as they stand: what they print is what stands below them."""

import contextlib
import io
import re
import shutil
from pathlib import Path

import pytest
from conftest import ROOT

PAGES = [Path("docs/python.md"), Path("crates/sweepsim-python/README.md")]


def sections(page: Path) -> list[tuple[str, list[tuple[str, str]]]]:
    """The examples below each heading: code, and what it prints if that is shown."""
    found = []
    for part in re.split(r"^(?=## )", (ROOT / page).read_text(), flags=re.M):
        blocks = re.findall(r"```python\n(.*?)```\n(?:\n```text\n(.*?)```\n)?", part, flags=re.S)
        if blocks:
            found.append((part.splitlines()[0].strip("# "), blocks))
    return found


EXAMPLES = [(page, *section) for page in PAGES for section in sections(page)]


def test_there_are_examples() -> None:
    assert sum(len(blocks) for _, _, blocks in EXAMPLES) >= 12


@pytest.mark.parametrize(("page", "heading", "blocks"), EXAMPLES, ids=[f"{p.stem}-{h}" for p, h, _ in EXAMPLES])
def test_examples(
    page: Path, heading: str, blocks: list[tuple[str, str]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # What they write is theirs.
    shutil.copytree(ROOT / "fixtures" / "verify", tmp_path / "fixtures" / "verify")
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {"__name__": "__main__"}
    for code, shown in blocks:
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(code, f"{page}: {heading}", "exec"), names)
        if shown:
            assert printed.getvalue().strip() == shown.strip()
