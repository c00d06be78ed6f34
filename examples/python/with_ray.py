"""Replicates through Ray."""

import ray

import peristalsis
from replicates import CONFIGS, report

if __name__ == "__main__":
    ray.init(num_cpus=2, include_dashboard=False)
    replicate = ray.remote(peristalsis.run)
    report(ray.get([replicate.remote(config) for config in CONFIGS]))
    ray.shutdown()
