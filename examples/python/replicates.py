"""What all examples run: one width, several seeds."""

from statistics import mean

CONFIGS = [{"preset": "frictionless", "width": 2.6, "waves": 2, "run.periods": 10, "seed": seed} for seed in range(8)]


def report(summaries: list[dict]) -> None:
    ratios = [summary["flow_rate_ratio"] for summary in summaries]
    print(f"J/Jmax of {len(ratios)} replicates: {mean(ratios):.12f}")
