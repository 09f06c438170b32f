"""Records which shape keys the add-on made, in a custom property of an object's shape keys."""

_NAME = "shapespace"


def in_betweens(shape_keys) -> list:
    """Names of the in-betweens."""
    return list(shape_keys.get(_NAME, {}).get("in_betweens", []))


def transferred(shape_keys) -> list:
    """Names of the poses that came from another body."""
    return list(shape_keys.get(_NAME, {}).get("transferred", []))


def write(shape_keys, in_betweens: list, transferred: list) -> None:
    shape_keys[_NAME] = {"in_betweens": in_betweens, "transferred": transferred}
