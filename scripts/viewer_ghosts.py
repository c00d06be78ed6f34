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
        flows = group.dropna(subset=["flow_rate_ratio"]).groupby(across)["flow_rate_ratio"]
        # Replicates that ended in two flows are on no branch, as in the analysis of the claims (`SPLIT`).
        is_one_flow = flows.apply(lambda flow: not (flow.sort_values().diff() > 0.2).any())
        means = flows.mean()[is_one_flow]
        points = [[float(f"{x:.6g}"), round(y, 3)] for x, y in means.items()]
        if len(points) > 2:
            yield {"strain_rate": rate, "start": start, "points": points}


walls = {"branches-coarse": "frictionless", "branches-12x16": "frictionless-source", "branches-fine": "frictionless-fine"}
ghosts = {wall: list(curves(name, "width", {})) for name, wall in walls.items()}
ghosts["frictional"] = list(curves("elastic-branches", "force_amplitude", {}))
ghosts["friction"] = list(curves("back-flow", "contact.kinetic_friction", {}))
target = ROOT / "viewer/source/ghosts.json"
target.write_text(json.dumps(ghosts, separators=(",", ":")) + "\n")
