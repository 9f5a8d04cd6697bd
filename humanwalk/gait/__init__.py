"""Desired motion of the feet in the thesis' walk: splines, foot paths, arc length, phases; no bodies, no Drake."""
