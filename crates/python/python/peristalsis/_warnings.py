"""What looks doubtful about a run."""

from __future__ import annotations

from typing import NamedTuple


class KeyedWarning(NamedTuple):
    """A doubt about a configuration that can be computed but may not mean what was intended.

    Attributes
    ----------
    key : str
        The key to look at.
    message : str
        The consequence to expect, and what to change.

    Examples
    --------
    >>> import peristalsis
    >>> warning, = peristalsis.Configuration("frictionless", time_step=0.3).warnings
    >>> warning.key
    'run.time_step'
    """

    key: str
    message: str

    def __str__(self) -> str:
        return f"{self.key}: {self.message}"
