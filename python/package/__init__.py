"""Geodesics between poses of a mesh, and what follows from them.

Vertices are arrays, n x 3, one vertex a row; faces are integers, m x 3, counted from 0. Begin with
`read` and `interpolate`; "Python in five minutes" (docs/guide/python.md) shows the rest.
"""

from . import _core
from ._core import (
    Body,
    Cancelled,
    AverageSummary,
    CorrectionSummary,
    MismatchError,
    CorrespondenceStage,
    CorrespondenceSummary,
    DeformationLevel,
    DeformationSummary,
    Error,
    ExploreLevel,
    ExploreSummary,
    ExponentialStep,
    ExponentialSummary,
    FileError,
    GeodesicLevel,
    GeodesicSummary,
    Handle,
    HandleResult,
    Image,
    InvalidOptions,
    MarkerDoubt,
    MeshError,
    MeshWarning,
    Metric,
    Path,
    PathQuality,
    Poses,
    PoseTransferSummary,
    RepairSummary,
    ShapeError,
    ShapeModelSummary,
    SkinnedBody,
    SolverError,
    SplineSummary,
    StandingSummary,
    Space,
    SurfaceMap,
    SurfacePoints,
    TransferStep,
    TransferSummary,
    TransportStep,
    TransportSummary,
    __version__,
)
from ._functions import (
    AverageResult,
    Correspondence,
    CorrectionResult,
    Deformer,
    DeformationResult,
    ExploreResult,
    ExponentialResult,
    Finding,
    GeodesicResult,
    PoseTransferResult,
    RepairResult,
    SplineResult,
    StandingResult,
    TransferResult,
    TransportResult,
    average,
    body,
    check,
    compare_shapes,
    correct_path,
    correspond,
    deform,
    distance_matrix,
    explore,
    exponential,
    extrapolate,
    film_strip,
    interpolate,
    logarithm,
    read,
    read_handles,
    read_markers,
    repair,
    set_threads,
    spline,
    shoot,
    skinned_body,
    stand,
    threads,
    transfer,
    transfer_poses,
    transport,
    write,
)
from ._model import ShapeModel
from . import _metric
from ._options import (
    EmbeddingOptions,
    GeodesicOptions,
    GltfOptions,
    LadderOptions,
    MetricOptions,
)

__all__ = [name for name in dir() if not name.startswith("_")] + ["__version__"]

for _name in __all__:
    _thing = globals()[_name]
    if getattr(_thing, "__module__", "").startswith("shapespace._"):
        _thing.__module__ = "shapespace"
