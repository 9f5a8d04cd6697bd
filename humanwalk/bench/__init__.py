"""Cost of a simulation: time of its parts, memory and start-up, as medians over interleaved repeats."""

from humanwalk.bench.measure import bench
from humanwalk.bench.result import BenchResult, ScenarioCost, read_result, write_result

__all__ = ["BenchResult", "ScenarioCost", "bench", "read_result", "write_result"]
