"""Settings of the operators, which the panel shows and the scene keeps."""

from dataclasses import dataclass

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty


class PoseSettings:
    """What all operators have in common."""

    metric: EnumProperty(
        name="Metric",
        description="What is kept as far as possible between the poses",
        items=[
            ("strain", "Strain", "Strains of triangles; such a motion can always be continued"),
            ("isometric", "Isometric", "Squared lengths of edges"),
            ("rigid", "Rigid", "The body as a whole moves rigidly as far as it can"),
            ("paper", "Paper", "Lengths of edges, weighted as in the paper of the method"),
        ],
    )
    use_basis: BoolProperty(
        name="Basis Is a Pose",
        description="The motion begins with the Basis. Otherwise it begins with the next shape key",
        default=True,
    )


class MotionSettings(PoseSettings):
    """What the operators that make motions have in common. The numbers are the tools' defaults."""

    shapes: IntProperty(
        name="Shapes",
        description="Shapes to insert between neighbouring poses",
        default=15,
        min=1,
        soft_max=100,
    )
    result: EnumProperty(
        name="Result",
        description="What is made of the motion",
        items=[
            ("KEYS", "Shape Keys", "Shape keys with keyframes"),
            ("CACHE", "Mesh Cache", "A point cache (.pc2), and a modifier that plays it"),
        ],
    )
    frame_start: IntProperty(
        name="Frame Start", description="Frame at which the first pose is shown", default=1
    )
    frame_step: IntProperty(
        name="Frame Step",
        description="Frames from one shape to the next",
        default=1,
        min=1,
    )
    cache_folder: StringProperty(
        name="Folder",
        description="Where point caches are written; // is the folder of the .blend",
        default="//",
        subtype="DIR_PATH",
    )


class SmoothSettings:
    smooth: BoolProperty(
        name="Smooth",
        description="Pass through the poses without changing the velocity suddenly. Needs three or"
        " more poses, or two with Cyclic",
    )
    cyclic: BoolProperty(
        name="Cyclic",
        description="With Smooth: go on from the last pose to the first, as a walk does",
    )


class ExtrapolationSettings:
    steps: IntProperty(
        name="Beyond",
        description="Shapes to add beyond the last pose",
        default=8,
        min=1,
        soft_max=100,
    )


class TransferSettings:
    poses_only: BoolProperty(
        name="Poses Only",
        description="Transfer the poses, without the shapes between them; much faster",
    )


class AverageSettings:
    modes: IntProperty(
        name="Modes",
        description="Shape keys of the average for the directions in which the poses vary most. At"
        " value 1 each is one standard deviation away from the average",
        default=0,
        min=0,
        soft_max=10,
    )


class SHAPESPACE_settings(
    MotionSettings,
    SmoothSettings,
    ExtrapolationSettings,
    TransferSettings,
    AverageSettings,
    bpy.types.PropertyGroup,
):
    """All settings of a scene."""


@dataclass
class Timing:
    """The frame of a motion's first shape, and the frames from one shape to the next."""

    start: int
    step: int
