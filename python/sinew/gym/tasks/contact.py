"""Base of the tasks with friction."""

from __future__ import annotations

from typing import Any, Optional

from ..task import Range, Task, range_of

__all__ = ["ContactTask"]


class ContactTask(Task):
    """A task whose robot makes contact; Python generates its scene.

    Parameters
    ----------
    friction : float or (low, high), optional
        Coefficient of friction of all contacts, 0 to 2; a range is drawn from for each episode. By default the task's own.
    """

    default_friction = 0.5

    def __init__(self, *, friction: Optional[Range] = None, **options: Any) -> None:
        super().__init__(**options)
        self.friction = range_of("friction", self.default_friction if friction is None else friction, 0.0, 2.0, "")

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """Material, payload and friction."""
        return {**super().ranges, "friction": self.friction}
