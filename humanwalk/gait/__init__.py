"""Where the feet should be and when: splines, the thesis' foot paths, arc length, phases, steps.

Knows nothing of bodies, control or Drake.
"""
