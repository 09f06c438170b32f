#ifndef SHAPESPACE_OUTPUT_INTERNAL_VIEW_H_
#define SHAPESPACE_OUTPUT_INTERNAL_VIEW_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/output/detail/ray_scene.h>

namespace shapespace::internal {

/// An orthographic camera's axes as columns: right and up in the picture, and towards the eye.
using Axes = Eigen::Matrix3d;

/// Whether two directions, of any length, are so nearly parallel that they define no picture plane.
bool Parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// The upward axis: +z if more of the shapes can stand on it than on +y, else +y; both are common
/// in mesh files. An open surface that would face down gets the other one.
Eigen::Vector3d ChooseUp(const Connectivity& connectivity, const std::vector<Shape>& shapes);

/// `up`, which is +y or +z, or the other of the two if a view from `eye` would be along it.
Eigen::Vector3d UpBeside(const Eigen::Vector3d& eye, const Eigen::Vector3d& up);

/// Looks from `eye` (any length). `up` must not be parallel to it.
Axes LookFrom(const Eigen::Vector3d& eye, const Eigen::Vector3d& up);

/// A three-quarter view: the one of a few directions around and above the shapes in which most of
/// their surface is visible, preferably its front side, and their projection is largest, so that a
/// plate is not seen from its edge, nor a finger in the plane in which it bends. Between equal
/// views the one from the front and the left is preferred. Open surfaces, such as scans of faces,
/// are seen from outside, from below too if they face down. `scenes[i]` contains `shapes[i]`. A
/// view that must be horizontal looks from the height of the shapes, so that the ground is a line.
Axes ChooseView(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                const std::vector<RayScene>& scenes, const Eigen::Vector3d& up,
                bool must_be_horizontal = false);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_INTERNAL_VIEW_H_
