"""Measures of a recorded walk: events, spatiotemporal measures, likeness to human gait."""
