"""The walker's Drake systems, one LeafSystem a file: ports, state and events around the maths."""
