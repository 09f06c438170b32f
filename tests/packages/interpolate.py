"""A path between two poses, and whether it is one: what tests/packages/wheel.sh runs."""

import sys

import numpy
import shapespace

animal = shapespace.skinned_body("quadruped", 1500)
poses = [animal.pose("sit"), animal.pose("stretch")]
path, summary = shapespace.interpolate(poses, animal.faces, shapes=7)
print(summary)


def lengths(shape):
    ends = shape[numpy.concatenate([animal.faces[:, [0, 1]], animal.faces[:, [1, 2]]])]
    return numpy.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)


# The geodesic keeps the edges' lengths on its way; half way between the poses they would shrink on
# straight lines.
shapes = path.vertices
expected = (lengths(shapes[0]) + lengths(shapes[-1])) / 2
geodesic = numpy.abs(lengths(shapes[4]) / expected - 1).mean()
straight = numpy.abs(lengths((shapes[0] + shapes[-1]) / 2) / expected - 1).mean()
print(f"lengths half way are off by {geodesic:.2%}, on straight lines by {straight:.2%}")
if shapes.shape != (9, len(poses[0]), 3) or not geodesic < straight / 3:
    sys.exit("interpolate.py: this is no geodesic between the poses")
if len(sys.argv) > 1 and sys.argv[-1].endswith(".npy"):
    numpy.save(sys.argv[-1], shapes)
