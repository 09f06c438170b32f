"""Records which shape keys the add-on made, in a custom property of an object's shape keys."""

_NAME = "shapespace"


def in_betweens(shape_keys) -> list:
    """Names of the in-betweens."""
    return made(shape_keys, "in_betweens")


def transferred(shape_keys) -> list:
    """Names of the poses that came from another body."""
    return made(shape_keys, "transferred")


def made(shape_keys, kind: str) -> list:
    """Names of the keys of one kind."""
    return list(shape_keys.get(_NAME, {}).get(kind, []))


def write(shape_keys, **names: list) -> None:
    """Records the names of the kinds that are given; those of other kinds stay."""
    before = shape_keys.get(_NAME)
    shape_keys[_NAME] = {**(before.to_dict() if before is not None else {}), **names}
