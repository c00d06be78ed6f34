"""A study's store as signac sees it: every run a job, with the state point that the run was made from.

Usage: read_store.py STORE ROWS.csv SCRATCH
"""

import csv
import json
import sys
from pathlib import Path

import signac


def main(store: Path, table: Path, scratch: Path) -> None:
    with table.open() as file:
        rows = {row["identity"]: row for row in csv.DictReader(line for line in file if not line.startswith("#"))}
    project = signac.init_project(scratch)
    imported = project.import_from(store / "runs")
    assert len(imported) == len(project) == len(rows) > 1, (len(imported), len(rows))
    widths = set()
    for folder, copy in imported.items():
        row = rows[Path(folder).name]
        job = project.open_job(id=Path(copy).name)
        assert job.sp.drive.width == float(row["drive.width"]), row
        assert job.sp.replicate == int(row["replicate"]), row
        assert job.sp.run.seed == int(row["seed"]), row
        assert "flow_rate_ratio" in json.loads(Path(job.fn("summary.json")).read_text())
        widths.add(job.sp.drive.width)
    for width in widths:
        found = project.find_jobs({"drive.width": width})
        assert len(found) == sum(float(row["drive.width"]) == width for row in rows.values())
    print(f"signac: {len(project)} jobs at {len(widths)} widths")


if __name__ == "__main__":
    main(*(Path(argument) for argument in sys.argv[1:]))
