"""Tables go to pandas, polars, xarray and pickles, with their units."""

import copy
import pickle

import numpy as np
import pandas
import polars
import pyarrow
import pytest
import xarray

import peristalsis
from peristalsis import Simulation, Table


@pytest.fixture
def table(small: Simulation) -> Table:
    """Two periods of a small tube."""
    small.run(periods=2)
    return small.timeseries()


def test_any_pandas_takes_a_table(table: Table) -> None:
    frame = table.to_pandas()
    assert list(frame.columns) == table.column_names and len(frame) == len(table)
    assert frame.attrs["units"]["time"] == "t" and "J along the wave" in frame.attrs["descriptions"]["flow_rate"]
    assert "peristalsis.configuration" in frame.attrs["metadata"]
    for other in (pandas.DataFrame(table), pandas.DataFrame(dict(table))):
        assert other.equals(frame)
    assert frame["time"].dtype == np.float64


def test_polars_xarray_and_arrow_take_a_table(table: Table) -> None:
    assert table.to_polars().equals(polars.DataFrame(table))
    assert pyarrow.table(table).schema.field("time").metadata[b"unit"] == b"t"
    data = table.to_xarray()
    assert isinstance(data, xarray.Dataset) and data.sizes == {"time": len(table)}
    assert data["flow_rate"].attrs == {"units": "1/t", "long_name": table.descriptions["flow_rate"]}
    assert float(data["flow_rate"].sel(time=5.0)) == table["flow_rate"][9]


def test_columns_that_do_not_rise_are_no_dimension(small: Simulation) -> None:
    small.run(periods=3)
    assert small.waves().to_xarray().sizes == {"row": 6}


def test_a_table_is_read_as_a_frame_is(table: Table) -> None:
    assert list(table) == table.keys() == table.column_names == [name for name, _ in table.items()]
    assert all(np.array_equal(column, table[name]) for name, column in dict(table).items())
    assert len(table.values()) == len(table.to_dict()) == len(table.keys())
    assert len(table) == len(table["time"])


def test_a_table_is_pickled_and_copied(table: Table) -> None:
    for other in (pickle.loads(pickle.dumps(table)), copy.copy(table), copy.deepcopy(table)):
        assert other == table and isinstance(other, Table)
        assert (other.units, other.descriptions, other.metadata) == (table.units, table.descriptions, table.metadata)


def test_missing_numbers_and_texts_survive() -> None:
    columns = [
        ("name", "", "its name", ["one", "two"]),
        ("tau", "t", "its time", np.array([1.0, np.nan])),
        ("jammed", "", "whether it jammed", np.array([True, False])),
    ]
    table = Table(columns, {"by": "hand"})
    again = pickle.loads(pickle.dumps(table))
    assert again == table and again["name"] == ["one", "two"] and again["jammed"].tolist() == [True, False]
    assert table.to_polars()["tau"].null_count() == 1 and table.to_pandas()["tau"].isna().sum() == 1
    assert pandas.DataFrame(table).equals(table.to_pandas())
    with pytest.raises(TypeError, match="float64, int64 or bool"):
        Table([("x", "", "", [1, 2])])


def test_a_table_says_its_units_in_words_and_in_a_notebook(table: Table) -> None:
    assert repr(table).startswith("<peristalsis.Table: 40 rows of time [t], period, flow_rate [1/t]")
    shown = table._repr_html_()
    assert "time [t]" in shown and shown.count("<tr>") == 12 and "&hellip;" in shown


def test_the_rows_of_a_study_are_such_a_table(tmp_path: object) -> None:
    content = {"name": "widths", "preset": "frictionless", "replicates": 2, "base": {"tube.waves": 2, "run.periods": 2}}
    study = peristalsis.study(content, store=f"{tmp_path}/store")
    study.run(workers=1)
    rows = study.rows()
    assert isinstance(rows, Table) and pickle.loads(pickle.dumps(rows)) == rows
    frame = rows.to_pandas()
    assert len(frame) == 2 and frame.attrs["units"]["strain_rate"] == "1/t"
    assert pandas.DataFrame(rows).equals(frame) and rows.to_xarray()["strain_rate"].attrs["units"] == "1/t"
