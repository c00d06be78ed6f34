"""Replicates through `concurrent.futures`; threads would do as well, for the engine lets go of the interpreter."""

from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import peristalsis
from replicates import CONFIGS, report

if __name__ == "__main__":
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        report(list(pool.map(peristalsis.run, CONFIGS)))
