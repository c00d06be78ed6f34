"""The look of the program's figures: type, colours, weights of lines, and a Matplotlib figure that keeps them."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

try:
    import matplotlib
    from cycler import cycler
    from matplotlib import font_manager, pyplot
    from matplotlib.figure import Figure
except ImportError as _error:
    raise ImportError("peristalsis.plot needs Matplotlib: pip install 'peristalsis[plot]'") from _error

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: Millimetres in an inch.
_INCH = 25.4
#: One column of a journal, and two [mm].
SINGLE_COLUMN, DOUBLE_COLUMN = 86.0, 178.0
#: Blue, vermillion, bluish green, orange, reddish purple, sky blue (Okabe & Ito).
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#E69F00", "#CC79A7", "#56B4E9")
ALONG, GREY = "#B2182B", "#808080"

#: The fonts of the command line's figures, which the package brings.
_FONTS = Path(__file__).parent / "fonts"


def _add_fonts(folder: Path) -> bool:
    """Makes the fonts of a folder known to Matplotlib; where it cannot, says so, for figures then look otherwise."""
    try:
        for style in ("Regular", "Italic"):
            font_manager.fontManager.addfont(folder / f"Arimo-{style}-subset.ttf")
    except (OSError, RuntimeError) as error:
        warnings.warn(
            f"figures are set in Matplotlib's own font, for the package is not whole: {error}; install it anew",
            RuntimeWarning,
            stacklevel=2,
        )
        return False
    return True


_HAS_FONT = _add_fonts(_FONTS)

#: Settings of symbols: the italic of the same family, as in the figures of the command line.
_SYMBOLS = {"mathtext.it": "Arimo:italic", "mathtext.bfit": "Arimo:italic"} | {
    f"mathtext.{kind}": "Arimo" for kind in ("rm", "bf", "sf", "tt", "cal")
}

#: Matplotlib settings of the program's figures. Those that `axes` makes have them by themselves; for your own figures
#: ``matplotlib.rcParams.update(STYLE)``.
STYLE: Any = {
    "font.family": ["Arimo", "DejaVu Sans"] if _HAS_FONT else ["sans-serif"],
    **(_SYMBOLS | {"mathtext.fontset": "custom"} if _HAS_FONT else {}),
    "font.size": 7.0,
    "axes.titlesize": 7.5,
    "axes.labelsize": 8.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "legend.fontsize": 6.8,
    "legend.frameon": False,
    "axes.linewidth": 0.55,
    "axes.prop_cycle": cycler(color=COLOURS),
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "xtick.major.size": 3.0,
    "ytick.major.size": 3.0,
    "xtick.minor.size": 1.6,
    "ytick.minor.size": 1.6,
    "xtick.major.width": 0.55,
    "ytick.major.width": 0.55,
    "xtick.minor.width": 0.55,
    "ytick.minor.width": 0.55,
    "xtick.minor.visible": True,
    "ytick.minor.visible": True,
    "lines.linewidth": 1.0,
    "lines.markersize": 3.5,
    "errorbar.capsize": 1.5,
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
    "figure.dpi": 160,
    "savefig.dpi": 300,
}


class StyledFigure(Figure):
    """A figure that is laid out, drawn and saved by the settings of `STYLE`, whatever they are outside.

    Matplotlib reads many settings as late as it draws: fonts of symbols, new ticks, dots per inch.
    """

    #: Heights that were added for what stands around the axes [inch].
    _rooms: dict[str, float]

    def make_room(self, name: str, height: float) -> None:
        """Makes the figure higher for something, in place of what was added for it before [inch]."""
        rooms = self.__dict__.setdefault("_rooms", {})
        more = height - rooms.get(name, 0.0)
        rooms[name] = height
        if more:
            self.set_size_inches(self.get_figwidth(), self.get_figheight() + more)

    def draw(self, renderer: Any) -> None:
        with matplotlib.rc_context(STYLE):
            super().draw(renderer)

    def get_tightbbox(self, *arguments: Any, **keywords: Any) -> Any:
        with matplotlib.rc_context(STYLE):
            return super().get_tightbbox(*arguments, **keywords)

    def savefig(self, *arguments: Any, **keywords: Any) -> None:
        with matplotlib.rc_context(STYLE):
            super().savefig(*arguments, **keywords)

    def set(self, **kwargs: Any) -> list[Any]:
        # Matplotlib gives a class without a `set` of its own one with other parameters than types know of.
        return super().set(**kwargs)


def axes(width: float = SINGLE_COLUMN, height: float = 60.0) -> Axes:
    """New axes in the style, in a figure of its own.

    Parameters
    ----------
    width, height : float
        Size of the figure [mm]; a legend that a function of this module puts below the axes adds to the height.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; ``axes.figure`` is their figure.

    Examples
    --------
    >>> from peristalsis import plot
    >>> plot.axes(86, 60).figure.get_size_inches().round(2).tolist()
    [3.39, 2.36]
    """
    # pyplot chooses its backend with its first figure, and settings made then are lost at the end of a context.
    figure = pyplot.figure(
        FigureClass=StyledFigure, figsize=(width / _INCH, height / _INCH), dpi=STYLE["figure.dpi"], layout="constrained"
    )
    with matplotlib.rc_context(STYLE):
        return figure.add_subplot()


@contextmanager
def drawing(ax: Axes | None, width: float = SINGLE_COLUMN, height: float = 60.0) -> Iterator[Axes]:
    """Axes to draw into: those given, in the settings of their owner, or new ones in the style."""
    target = axes(width, height) if ax is None else ax
    with matplotlib.rc_context(STYLE) if isinstance(target.figure, StyledFigure) else nullcontext():
        yield target
