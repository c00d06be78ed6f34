"""Replicates through joblib."""

from joblib import Parallel, delayed

import peristalsis
from replicates import CONFIGS, report

if __name__ == "__main__":
    report(Parallel(n_jobs=2)(delayed(peristalsis.run)(config) for config in CONFIGS))
