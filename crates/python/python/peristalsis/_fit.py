"""Titles and legends that fit into the figure in which they stand."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

# Before Matplotlib: it says what to install where that is missing.
from ._style import StyledFigure

from matplotlib import rcParams
from matplotlib.text import Text
from matplotlib.transforms import ScaledTranslation

if TYPE_CHECKING:
    from typing import Literal, TypeAlias

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.legend import Legend

    #: Settings of the size of type.
    _Setting: TypeAlias = Literal["axes.titlesize", "legend.fontsize"]

#: What an axis with its numbers and its name takes of a figure's width [inch].
_MARGIN = 0.6
#: What stands between two words of a label: blanks outside of mathematical text.
_WORD = re.compile(r"(?:\$[^$]*\$|[^\s$]|\$)+")
#: What a legend has beside a label, in sizes of its type.
_HANDLE = 4.0
#: Most columns of a legend.
_COLUMNS = 4
#: Distance of a legend from what is above it [inch].
_GAP = 0.03


def set_title(ax: Axes, text: str, separator: str) -> None:
    """A title, broken at separators where it is too wide; a figure of ours grows by the lines that are added."""
    room = _room(ax)
    height = _size(ax, text, "axes.titlesize")[1]
    lines = _broken(text.split(separator), separator, lambda line: _size(ax, line, "axes.titlesize")[0] <= room)
    title = "\n".join(lines)
    ax.set_title(title)
    if isinstance(ax.figure, StyledFigure):
        ax.figure.make_room("title", _size(ax, title, "axes.titlesize")[1] - height)


def set_legend(ax: Axes, handles: Sequence[Artist] | None = None, *, inside: bool = True) -> None:
    """A legend inside of the axes where it hides nothing, else below them; a figure of ours grows by it.

    In another figure it stays inside where there is little room for it below.
    """
    handles = ax.get_legend_handles_labels()[0] if handles is None else handles
    figure, before = ax.figure, ax.get_legend()
    layout = figure.get_layout_engine()
    if before is not None:
        before.remove()
    if isinstance(figure, StyledFigure):
        figure.make_room("legend", 0.0)
    if layout is not None:
        layout.execute(figure.canvas.figure)
    room = _room(ax) - _HANDLE * float(Text(fontsize=rcParams["legend.fontsize"]).get_fontsize()) / 72.0
    labels = [_label(ax, str(handle.get_label()), room) for handle in handles]
    # Without a layout nothing would make room for it below the axes.
    if layout is None or (inside and not _hides(ax, ax.legend(handles, labels, loc="best"))):
        _set_inside(ax, handles, labels)
        return
    low = ax.xaxis.get_tightbbox()
    gap = _GAP + ((ax.bbox.y0 - low.y0) / figure.dpi if low is not None else 0.0)
    place = ax.transAxes + ScaledTranslation(0.0, -gap, figure.dpi_scale_trans)
    for columns in range(min(_COLUMNS, len(handles)), 0, -1):
        legend = ax.legend(
            handles, labels, loc="upper center", bbox_to_anchor=(0.5, 0.0), bbox_transform=place, borderaxespad=0.0, ncols=columns
        )
        extent = legend.get_window_extent()
        if extent.width / figure.dpi <= _room(ax):
            break
    if isinstance(figure, StyledFigure):
        if figure.axes == [ax]:
            figure.make_room("legend", extent.height / figure.dpi + _GAP)
    elif extent.height > 0.5 * ax.bbox.height:
        _set_inside(ax, handles, labels)


def _set_inside(ax: Axes, handles: Sequence[Artist], labels: Sequence[str]) -> None:
    """A legend inside of the axes, with the fewest columns with which it is no higher than they are."""
    for columns in range(1, _COLUMNS + 1):
        if ax.legend(handles, labels, loc="best", ncols=columns).get_window_extent().height <= ax.bbox.height:
            break


def _room(ax: Axes) -> float:
    """Width that a title or a legend may have [inch]."""
    if isinstance(ax.figure, StyledFigure):
        return float(ax.figure.get_figwidth()) - _MARGIN
    names = ax.yaxis.get_tightbbox()
    return float((ax.bbox.width + (names.width if names is not None else 0.0)) / ax.figure.dpi)


def _size(ax: Axes, text: str, setting: _Setting) -> tuple[float, float]:
    """Width and height of a text in the size of a setting [inch]."""
    drawn = Text(text=text, fontsize=rcParams[setting], linespacing=1.2)
    drawn.set_figure(ax.figure)
    extent = drawn.get_window_extent()
    return extent.width / ax.figure.dpi, extent.height / ax.figure.dpi


def _label(ax: Axes, text: str, room: float) -> str:
    """A label in lines that are no wider than the room, broken between words, or within those that are wider."""

    def fits(line: str) -> bool:
        return _size(ax, line, "legend.fontsize")[0] <= room

    if all(map(fits, text.splitlines())):
        return text
    return "\n".join(_broken([part for word in _WORD.findall(text) for part in _parts(word, fits)], " ", fits))


def _parts(word: str, fits: Callable[[str], bool]) -> list[str]:
    """A word in parts that fit, unless it is mathematical text."""
    parts = [""]
    for letter in word if "$" not in word and not fits(word) else [word]:
        if parts[-1] and not fits(parts[-1] + letter):
            parts.append("")
        parts[-1] += letter
    return parts


def _broken(parts: Sequence[str], separator: str, fits: Callable[[str], bool]) -> list[str]:
    """Parts joined into lines, each as long as it fits."""
    lines = [parts[0]]
    for part in parts[1:]:
        longer = f"{lines[-1]}{separator}{part}"
        if fits(longer):
            lines[-1] = longer
        else:
            lines.append(part)
    return lines


def _hides(ax: Axes, legend: Legend) -> bool:
    """Whether a legend lies over what the axes show."""
    box = legend.get_window_extent()
    for line in ax.lines:
        path = line.get_transform().transform_path(line.get_path())
        is_drawn = line.get_linestyle() != "None"
        if box.count_contains(path.vertices) or (is_drawn and path.intersects_bbox(box, filled=False)):
            return True
    for collection in ax.collections:
        paths = map(collection.get_transform().transform_path, collection.get_paths())
        if any(path.intersects_bbox(box, filled=True) for path in paths):
            return True
    return False
