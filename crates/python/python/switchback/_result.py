"""What every verb gives: the program's JSON object, its words, and the files of its report."""

from __future__ import annotations

import json
import os
from functools import cached_property
from html import escape
from pathlib import Path
from typing import Any, Union

from ._native import Answer

PathLike = Union[str, "os.PathLike[str]"]


class Result:
    """What a verb found.

    Can be pickled, copied and shared between threads; two results are equal where their JSON is.
    """

    def __init__(self, answer: Answer) -> None:
        self._answer = answer

    @cached_property
    def _json(self) -> str:
        return self._answer.json

    @cached_property
    def _data(self) -> dict[str, Any]:
        found: dict[str, Any] = json.loads(self._json)
        return found

    @cached_property
    def _texts(self) -> dict[str, str]:
        return self._answer.texts

    @cached_property
    def _files(self) -> dict[str, bytes]:
        return self._answer.files()

    def to_json(self) -> str:
        """The object that the command line prints with ``--json``, to the last byte."""
        return self._json

    def to_dict(self) -> dict[str, Any]:
        """The same object as dictionaries, lists and numbers; a copy."""
        found: dict[str, Any] = json.loads(self._json)
        return found

    @cached_property
    def words(self) -> str:
        """What the command line prints without ``--json``."""
        return self._answer.words

    def files(self) -> dict[str, bytes]:
        """The files that the command line writes with ``--out``, by their names."""
        return dict(self._files)

    def save(self, folder: PathLike, *, force: bool = False) -> Path:
        """Writes these files into a folder, which is made where there is none: all of them, or none.

        Raises ``SwitchbackError`` if the folder cannot be written or holds files of others by these names, unless ``force``.
        """
        self._answer.save(os.fspath(folder), force)
        return Path(folder)

    def __str__(self) -> str:
        return self.words

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and self._json == other._json

    def __hash__(self) -> int:
        return hash(self._json)

    def __getstate__(self) -> dict[str, Any]:
        # What was made of the answer can be made again.
        return {"_answer": self._answer}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)

    def _repr_html_(self) -> str:
        page = self._files.get("index.html")
        if page is not None:
            return framed(page.decode())
        figures = (data.decode() for name, data in self._files.items() if name.endswith(".svg"))
        return f"<pre>{escape(self.words)}</pre>" + "".join(f"<div>{svg}</div>" for svg in figures)


#: A notebook shows pages in a frame of this height, pixels; they scroll.
_HEIGHT = 640


def framed(page: str) -> str:
    """A page in a frame, so that its styles stay its own."""
    return f'<iframe srcdoc="{escape(page)}" width="100%" height="{_HEIGHT}" style="border: 0" sandbox="allow-scripts"></iframe>'

