"""What a metric costs, and when a solve ends, as settings say it."""

from . import vertex_groups
from .task import Metric


def metric_of(settings, preset: str, item, vertices) -> Metric:
    """`vertices` are those of the object's mesh that are computed with."""
    stiffness = None
    if settings.stiffness_group:
        weights = vertex_groups.weights(item, settings.stiffness_group, vertices, "is stiffer")
        stiffness = settings.stiffness_factor**weights
    return Metric(
        preset,
        settings.bending if settings.custom_bending else None,
        settings.volume if settings.custom_volume else None,
        stiffness,
        settings.loose_components,
        settings.open_seams,
    )


def tolerance_of(settings) -> float | None:
    return settings.tolerance if settings.custom_tolerance else None
