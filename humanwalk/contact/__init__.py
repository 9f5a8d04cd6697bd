"""Contact of feet and ground, the asperity law and its implicit step, contact of the legs, ground reactions."""
