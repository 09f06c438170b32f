"""Warnings at the line of the program that calls the package."""

import os
import sys
import warnings

_FOLDER = os.path.dirname(os.path.abspath(__file__))


def warn(message, category=UserWarning):
    """Warn, as of the innermost line that is not the package's own."""
    frame, level = sys._getframe(), 1
    while frame.f_back and os.path.dirname(os.path.abspath(frame.f_code.co_filename)) == _FOLDER:
        frame, level = frame.f_back, level + 1
    warnings.warn(message, category, stacklevel=level)
