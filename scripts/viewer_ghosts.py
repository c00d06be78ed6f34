#!/usr/bin/env python3
"""Writes viewer/source/ghosts.json, the published branches beside which the viewer draws a visitor's own loop, from
validation/results. Needs pandas and pyarrow; call it where those rows have changed, then scripts/viewer_bundle.sh."""

import json
from pathlib import Path

import pandas

ROOT = Path(__file__).resolve().parent.parent


def curves(name, across, fixed):
    """Means over replicates of J/Jmax against a column, a curve for each strain rate and start."""
    rows = pandas.read_parquet(ROOT / f"validation/results/{name}.parquet")
    for column, value in fixed.items():
        rows = rows[rows[column] == value]
    for (rate, start), group in rows.groupby(["strain_rate", "initial_state"]):
        means = group.groupby(across)["flow_rate_ratio"].mean().dropna()
        points = [[float(f"{x:.6g}"), round(y, 3)] for x, y in means.items()]
        if len(points) > 2:
            yield {"strain_rate": rate, "start": start, "points": points}


walls = {"branches-coarse": "12x14", "branches-12x16": "12x16", "branches-fine": "24x26"}
ghosts = {wall: list(curves(name, "width", {})) for name, wall in walls.items()}
ghosts["elastic"] = list(curves("elastic-branches", "force_amplitude", {}))
ghosts["friction"] = list(curves("back-flow", "contact.kinetic_friction", {}))
target = ROOT / "viewer/source/ghosts.json"
target.write_text(json.dumps(ghosts, separators=(",", ":")) + "\n")
