"""Cost of a simulation: time of its parts, memory and start-up, as medians over interleaved repeats."""
