"""The command lines of the tools, and the files that they read beside meshes."""

import json
import math
import os

from .problem import Problem
from .task import Deformation, Fit, Handle, Metric, Repair, Skinning, Task

NEEDED = ("shape-interpolate", "shape-extrapolate", "shape-transfer")
# Which older tools do not have.
OPTIONAL = (
    "shape-average", "shape-correspond", "shape-deform", "shape-export", "shape-statistics"
)  # fmt: skip
REPORT = "report.json"  # of the last command that wrote one
SOURCE = "source.path"  # the motion that is transferred

_STIFFNESS = "stiffness.txt"
_HANDLES = "handles.json"
_MARKERS = "markers.txt"
_FITTED = "fitted.ply"
_SKINNED = "skinned.glb"


def outputs(task) -> list:
    """The point caches that the commands write, or the mesh, or the skin."""
    if isinstance(task, Fit):
        return [_FITTED]
    if isinstance(task, Skinning):
        return [_SKINNED]
    return [f"motion{i}.pc2" for i in range(max(1, len(getattr(task, "targets", []))))]


def commands(task, poses: list, targets: list, programs: dict, folder: str) -> list:
    """What is to be run in a folder, in which the poses and targets are in files of these names.
    Raises a Problem if a tool is not there."""
    if isinstance(task, Fit):
        return [_fit(task, poses, targets, programs, folder)]
    if isinstance(task, Skinning):
        return [_skin(task, poses, programs)]
    metric = _metric_flags(task.metric, folder)
    if isinstance(task, Deformation):
        return [_deform(task, poses, programs, folder) + metric]
    if isinstance(task, Repair):
        return [_repair(task, poses, programs) + metric]
    if task.modes is not None:
        return [_average(task, poses, programs) + metric]
    if targets:
        return _transfer(task, poses, targets, programs, metric)
    return [_motion(task, poses, programs) + metric]


def _motion(task: Task, poses: list, programs: dict) -> list:
    name = "shape-extrapolate" if task.steps else "shape-interpolate"
    flags = ["--shapes", str(task.shapes), *_tolerance_flags(task)]
    if task.steps:
        flags += ["--steps", str(task.steps)]
    elif task.ends:
        flags += ["--spline", task.ends]
    if task.avoid_contact:
        flags += ["--avoid_contact"]
    if task.anchor is not None:
        flags += ["--anchor", json.dumps(_selection(task.anchor))]
    if task.ground is not None:
        flags += ["--ground", f"z={task.ground!r}"]
    return [programs[name], *poses, *_mirror_flags(task), *flags, *_results(0)]


def _transfer(task: Task, poses: list, targets: list, programs: dict, metric: list) -> list:
    found, source = [], [*poses, *_mirror_flags(task), *_tie_flags(task.metric)]
    if task.shapes:
        flags = ["--shapes", str(task.shapes), *_tolerance_flags(task), *metric]
        found.append([programs["shape-interpolate"], *source, *flags, "--output", SOURCE])
        source = [SOURCE]
    for i, target in enumerate(targets):
        seams = _seam_flags(task.metric.open_seams)
        found.append([programs["shape-transfer"], *source, "--target", target, *seams, *_results(i)])
    return found


def _average(task: Task, poses: list, programs: dict) -> list:
    program = _optional("shape-statistics" if task.modes else "shape-average", programs)
    how = ["--modes", str(task.modes)] if task.modes else ["--nocertify"]
    return [program, *poses, *_mirror_flags(task), *how, *_results(0)]


def _mirror_flags(task: Task) -> list:
    return ["--allow_mirrored"] if task.allow_mirrored else []


def _deform(task: Deformation, poses: list, programs: dict, folder: str) -> list:
    with open(os.path.join(folder, _HANDLES), "w", encoding="utf-8") as out:
        json.dump({"handles": [_handle(handle) for handle in task.handles]}, out)
    flags = ["--shapes", str(task.shapes), "--balance", repr(task.balance)]
    program = _optional("shape-deform", programs)
    return [
        program, *poses, "--handles", _HANDLES, *flags, *_tolerance_flags(task), *_results(0)
    ]  # fmt: skip


def _repair(task: Repair, poses: list, programs: dict) -> list:
    distorted, sound = poses
    flags = ["--balance", repr(task.balance)]
    if task.kept is not None:
        flags += ["--sound", json.dumps(_selection(task.kept))]
    program = _optional("shape-deform", programs)
    return [program, distorted, "--repair", sound, *flags, *_tolerance_flags(task), *_results(0)]


def _fit(task: Fit, poses: list, targets: list, programs: dict, folder: str) -> list:
    program = _optional("shape-correspond", programs)
    flags = ["--output", _FITTED, "--report", REPORT]
    if task.markers:
        with open(os.path.join(folder, _MARKERS), "w") as out:
            out.writelines(f"{first + 1} {second + 1}\n" for first, second in task.markers)
        flags += ["--markers", _MARKERS]
    if task.finds_markers:
        flags.append("--find_markers")
    return [program, *poses, *targets, *_seam_flags(task.open_seams), *flags]


def _skin(task: Skinning, poses: list, programs: dict) -> list:
    """Shape k is at the time k of the animation."""
    flags = ["--bones", str(task.bones or "auto"), "--bone_weights", str(task.weights)]
    if task.bones is None:
        flags += ["--bone_error", repr(task.error)]
    if task.scale:
        flags += ["--bone_scale"]
    flags += ["--allow_mirrored", *_seam_flags(task.open_seams), "--once", "--fps", "1"]
    return [_optional("shape-export", programs), *poses, *flags, "--output", _SKINNED]


def _results(i: int) -> list:
    return ["--output", f"motion{i}.pc2", "--report", REPORT]


def _optional(name: str, programs: dict) -> str:
    if programs[name] is None:
        raise Problem(f"{name} was not found where shape-interpolate is: build shapespace again")
    return programs[name]


def _metric_flags(metric: Metric, folder: str) -> list:
    flags = ["--metric", metric.preset] if metric.preset else []
    flags += _tie_flags(metric)
    for name in ("bending", "volume"):
        value = getattr(metric, name)
        if value is not None:
            flags += [f"--{name}", repr(value)]
    if metric.stiffness is not None:
        with open(os.path.join(folder, _STIFFNESS), "w") as out:
            out.writelines(f"{factor!r}\n" for factor in metric.stiffness.tolist())
        flags += ["--stiffness", _STIFFNESS]
    return flags + _seam_flags(metric.open_seams)


def _seam_flags(open_seams: bool) -> list:
    return ["--open_seams"] if open_seams else []


def _tie_flags(metric: Metric) -> list:
    return ["--loose_components"] if metric.loose_components else []


def _tolerance_flags(task) -> list:
    return [] if task.tolerance is None else ["--tolerance", repr(task.tolerance)]


def _handle(handle: Handle) -> dict:
    """One entry of a file of handles."""
    entry = {"name": handle.name, "select": _selection(handle.vertices)}
    motion = handle.motion
    if motion is None:
        entry["fixed"] = True
    else:
        entry["translation"] = motion.translation.tolist()
        if motion.angle != 0:
            entry["rotation"] = {
                "axis": motion.axis.tolist(),
                "degrees": math.degrees(motion.angle),
                "point": motion.point.tolist(),
            }
    if handle.weight is not None:
        entry["weight"] = handle.weight
    return entry


def _selection(vertices) -> dict:
    """Vertices in ascending order as the tools select them: counted from 1, and in ranges."""
    ranges = []
    for vertex in (vertices + 1).tolist():
        if ranges and ranges[-1][1] == vertex - 1:
            ranges[-1][1] = vertex
        else:
            ranges.append([vertex, vertex])
    return {"vertices": ranges}
