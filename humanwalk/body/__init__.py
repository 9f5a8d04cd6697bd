"""The human as data: segment table, skeleton, scaling to a subject, and the model file."""

from humanwalk.body.anatomy import LEG_JOINTS, REFERENCE_MASS, REFERENCE_STATURE, human
from humanwalk.body.contact import HYDRO_SET, POINT_SET, contact_boxes, contact_spheres, sole_patches
from humanwalk.body.sdf import MODEL_NAME, to_sdf, write_sdf
from humanwalk.body.shapes import Box, Cylinder
from humanwalk.body.skeleton import SIDES, Joint, Segment, Side, Skeleton, Weld

__all__ = [
    "HYDRO_SET",
    "LEG_JOINTS",
    "MODEL_NAME",
    "POINT_SET",
    "REFERENCE_MASS",
    "REFERENCE_STATURE",
    "SIDES",
    "Box",
    "Cylinder",
    "Joint",
    "Segment",
    "Side",
    "Skeleton",
    "Weld",
    "contact_boxes",
    "contact_spheres",
    "human",
    "sole_patches",
    "to_sdf",
    "write_sdf",
]
