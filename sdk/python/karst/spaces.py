"""The spaces of an environment: Gymnasium's if it is installed, else the same three with the same names."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np

try:
    from gymnasium.spaces import Box, Dict, Discrete
except ImportError:

    class Box:
        """Arrays of a shape whose numbers lie between ``low`` and ``high``, both of that shape or one number."""

        def __init__(self, low: Any, high: Any, shape: tuple[int, ...] | None = None, dtype: Any = np.float32):
            self.dtype = np.dtype(dtype)
            self.shape = np.broadcast(low, high).shape if shape is None else tuple(shape)
            self.low = np.broadcast_to(np.asarray(low, self.dtype), self.shape)
            self.high = np.broadcast_to(np.asarray(high, self.dtype), self.shape)
            self._rng = np.random.default_rng()

        def seed(self, seed: int | None = None) -> None:
            self._rng = np.random.default_rng(seed)

        def sample(self) -> np.ndarray:
            low = np.where(np.isfinite(self.low), self.low, -1e3)
            high = np.where(np.isfinite(self.high), self.high, 1e3)
            return self._rng.uniform(low, high).astype(self.dtype)

        def contains(self, x: Any) -> bool:
            x = np.asarray(x)
            return x.shape == self.shape and bool(np.all(x >= self.low) and np.all(x <= self.high))

    class Discrete:
        """The numbers 0 to n - 1."""

        def __init__(self, n: int):
            self.n = n
            self._rng = np.random.default_rng()

        def seed(self, seed: int | None = None) -> None:
            self._rng = np.random.default_rng(seed)

        def sample(self, mask: np.ndarray | None = None) -> int:
            """One of those whose ``mask`` is 1."""
            numbers = np.arange(self.n) if mask is None else np.flatnonzero(mask)
            return int(self._rng.choice(numbers)) if len(numbers) else 0

        def contains(self, x: Any) -> bool:
            return isinstance(x, (int, np.integer)) and 0 <= x < self.n

    class Dict:
        """A dictionary with a space for each key."""

        def __init__(self, spaces: Mapping[str, Any]):
            self.spaces = dict(spaces)

        def __getitem__(self, key: str) -> Any:
            return self.spaces[key]

        def seed(self, seed: int | None = None) -> None:
            for i, space in enumerate(self.spaces.values()):
                space.seed(None if seed is None else seed + i)

        def sample(self) -> dict[str, Any]:
            return {key: space.sample() for key, space in self.spaces.items()}

        def contains(self, x: Any) -> bool:
            return isinstance(x, dict) and x.keys() == self.spaces.keys() and all(
                self.spaces[key].contains(value) for key, value in x.items()
            )


__all__ = ["Box", "Dict", "Discrete"]
