"""Tables and configurations as other libraries and as notebooks take them."""

from __future__ import annotations

import html
from collections.abc import Iterable
from dataclasses import fields, make_dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ._drive import CHANGEABLE

if TYPE_CHECKING:
    import pandas
    import polars
    import xarray

    from ._core import Configuration, Table

#: Rows of a table that a notebook shows, half of them from its end.
_SHOWN = 10
#: First columns along which all others run, each value once.
_ALONG = ("time", "position")


def reduced(table: Table) -> tuple[type[Table], tuple[Any, dict[str, str]]]:
    """How to make a table again: its class and the arguments."""
    units, descriptions = table.units, table.descriptions
    columns = [(name, units[name], descriptions[name], column) for name, column in table.items()]
    return type(table), (columns, table.metadata)


def rows(table: Table) -> np.ndarray[Any, np.dtype[np.object_]]:
    """The rows as objects with the columns as attributes; those of keys, such as ``drive.width``, by `getattr` alone."""
    names = table.column_names
    row = make_dataclass("Row", [f"column_{place}" for place in range(len(names))], init=False, repr=False, eq=False)
    for field, name in zip(fields(row), names, strict=True):
        field.name = name
    columns = [column if isinstance(column, list) else column.tolist() for column in table.values()]
    array = np.empty(len(table), dtype=object)
    array[:] = [row() for _ in range(len(table))]
    for made, *values in zip(array, *columns, strict=True):
        vars(made).update(zip(names, values, strict=True))
    return array


def to_pandas(table: Table) -> pandas.DataFrame:
    """As `Table.to_pandas`."""
    import pandas

    frame = pandas.DataFrame(table.to_dict(), columns=table.column_names)
    frame.attrs.update(units=table.units, descriptions=table.descriptions, metadata=table.metadata)
    return frame


def to_polars(table: Table) -> polars.DataFrame:
    """As `Table.to_polars`."""
    import polars

    return polars.DataFrame(table)


def to_xarray(table: Table) -> xarray.Dataset:
    """As `Table.to_xarray`."""
    import xarray

    units, meanings = table.units, table.descriptions
    first = table.column_names[0]
    is_along = first in _ALONG
    dimension = first if is_along else "row"
    variables = {
        name: (dimension, column, {"units": units[name], "long_name": meanings[name]})
        for name, column in table.items()
    }
    return xarray.Dataset(variables, attrs=table.metadata).set_coords([first] if is_along else [])


def _headings(table: Table) -> list[str]:
    return [f"{name} [{unit}]" if unit not in ("", "1") else name for name, unit in table.units.items()]


def text(table: Table) -> str:
    """A table in a line."""
    return f"<peristalsis.Table: {len(table)} rows of {', '.join(_headings(table))}>"


def html_text(table: Table) -> str:
    """A table for a notebook: its first and last rows, with the meanings of the columns as tool tips."""
    number = len(table)
    half = _SHOWN // 2
    shown = list(range(number)) if number <= _SHOWN else [*range(half), None, *range(number - half, number)]
    columns = table.values()
    tips = zip(_headings(table), table.descriptions.values(), strict=True)
    head = "".join(f"<th title='{html.escape(tip)}'>{html.escape(heading)}</th>" for heading, tip in tips)
    body = "".join(
        "<tr>" + "".join(f"<td>{'&hellip;' if row is None else _cell(column[row])}</td>" for column in columns) + "</tr>"
        for row in shown
    )
    return f"<table><caption>peristalsis.Table: {number} rows</caption><tr>{head}</tr>{body}</table>"


def _cell(value: Any) -> str:
    return html.escape(f"{value:.6g}" if isinstance(value, float) else str(value))


def facts_to_html(caption: str, facts: Iterable[tuple[str, str]]) -> str:
    """Names and facts as a table for a notebook."""
    rows = "".join(
        f"<tr><th style='text-align:left'>{html.escape(name)}</th>"
        f"<td style='text-align:left'>{html.escape(fact)}</td></tr>"
        for name, fact in facts
    )
    return f"<table><caption>{html.escape(caption)}</caption>{rows}</table>"


def configuration_reduced(configuration: Configuration) -> tuple[type[Configuration], tuple[None, None, str]]:
    """How to make a configuration again: its class and the arguments."""
    return type(configuration), (None, None, configuration.to_toml())


def configuration_text(configuration: Configuration) -> str:
    """A configuration in a line."""
    drive = configuration["drive"]
    driven = [f"{name} {drive[name]:g}" for name in CHANGEABLE if name in drive]
    doubts = [f"{len(configuration.warnings)} warnings"] if configuration.warnings else []
    grains = f"{configuration.grains} grains in {configuration.waves} waves"
    return f"<peristalsis.Configuration: {', '.join([grains, *driven, f'seed {configuration.seed}', *doubts])}>"


def configuration_html(configuration: Configuration) -> str:
    """A configuration for a notebook: every key with its value, and the warnings."""
    facts = [(key, str(value)) for key, value in configuration.items()]
    doubts = [(f"warning: {warning.key}", warning.message) for warning in configuration.warnings]
    return facts_to_html("peristalsis.Configuration", [*facts, *doubts])
