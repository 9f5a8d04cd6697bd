"""Desired motion of the feet in the thesis' walk, and human curves over the gait cycle; no bodies, no Drake."""
