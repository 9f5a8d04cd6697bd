"""Builders that wire systems: take a Scenario, return a Diagram with named, exported ports."""
