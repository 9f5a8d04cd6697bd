"""The application: simulates a scenario, then measures, stores, plots, replays, exports the run."""
