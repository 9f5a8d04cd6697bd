"""Motion-capture markers on anatomical landmarks.

The 39 markers of the Plug-in-Gait full-body model have its names (first letter R or L for the side). The medial markers
of knee, ankle and elbow, those on the heads of the first and fifth metatarsals and on the tip of the shoe are absent
from Plug-in-Gait; their names follow the same pattern. Positions are on the skin of the reference human
(`humanwalk.body.visuals`) or at the level of its joint centers; they scale with the segments.
"""

from dataclasses import dataclass, replace

from humanwalk.body.anatomy import human
from humanwalk.body.shapes import Vector3
from humanwalk.body.skeleton import Skeleton


@dataclass(frozen=True)
class Marker:
    """A point on a body.

    Attributes:
        name: Plug-in-Gait name, e.g. `RASI`, or one of the same pattern.
        body: Name of the segment.
        position: Position in the body frame, p_BoM_B [m].
        landmark: Anatomical landmark.
    """

    name: str
    body: str
    position: Vector3
    landmark: str

    def mirrored(self) -> "Marker":
        """Return the left counterpart of a right marker."""
        x, y, z = self.position
        return replace(self, name=f"L{self.name[1:]}", body=self.body.replace("Right", "Left"), position=(x, -y, z))

    def scaled(self, size: Vector3) -> "Marker":
        """Return the marker on a segment that is larger along x, y, z by three factors."""
        (x, y, z), (along_x, along_y, along_z) = self.position, size
        return replace(self, position=(x * along_x, y * along_y, z * along_z))


def markers(skeleton: Skeleton) -> tuple[Marker, ...]:
    """Return every marker of a body, from the head down, right before left."""
    paired = [side for marker in _right() for side in (marker, marker.mirrored())]
    return tuple(marker.scaled(_size(skeleton, marker)) for marker in (*paired, *_middle()))


def _size(skeleton: Skeleton, marker: Marker) -> Vector3:
    """Factors along x, y, z; the iliac spines keep the tilt of their plane, `humanwalk.body.pelvic_plane`."""
    along_x, along_y, along_z = skeleton.size(marker.body)
    return (along_x, along_y, along_x if marker.name[1:] in ("ASI", "PSI") else along_z)


def _middle() -> tuple[Marker, ...]:
    return (
        Marker("C7", "Thoracic_1_3", (-0.066, 0.0, 0.062), "spinous process of the 7th cervical vertebra"),
        Marker("T10", "Thoracic_10_12", (-0.110, 0.0, 0.020), "spinous process of the 10th thoracic vertebra"),
        Marker("CLAV", "Thoracic_1_3", (0.070, 0.0, 0.040), "jugular notch, where the clavicles meet the sternum"),
        Marker("STRN", "Ribs", (0.111, 0.0, -0.020), "xiphoid process of the sternum"),
        Marker("RBAK", "Ribs", (-0.100, -0.080, 0.080), "right shoulder blade; right only, to distinguish the sides"),
    )


def _right() -> tuple[Marker, ...]:
    reference = human()
    knee, ankle, elbow, wrist = (
        reference.joint(f"Right{name}Motion").origin for name in ("LegTibia", "LegAnkle", "ArmElbow", "ArmWrist")
    )
    thigh, shank, hind_foot = "RightLeg_Femur_Thigh", "RightLeg_Tibia", "RightLeg_Ankle"
    mid_foot, toes = "RightLeg_FootMiddle", "RightLeg_FootToes"
    upper_arm, forearm, hand = "RightArm_Humor_Upper_Arm", "RightArm_UlnaRadius_Forearm", "RightArm_Hand"
    return (
        Marker("RFHD", "Head", (0.070, -0.055, 0.048), "temple"),
        Marker("RBHD", "Head", (-0.054, -0.055, 0.048), "back of the head, level with the temple"),
        Marker("RSHO", "Scapula", (-0.004, -0.215, 0.035), "acromion"),
        Marker("RUPA", upper_arm, (0.004, -0.040, -0.150), "outer side of the upper arm"),
        Marker("RELB", upper_arm, _beside(elbow, y=-0.0385), "lateral epicondyle of the humerus"),
        Marker("RELM", upper_arm, _beside(elbow, y=0.0385), "medial epicondyle of the humerus"),
        Marker("RFRM", forearm, (0.001, -0.041, -0.075), "outer side of the forearm"),
        Marker("RWRA", forearm, _beside(wrist, x=0.028), "wrist, thumb side"),
        Marker("RWRB", forearm, _beside(wrist, x=-0.028), "wrist, little finger's side"),
        Marker("RFIN", hand, (0.027, -0.0072, -0.088), "back of the hand, head of the second metacarpal"),
        Marker("RASI", "Pelvis", (0.080, -0.105, 0.067), "anterior superior iliac spine"),
        Marker("RPSI", "Pelvis", (-0.105, -0.045, 0.103), "posterior superior iliac spine"),
        Marker("RTHI", thigh, (0.003, -0.059, -0.280), "outer side of the thigh, lower third"),
        Marker("RKNE", thigh, _beside(knee, y=-0.056), "lateral epicondyle of the femur"),
        Marker("RKNM", thigh, _beside(knee, y=0.056), "medial epicondyle of the femur"),
        Marker("RTIB", shank, (-0.005, -0.050, -0.210), "outer side of the shank"),
        Marker("RANK", shank, _beside(ankle, y=-0.036), "lateral malleolus"),
        Marker("RANM", shank, _beside(ankle, y=0.036), "medial malleolus"),
        Marker("RHEE", hind_foot, (-0.053, 0.0, -0.021), "back of the heel"),
        Marker("RTOE", mid_foot, (0.070, 0.0, 0.0105), "head of the second metatarsal"),
        Marker("RMT1", mid_foot, (0.070, 0.045, -0.012), "head of the first metatarsal"),
        Marker("RMT5", mid_foot, (0.060, -0.045, -0.012), "head of the fifth metatarsal"),
        Marker("RTIP", toes, (0.0595, 0.0, 0.0015), "tip of the shoe"),
    )


def _beside(point: Vector3, x: float = 0.0, y: float = 0.0) -> Vector3:
    return (point[0] + x, point[1] + y, point[2])
