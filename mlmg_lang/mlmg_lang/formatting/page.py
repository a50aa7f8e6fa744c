"""The lines of a formatted script, one after the other."""

from __future__ import annotations

from collections.abc import Iterable

from mlmg_lang.formatting.wrapping import Row


class Page:
    """Takes rows and comments, knows where empty lines may stand, and makes the text."""

    def __init__(self) -> None:
        """Begin with no rows."""
        self._rows: list[Row] = []
        self._lead = Row(0, "")
        self._blank = False
        self._at_beginning = True
        self._last_code = 0

    def text(self) -> str:
        """Return the script."""
        return "".join(f"{_line(row)}\n" for row in self._rows)

    def add(self, rows: Iterable[Row]) -> int:
        """Add the rows of one statement or kept stretch, behind what leads it, and return the number of the first."""
        first, *others = rows
        if self._lead.code:
            first = Row(self._lead.indent, f"{self._lead.code} {first.code}", first.comment)
            self._lead = Row(0, "")
        self._add(first)
        for row in others:
            self._add(row)
        self._last_code = len(self._rows) - 1
        return len(self._rows) - 1 - len(others)

    def comment(self, indent: int, text: str, trails: bool) -> None:
        """Add a comment: behind the last row, or in a row of its own."""
        self.end_lead()
        if trails and self._rows:
            self._rows[-1].comment = text
        else:
            self._add(Row(indent, "", text))

    def comment_above(self, row: int, indent: int, text: str) -> None:
        """Add a comment in a row of its own before one that is there."""
        self._rows.insert(row, Row(indent, "", text))
        self._last_code += 1

    @property
    def last_code(self) -> int:
        """Return the number of the last row that is not a comment."""
        return self._last_code

    def separate(self) -> None:
        """Put a `;` behind the last statement."""
        self._rows[self._last_code].code += ";"

    def blank(self) -> None:
        """Put an empty line before the next row, unless a block begins there."""
        self._blank = not (self._at_beginning or self._lead.code)

    # --- blocks ---

    @property
    def lead(self) -> Row:
        """Return what will stand before the next statement, in its line."""
        return self._lead

    def lead_with(self, indent: int, text: str) -> None:
        """Put something before the next statement, in its line."""
        self._blank = False
        self._lead = Row(indent, text) if not self._lead.code else Row(self._lead.indent, f"{self._lead.code} {text}")

    def end_lead(self) -> None:
        """Put what leads nothing in a row of its own."""
        if self._lead.code:
            self._add(self._lead)
            self._last_code = len(self._rows) - 1
            self._lead = Row(0, "")

    def open(self, row: Row) -> int:
        """Add the row that begins a block, and return its number."""
        number = self.add([row])
        self._at_beginning = True
        return number

    def close(self, indent: int) -> None:
        """Add the brace that ends a block."""
        self.end_lead()
        self._blank = False
        self.add([Row(indent, "}")])

    def _add(self, row: Row) -> None:
        if self._blank:
            self._rows.append(Row(0, ""))
        self._blank = self._at_beginning = False
        self._rows.append(row)


def _line(row: Row) -> str:
    gap = "  " if row.code and row.comment else ""
    return f"{' ' * row.indent if row.code or row.comment else ''}{row.code}{gap}{row.comment}"
