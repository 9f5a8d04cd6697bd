"""Recorded motion: joint angles read from files, as motion of the subject's body."""
