"""Settings of the operators, which the panel shows and the scene keeps."""

from dataclasses import dataclass

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty


class SurfaceSettings:
    """What counts as one surface. All operators have these."""

    open_seams: BoolProperty(
        name="Open Seams",
        description="Leave the surface open where borders lie on each other in all poses, as lips do"
        " that never part. Otherwise vertices that are doubled at seams stay together",
    )


class MetricSettings(SurfaceSettings):
    """What the metric costs beside its preset."""

    stiffness_group: StringProperty(
        name="Stiffness",
        description="Vertex group that is stiffer than the rest, or softer. Without, all is alike",
    )
    stiffness_factor: FloatProperty(
        name="Factor",
        description="By how much stretching and bending cost more where the group's weight is 1; less"
        " than 1 is softer. A weight between 0 and 1 counts as that power of the factor",
        default=100,
        min=1e-3,
        max=1e6,
    )
    custom_bending: BoolProperty(
        name="Custom Bending",
        description="Set the cost of bending. Otherwise it is the preset's, or for Deform and Repair"
        " what suits the mesh",
    )
    bending: FloatProperty(
        name="Bending",
        description="Cost of bending, relative to stretching. With more, bends are wider",
        default=7e-5,
        min=0,
        soft_max=1e-2,
        precision=6,
    )
    custom_volume: BoolProperty(
        name="Custom Volume",
        description="Set the cost of changing the enclosed volume. Otherwise it is the preset's, or"
        " for Deform and Repair what suits the mesh",
    )
    volume: FloatProperty(
        name="Volume",
        description="Cost of changing the enclosed volume, of closed meshes. At 30 Deform keeps it"
        " within .3 %",
        default=3,
        min=0,
        soft_max=30,
    )
    loose_components: BoolProperty(
        name="Loose Components",
        description="Leave parts loose that are not connected with the rest but stay near it in all"
        " poses, such as eyes and clothes. Otherwise they are tied to it",
    )


class ToleranceSettings:
    custom_tolerance: BoolProperty(
        name="Custom Tolerance",
        description="Set when a solve ends. Otherwise it ends where the tools' default is",
    )
    tolerance: FloatProperty(
        name="Tolerance",
        description="A solve ends when an iteration gains less than this share. With less, results"
        " are more exact and take longer",
        default=1e-5,
        min=1e-12,
        max=0.1,
        precision=7,
    )


class PoseSettings(MetricSettings):
    """What all operators on poses have in common."""

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
    allow_mirrored: BoolProperty(
        name="Allow Mirrored",
        description="Take poses that look like mirror images of the first as they are: domes that"
        " are pushed through, bodies that are turned inside out. Otherwise they are refused",
    )


class MotionSettings(PoseSettings, ToleranceSettings):
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
    custom_frames: BoolProperty(
        name="Custom Frames",
        description="Set the frame at which the motion begins, and the frames from one shape to the"
        " next. Otherwise the motion fills the scene's range of frames",
    )
    frame_start: IntProperty(
        name="Frame Start",
        description="With Custom Frames: frame at which the first pose is shown",
        default=1,
    )
    frame_step: IntProperty(
        name="Frame Step",
        description="With Custom Frames: frames from one shape to the next",
        default=1,
        min=1,
    )
    cache_folder: StringProperty(
        name="Folder",
        description="Where point caches are written; // is the folder of the .blend",
        default="//",
        subtype="DIR_PATH",
    )


class PlacementSettings:
    """Where the shapes of a motion are."""

    anchor_group: StringProperty(
        name="Anchor",
        description="Vertex group that stands still between poses that have it in one place. Else"
        " it moves rigidly from pose to pose. The shapes are moved as a whole for that",
    )
    ground: BoolProperty(
        name="Ground",
        description="Move each shape up or down so that its lowest vertex is at the given height. The"
        " poses are shown there too, as shape keys of their own",
    )
    ground_height: FloatProperty(
        name="Height",
        description="Height of the ground in the scene",
        unit="LENGTH",
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


class ContactSettings:
    avoid_contact: BoolProperty(
        name="Avoid Contact",
        description="Lead the body round itself where its parts would pass through each other. Takes"
        " several times as long where they do",
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


class BonesSettings(SurfaceSettings):
    auto_bones: BoolProperty(
        name="As Few As Needed",
        description="Take as few bones as the error needs. Otherwise, the given number",
    )
    bones: IntProperty(
        name="Bones",
        description="Number of bones. With more, the motion is met more closely",
        default=20,
        min=1,
        max=500,
    )
    bone_error: FloatProperty(
        name="Error",
        description="Permitted distance of vertices from their places (root mean square), in per cent"
        " of half the diagonal of the body",
        default=0.5,
        min=1e-3,
        soft_max=5,
        max=99,
        subtype="PERCENTAGE",
        precision=2,
    )
    bone_weights: IntProperty(
        name="Weights",
        description="Bones that may move one vertex. Many game engines take 4",
        default=4,
        min=1,
        max=8,
    )
    bone_scale: BoolProperty(
        name="Stretch",
        description="Bones may also be stretched, by bones of their own. The error is lower, but not"
        " every game engine plays it",
    )
    bone_step: IntProperty(
        name="Every",
        description="Frames from one shape that the bones are fitted to, to the next. With more, it is"
        " faster",
        default=1,
        min=1,
        soft_max=25,
    )


class DeformSettings(MetricSettings, ToleranceSettings):
    deform_shapes: IntProperty(
        name="Steps",
        description="Shapes on the way to the deformed one, itself included. They resolve how parts"
        " turn: at least one for every 90 degrees",
        default=5,
        min=1,
        soft_max=20,
    )
    balance: FloatProperty(
        name="Balance",
        description="Weight of the metric against soft handles. With more, they yield more",
        default=0.01,
        min=1e-6,
        max=1,
        precision=4,
    )


class RepairSettings(MetricSettings, ToleranceSettings):
    repair_balance: FloatProperty(
        name="Balance",
        description="With more, more of the sound geometry is restored, and less of the pose is kept",
        default=0.5,
        min=1e-6,
        max=1,
    )
    sound_group: StringProperty(
        name="Keep",
        description="Vertex group whose positions in the distorted pose are kept as far as possible."
        " Those of other vertices are ignored. Without, all are kept",
    )


class SHAPESPACE_settings(
    MotionSettings,
    PlacementSettings,
    SmoothSettings,
    ContactSettings,
    ExtrapolationSettings,
    TransferSettings,
    AverageSettings,
    BonesSettings,
    DeformSettings,
    RepairSettings,
    bpy.types.PropertyGroup,
):
    """All settings of a scene."""


@dataclass
class Timing:
    """The frame of a motion's first shape, and the frames from one shape to the next."""

    start: int
    step: float
