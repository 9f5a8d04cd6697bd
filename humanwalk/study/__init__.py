"""Studies: many runs of a scenario that differ in factors, simulated by worker processes into one table."""
