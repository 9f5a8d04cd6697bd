"""A full-body human that walks: 44 bodies and 42 revolute joints, simulated with Drake.

A Subject is whose body it is, a Scenario what happens to it, a Diagram the systems wired together,
a Run what came out. Units are SI and radians; frames and quantities are written in Drake's monogram
notation (p_WC, X_PF, V_WF).
"""

from importlib.metadata import version

__version__ = version("humanwalk")
