"""What is wrong with what was given."""

from __future__ import annotations


class InputError(ValueError):
    """A file, a program or an argument cannot be used as it is.

    The message says what is wrong, where, and what was expected.
    """

    file: str | None
    """The file, or what the text was called; None if it is about no file."""
    line: int | None
    """The line of the file, from 1."""
    column: int | None
    """The column of the line in characters, from 1."""
    further: list[InputError]
    """The other problems of the same program: programs are read to their end."""

    def __init__(
        self, message: str, file: str | None = None, line: int | None = None, column: int | None = None
    ) -> None:
        super().__init__(message, file, line, column)
        self.file = file
        self.line = line
        self.column = column
        self.further = []

    def __str__(self) -> str:
        return str(self.args[0])
