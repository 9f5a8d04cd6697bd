"""The human as data: segments, skeleton, scaling to a subject, and model files."""

from humanwalk.body.anatomy import human
from humanwalk.body.contact import SOLE_SET, contact_spheres, sole_patches
from humanwalk.body.sdf import MODEL_NAME, to_sdf
from humanwalk.body.shapes import Box, Cylinder
from humanwalk.body.skeleton import REFERENCE_MASS, REFERENCE_STATURE, Joint, Segment, Skeleton, Weld
from humanwalk.sides import SIDES, Side

__all__ = [
    "MODEL_NAME",
    "REFERENCE_MASS",
    "REFERENCE_STATURE",
    "SIDES",
    "SOLE_SET",
    "Box",
    "Cylinder",
    "Joint",
    "Segment",
    "Side",
    "Skeleton",
    "Weld",
    "contact_spheres",
    "human",
    "sole_patches",
    "to_sdf",
]
