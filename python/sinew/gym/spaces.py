"""Spaces of observations and actions, and the base classes of environments.

If `gymnasium` is installed, they are Gymnasium's own. Otherwise they are the classes below, which have those attributes of
Gymnasium's classes that environments and learners use.
"""

from __future__ import annotations

import enum
from typing import Any, Optional, Sequence, Union

import numpy as np

from ..errors import Error

try:
    import gymnasium
except ImportError:
    gymnasium = None

__all__ = ["AutoresetMode", "Box", "Space", "batched", "gymnasium"]


class PlainSpace:
    """A set of arrays of one shape and type.

    Parameters
    ----------
    shape : tuple of int
    dtype : NumPy type
    seed : int, optional
        Seed of `sample`; by default from the operating system.
    """

    def __init__(self, shape: Sequence[int], dtype: Any, seed: Optional[int] = None) -> None:
        self._shape, self.dtype = tuple(int(n) for n in shape), np.dtype(dtype)
        self._np_random = np.random.default_rng(seed)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of every array of the space."""
        return self._shape

    @property
    def np_random(self) -> np.random.Generator:
        """Random generator of `sample`."""
        return self._np_random

    def seed(self, seed: Optional[int] = None) -> int:
        """Seeds the generator of `sample`.

        Parameters
        ----------
        seed : int, optional
            Not negative; by default from the operating system.

        Returns
        -------
        int
            The seed that was used.
        """
        sequence = np.random.SeedSequence(seed)
        self._np_random = np.random.Generator(np.random.PCG64(sequence))
        return sequence.entropy

    def contains(self, x: Any) -> bool:
        """Whether x belongs to the space."""
        raise NotImplementedError

    def __contains__(self, x: Any) -> bool:
        return self.contains(x)


class PlainBox(PlainSpace):
    """Arrays between two bounds, each of which may be infinite.

    Parameters
    ----------
    low, high : float or array
        Bounds; a number applies to the whole array.
    shape : tuple of int, optional
        By default the shape of `low` and `high`.
    dtype : NumPy type
    seed : int, optional
        Seed of `sample`; by default from the operating system.

    Raises
    ------
    Error
        out-of-range if `low` exceeds `high` or is NaN; wrong-shape if bounds and `shape` do not match.
    """

    def __init__(
        self, low: Any, high: Any, shape: Optional[Sequence[int]] = None, dtype: Any = np.float32, seed: Optional[int] = None
    ) -> None:
        try:
            shape = np.broadcast_shapes(np.shape(low), np.shape(high)) if shape is None else tuple(shape)
            low, high = (np.broadcast_to(np.asarray(bound, dtype=dtype), shape).copy() for bound in (low, high))
        except ValueError:
            raise Error("wrong-shape", "Box", f"bounds of shapes {np.shape(low)} and {np.shape(high)} do not fit shape {shape}",
                        "give numbers or arrays of one shape") from None
        if not np.all(low <= high):
            raise Error("out-of-range", "Box", f"low {low} is not below high {high}", "give low <= high, without NaN")
        super().__init__(shape, dtype, seed)
        self.low, self.high = low, high
        self.bounded_below, self.bounded_above = np.isfinite(low), np.isfinite(high)

    def is_bounded(self, manner: str = "both") -> bool:
        """Whether the bounds are finite: "below", "above" or "both"."""
        below, above = bool(self.bounded_below.all()), bool(self.bounded_above.all())
        if manner not in ("below", "above", "both"):
            raise Error("unknown-name", "Box.is_bounded", f"{manner!r} is not valid", "give below, above or both")
        return {"below": below, "above": above, "both": below and above}[manner]

    def sample(self, mask: None = None) -> np.ndarray:
        """A random array: uniform between two bounds, exponential from one bound, normal without bounds."""
        if mask is not None:
            raise Error("out-of-range", "Box.sample", f"a Box has no mask, and {mask!r} was given", "leave it out")
        below, above, random = self.bounded_below, self.bounded_above, self._np_random
        drawn = np.empty(self.shape)
        for chosen, draw in (
            (below & above, lambda at: random.uniform(self.low[at], self.high[at])),
            (below & ~above, lambda at: self.low[at] + random.exponential(size=np.count_nonzero(at))),
            (~below & above, lambda at: self.high[at] - random.exponential(size=np.count_nonzero(at))),
            (~below & ~above, lambda at: random.normal(size=np.count_nonzero(at))),
        ):
            drawn[chosen] = draw(chosen)
        return drawn.astype(self.dtype)

    def contains(self, x: Any) -> bool:
        """Whether x is an array of this shape, within the bounds, of a type that can be cast safely to that of the space."""
        x = np.asarray(x)
        if not np.can_cast(x.dtype, self.dtype) or x.shape != self.shape:
            return False
        return bool(np.all(x >= self.low) and np.all(x <= self.high))

    def __eq__(self, other: object) -> bool:
        return (isinstance(other, PlainBox) and self.shape == other.shape and self.dtype == other.dtype
                and np.array_equal(self.low, other.low) and np.array_equal(self.high, other.high))  # fmt: skip

    def __repr__(self) -> str:
        return f"Box({self.low.min(initial=np.inf)}, {self.high.max(initial=-np.inf)}, {self.shape}, {self.dtype})"


class PlainAutoresetMode(enum.Enum):
    """Treatment of an environment whose episode has ended."""

    NEXT_STEP = "NextStep"
    SAME_STEP = "SameStep"
    DISABLED = "Disabled"


class PlainEnv:
    """Attributes of Gymnasium's environments in addition to their methods."""

    metadata: dict[str, Any] = {"render_modes": []}
    render_mode: Optional[str] = None
    spec: Any = None

    @property
    def unwrapped(self) -> Any:
        """The environment itself."""
        return self

    def close(self) -> None:
        """Closes the environment."""

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *raised: Any) -> bool:
        self.close()
        return False


if gymnasium is None:
    Space, Box, AutoresetMode, EnvBase, VectorEnvBase = PlainSpace, PlainBox, PlainAutoresetMode, PlainEnv, PlainEnv
else:
    Space, Box, AutoresetMode = gymnasium.spaces.Space, gymnasium.spaces.Box, gymnasium.vector.AutoresetMode
    EnvBase, VectorEnvBase = gymnasium.Env, gymnasium.vector.VectorEnv


def batched(space: Any, count: int) -> Any:
    """The Box of `count` arrays of a Box, stacked along a new first axis."""
    low, high = (np.repeat(bound[None], count, axis=0) for bound in (space.low, space.high))
    return Box(low=low, high=high, dtype=space.dtype)


def mode_named(mode: Union[str, Any]) -> Any:
    """The autoreset mode for a name such as "NEXT_STEP" or "NextStep", or the mode itself.

    Raises
    ------
    Error
        unknown-name.
    """
    for known in AutoresetMode:
        if mode is known or (isinstance(mode, str) and mode in (known.name, known.value)):
            return known
    names = ", ".join(known.name for known in AutoresetMode)
    raise Error("unknown-name", "autoreset_mode", f"{mode!r} is not an autoreset mode", f"give one of {names}")
