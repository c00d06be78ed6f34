"""Replicates through Dask; with the address of a scheduler, on its cluster."""

from dask.distributed import Client

import peristalsis
from replicates import CONFIGS, report

if __name__ == "__main__":
    with Client(n_workers=2, threads_per_worker=1, dashboard_address=None) as client:
        report(client.gather(client.map(peristalsis.run, CONFIGS, pure=False)))
