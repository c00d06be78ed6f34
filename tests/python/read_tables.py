"""Reads the tables of runs with pyarrow, as a user would, and asserts what they promise.

    python tests/python/read_tables.py RUN [RUN ...]

Each RUN is a folder that `peristalsis run --csv` has written. Asserted: names, types, units and descriptions of the
columns; missing values as null, in both formats in the same places; the same numbers in Parquet and CSV, bit for bit;
what the rows must satisfy among themselves and with summary.json and config.toml.
"""

import csv
import json
import math
import struct
import sys
import tomllib
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as parquet

UNITS = {
    "timeseries": {
        "time": "t",
        "period": "1",
        "flow_rate": "1/t",
        "flow_rate_ratio": "1",
        "flow_rate_raw": "1/t",
        "flow_rate_ratio_raw": "1",
        "kinetic_energy": "m d^2/t^2",
        "granular_temperature": "m d^2/t^2",
        "contacts": "1",
        "largest_overlap": "d",
        "escaped": "1",
        "wall_axial_force": "m d/t^2",
        "wall_power": "m d^2/t^3",
        "dissipated_power": "m d^2/t^3",
        "energy_residual": "1",
    },
    "profile": {
        "position": "1",
        "density": "1/d",
        "density_error": "1/d",
        "axial_velocity": "d/t",
        "axial_velocity_error": "d/t",
        "granular_temperature": "m d^2/t^2",
        "granular_temperature_error": "m d^2/t^2",
        "radius": "d",
        "least_radius": "d",
        "largest_radius": "d",
    },
}


def read(path: Path) -> tuple[pa.Table, dict]:
    """A table and what its metadata say of its columns, after checks that hold for every table."""
    table = parquet.read_table(path)
    metadata = {key.decode(): value.decode() for key, value in table.schema.metadata.items()}
    columns = json.loads(metadata["peristalsis.columns"])
    assert set(columns) == set(table.column_names), "the metadata describe every column and no other"
    for name, unit in UNITS[path.stem].items():
        assert columns[name]["unit"] == unit, f"{name}: {columns[name]['unit']}, not {unit}"
    for name, column in columns.items():
        assert column["unit"] and column["description"], name
    for field in table.schema:
        assert field.type == pa.float64(), f"{field.name} is {field.type}"
    for name in table.column_names:
        for value in table.column(name).to_pylist():
            assert value is None or math.isfinite(value), f"{name}: {value} where a missing value is null"
    configuration = tomllib.loads((path.parent / "config.toml").read_text())
    assert tomllib.loads(metadata["peristalsis.configuration"]) == configuration
    summary = json.loads((path.parent / "summary.json").read_text())
    assert metadata["peristalsis.version"] == summary["version"]
    assert metadata["peristalsis.revision"] == summary["revision"]
    return table, columns


def bits(value: float | None) -> bytes | None:
    return None if value is None else struct.pack("<d", value)


def same_as_csv(table: pa.Table, path: Path) -> None:
    with path.open(newline="") as file:
        header, *rows = csv.reader(file)
    assert header == table.column_names
    assert len(rows) == table.num_rows
    for index, name in enumerate(header):
        written = [None if row[index] == "" else float(row[index]) for row in rows]
        for line, (one, other) in enumerate(zip(table.column(name).to_pylist(), written, strict=True)):
            assert bits(one) == bits(other), f"{name}, row {line}: {one} in Parquet, {other} in CSV"


def check(run: Path) -> str:
    table, _ = read(run / "timeseries.parquet")
    same_as_csv(table, run / "timeseries.csv")
    profile, _ = read(run / "profile.parquet")

    summary = json.loads((run / "summary.json").read_text())
    configuration = tomllib.loads((run / "config.toml").read_text())
    series = {name: table.column(name).to_pylist() for name in table.column_names}
    times = series["time"]
    assert times == sorted(times) and len(set(times)) == len(times)
    assert math.isclose(times[-1], summary["time"], rel_tol=1e-12)
    assert max(series["escaped"]) == summary["escaped_most"]
    assert all(inside + out == summary["grains"] for inside, out in zip(series["inside"], series["escaped"], strict=True))

    late = max(1, round(configuration["observe"]["late_fraction"] * len(times)))
    mean = sum(series["flow_rate"][-late:]) / late
    assert math.isclose(mean, summary["flow_rate"], rel_tol=1e-9, abs_tol=1e-15)
    if summary["flow_rate_ratio"] is not None:
        ratios = series["flow_rate_ratio"][-late:]
        assert math.isclose(sum(ratios) / late, summary["flow_rate_ratio"], rel_tol=1e-9, abs_tol=1e-12)

    elastic = configuration["drive"]["control"] == "stress"
    frictional = configuration["contact"]["static_friction"] > 0
    assert ("drive_work" in series) == elastic
    assert ("sliding_fraction" in series) == frictional

    bins = configuration["observe"]["profile_bins"]
    assert profile.num_rows == bins
    for index, place in enumerate(profile.column("position").to_pylist()):
        assert math.isclose(place, (index + 0.5) / bins, abs_tol=1e-12)
    density = profile.column("density").to_pylist()
    wavelength = configuration["tube"]["wavelength"]
    waves = configuration["tube"]["waves"]
    grains = sum(density) / bins * wavelength * waves
    # The profile holds the grains inside the tube, of which some may leave on the way.
    fewest, most = min(series["inside"]), max(series["inside"])
    assert fewest - 1e-6 <= grains <= most + 1e-6, f"the profile holds {grains} grains"
    nulls = sum(part.column(name).null_count for part in (table, profile) for name in part.column_names)
    return f"{run}: {table.num_rows} rows of {table.num_columns} columns, {nulls} missing values"


def main() -> None:
    runs = [Path(argument) for argument in sys.argv[1:]]
    if not runs:
        sys.exit(__doc__)
    for run in runs:
        print(check(run))


if __name__ == "__main__":
    main()
