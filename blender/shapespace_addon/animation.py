"""Keyframes of the values of shape keys."""

from .problem import Problem


def curves_of(owner):
    """The F-curves of a data-block's animation, or an empty list."""
    animation = owner.animation_data
    if animation is None or animation.action is None:
        return []
    if not hasattr(animation, "action_slot"):  # Blender before 4.4
        return animation.action.fcurves
    slot = animation.action_slot
    if slot is None:
        return []
    for layer in animation.action.layers:
        for strip in layer.strips:
            bag = strip.channelbag(slot)
            if bag is not None:
                return bag.fcurves
    return []


def has_driver(key) -> bool:
    """Whether the value of a key is computed from something else."""
    animation = key.id_data.animation_data
    path = key.path_from_id("value")
    return animation is not None and any(driver.data_path == path for driver in animation.drivers)


def has_keyframes(key) -> bool:
    return _curve(key) is not None


def require_free(key) -> None:
    """Raises a Problem if keyframes cannot turn a key on and off."""
    if key.slider_min > 0 or key.slider_max < 1:
        raise Problem(
            f"The value of '{key.name}' cannot be 0 and 1: change Range Min and Range Max of this"
            " shape key"
        )


def remove_keyframes(key) -> bool:
    """Returns whether there were any."""
    curve = _curve(key)
    if curve is not None:
        curves_of(key.id_data).remove(curve)
    return curve is not None


def peak(key, index: int, count: int, start: int, step: float) -> None:
    """Keyframes with which a key is fully on at one of `count` moments and off at all others."""
    for at, value in ((index - 1, 0.0), (index, 1.0), (index + 1, 0.0)):
        if 0 <= at < count:
            key.value = value
            key.keyframe_insert("value", frame=start + at * step)
    for point in _curve(key).keyframe_points:
        point.interpolation = "LINEAR"


def _curve(key):
    """The F-curve of a key's value, or None."""
    curves = curves_of(key.id_data)
    return curves.find(key.path_from_id("value")) if curves else None
