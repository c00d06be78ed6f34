"""How far a simulation is, as it runs."""

from __future__ import annotations

import logging
import sys
import time as clock
import warnings
from importlib import import_module
from types import TracebackType
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

if TYPE_CHECKING:
    from ._simulation import Simulation

#: What `Simulation.run` takes as `progress`.
Shown: TypeAlias = bool | Literal["logging"]

#: Seconds between two lines on standard error, and between two in a log.
_LINE, _LOG = 0.2, 10.0

_log = logging.getLogger("peristalsis")


class Progress:
    """A bar of tqdm where that is installed, a line on standard error, lines in the log ``peristalsis``, or nothing."""

    def __init__(self, simulation: Simulation, steps: int, shown: Shown, unit: str = "steps") -> None:
        if shown not in (True, False, "logging"):
            raise ValueError(f'progress is True, False or "logging", not {shown!r}')
        self._simulation = simulation
        self._steps = steps
        self._shown = shown
        self._bar = _bar(steps, unit) if shown is True else None
        self._begin = self._last = clock.monotonic()

    def __enter__(self) -> Progress:
        return self

    def update(self, done: int) -> None:
        """Shows that so many steps are done, if it is time to."""
        if not self._shown:
            return
        now = clock.monotonic()
        if now - self._last < (_LOG if self._shown == "logging" else _LINE) and done < self._steps:
            return
        self._last = now
        state = f"period {self._simulation.period:.1f}, J/Jmax {round(self._simulation.flow_rate_ratio, 3) + 0.0:.3f}"
        left = (now - self._begin) * (self._steps - done) / max(done, 1)
        if self._bar is not None:
            self._bar.set_postfix_str(state, refresh=False)
            self._bar.update(done - self._bar.n)
        elif self._shown == "logging":
            _log.info("%.0f%%, %s, %.0f s left", 100 * done / max(self._steps, 1), state, left)
        else:
            line = f"\r{done / max(self._steps, 1):4.0%}  {state}  {left:.0f} s left   "
            print(line, end="", file=sys.stderr, flush=True)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._bar is not None:
            self._bar.close()
        elif self._shown is True:
            print(file=sys.stderr)


def _bar(steps: int, unit: str) -> Any:
    """A bar of tqdm, or `None` where it is not installed."""
    try:
        with warnings.catch_warnings():
            # In a notebook without its widgets tqdm says so, and draws the bar as text.
            warnings.simplefilter("ignore")
            return import_module("tqdm.auto").tqdm(total=steps, unit=f" {unit}", unit_scale=True)
    except ImportError:
        return None
