"""What looks doubtful about a run."""

from __future__ import annotations

import re
import sys
import warnings
from collections.abc import Iterable
from types import TracebackType
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from ._simulation import Simulation

#: A number in a message.
_NUMBER = re.compile(r"[-+.\de]*\d[-+.\de]*")


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


class PeristalsisWarning(UserWarning):
    """A doubt about a simulation: its settings, or what was seen of it, such as a leak or overlaps of no solid grain. Also
    that runs of a study failed.

    `Simulation.warnings` has the list of a simulation. ``warnings.simplefilter("ignore", peristalsis.PeristalsisWarning)``
    silences all.

    Examples
    --------
    >>> import warnings
    >>> import peristalsis
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     sim = peristalsis.Simulation.preset("frictionless", waves=2, strain_rate=0.1)
    >>> caught[0].category.__name__, sim.warnings[0].key
    ('PeristalsisWarning', 'tube.rings_per_wave')
    """


def kind(doubt: KeyedWarning) -> str:
    """What a doubt is about, whatever its numbers are."""
    return f"{doubt.key} {_NUMBER.sub('', doubt.message)}"


def tell(doubts: Iterable[KeyedWarning], told: set[str]) -> None:
    """Warns of each doubt that has not been told."""
    for doubt in doubts:
        if kind(doubt) not in told:
            told.add(kind(doubt))
            warnings.warn(str(doubt), PeristalsisWarning, stacklevel=outside())


class Telling:
    """Tells the doubts of a simulation at the end of what is done with it, by an exception too."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation

    def __enter__(self) -> None:
        pass

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            tell(self._simulation.warnings, self._simulation._told)
        except PeristalsisWarning:
            # Where warnings are made errors, an earlier one goes first.
            if error is None:
                raise


def outside() -> int:
    """How many calls above `warnings.warn` the caller of the package is."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__package__") == __package__:
        level, frame = level + 1, frame.f_back
    return level
