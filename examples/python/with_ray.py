"""Replicas through Ray."""

import ray

import peristalsis
from replicas import CONFIGS, report

if __name__ == "__main__":
    ray.init(num_cpus=2, include_dashboard=False)
    replica = ray.remote(peristalsis.run)
    report(ray.get([replica.remote(config) for config in CONFIGS]))
    ray.shutdown()
