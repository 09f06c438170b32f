"""Runs the tests inside Blender, with the add-on as people install it: from a zip file.

blender -b --factory-startup --python-exit-code 1 --python blender/tests/run.py -- shapespace.zip

BLENDER_USER_SCRIPTS must name an empty folder, into which the add-on is installed.
"""

import pathlib
import sys
import unittest

import bpy

TESTS = pathlib.Path(__file__).parent
sys.path.insert(0, str(TESTS))
import support  # noqa: E402, F401: which knows where the Python module is

bpy.ops.preferences.addon_install(filepath=sys.argv[-1])
bpy.ops.preferences.addon_enable(module="shapespace_addon")

result = unittest.TextTestRunner(verbosity=2).run(unittest.defaultTestLoader.discover(str(TESTS)))
if not result.wasSuccessful():
    raise RuntimeError("tests failed")
