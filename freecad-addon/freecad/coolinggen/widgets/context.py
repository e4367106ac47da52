"""What all widgets of a panel share: the design that they edit, and where each field is shown."""

from collections.abc import Callable
from typing import Any

from ..client import paths


class Context:
    """The design being edited. ``changed`` is called after each edit."""

    def __init__(self, design: dict, changed: Callable[[], None], examples: list[dict]):
        self.design = design
        self.examples = examples
        self._changed = changed
        self._shown: dict[paths.Path, Any] = {}

    def get(self, path: paths.Path, otherwise: Any = paths.MISSING) -> Any:
        """The design's value at a path."""
        return paths.get(self.design, path, otherwise)

    def put(self, path: paths.Path, value: Any) -> None:
        """Edits the design; MISSING removes what is there."""
        if self.get(path) != value:
            paths.put(self.design, path, value)
            self._changed()

    def show(self, path: paths.Path, widget: Any) -> None:
        """Remembers which widget shows a field: it has ``mark(message)`` and may have ``reveal(rest)``."""
        self._shown[path] = widget

    def forget(self, path: paths.Path) -> None:
        """What was shown at a path and below it is gone."""
        for known in [p for p in self._shown if p[: len(path)] == path]:
            del self._shown[known]

    def nearest(self, path: paths.Path) -> tuple[paths.Path, Any]:
        """The widget that shows a path, or what is nearest above it."""
        for length in range(len(path), 0, -1):
            if path[:length] in self._shown:
                return path[:length], self._shown[path[:length]]
        return (), None

    def unmark(self) -> None:
        """Takes all messages away."""
        for widget in self._shown.values():
            widget.mark("")
