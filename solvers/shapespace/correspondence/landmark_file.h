#ifndef SHAPESPACE_CORRESPONDENCE_LANDMARK_FILE_H_
#define SHAPESPACE_CORRESPONDENCE_LANDMARK_FILE_H_

#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/correspondence/correspondence.h>
#include <shapespace/files/read.h>

namespace shapespace {

/// A point on a body, such as the tip of its nose.
struct Landmark {
  std::string label;                                   ///< may be empty
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in the mesh's frame and unit
};

/// Whether the file's extension is one of 3D Slicer's landmarks: .fcsv or .json (.mrk.json).
bool IsSlicerLandmarks(const std::string& file);

/// Reads the landmarks of one body (docs/file-formats.md): a list of points as 3D Slicer saves it,
/// .fcsv or .mrk.json, or another text with the coordinates x, y and z on each line, in which `#`
/// begins a comment. Coordinates that a file of Slicer has in RAS (right, anterior, superior) are
/// converted to LPS (left, posterior, superior), the system in which Slicer saves meshes: x and y
/// change their signs. Points of a .mrk.json that were not placed are left out.
/// \throw FileError naming file, and line or element: unreadable, no landmark, a coordinate that is
///        not a finite number, a coordinate system that is missing or neither of the two.
std::vector<Landmark> ReadLandmarks(const std::string& file);

/// The distance of a landmark from the surface beyond which it is not taken for a point of the
/// body, as a share of the diagonal of the body's bounding box.
inline constexpr double kFarthestLandmark = 0.05;

/// Markers at landmarks, and what a person should know of how they were matched.
struct MatchedLandmarks {
  std::vector<CorrespondenceMarker> markers;
  std::vector<std::string> warnings;
};

/// The markers at the landmarks of two files. If all landmarks of both have labels, those with the
/// same label are a pair, in the template's order; the others are left out, with a warning. If some
/// have none, or no label is in both files (then with a warning), they are paired by their order.
///
/// The vertex of a landmark is the one, among the corners of the triangle that is nearest to it,
/// that is nearest to it.
/// \throw FileError as `ReadLandmarks`; if a landmark is farther than `kFarthestLandmark` from its
///        body's surface; if two have the same vertex or, where they are paired by labels, the same
///        label; if they are paired by order and the files have different numbers of landmarks.
///        MeshError if a mesh has no triangles.
MatchedLandmarks MatchLandmarks(const std::string& template_file, const std::string& target_file,
                                const Poses& template_mesh, const Poses& target);

}  // namespace shapespace

#endif  // SHAPESPACE_CORRESPONDENCE_LANDMARK_FILE_H_
