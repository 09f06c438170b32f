"""Errors that the user can correct."""


class Problem(Exception):
    """Something that does not work as asked; the text says what, and the remedy. Operators show it
    as a report."""
