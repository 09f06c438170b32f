#ifndef SHAPESPACE_FILES_DETAIL_READ_FORMATS_H_
#define SHAPESPACE_FILES_DETAIL_READ_FORMATS_H_

#include <limits>
#include <string>
#include <vector>

#include <shapespace/mesh/soup.h>

// One reader per format. `text` is the content of `file`, whose name is used in messages.
// Each throws FileError as `ReadSoup`.

namespace shapespace::internal {

/// The size of the largest file that is read: it keeps all indices and counts in a file within the
/// range of int.
inline constexpr int kMaxMeshBytes = std::numeric_limits<int>::max();

Soup ReadObj(const std::string& file, std::string text);
Soup ReadPly(const std::string& file, const std::string& text);
Soup ReadOff(const std::string& file, const std::string& text);
Soup ReadStl(const std::string& file, const std::string& bytes);
Soup ReadVtk(const std::string& file, const std::string& text);
Soup ReadVtp(const std::string& file, const std::string& text);
/// All poses: the mesh, and each of its morph targets. Buffers are read from the file's folder and
/// those below it, or from anywhere.
std::vector<Soup> ReadGltf(const std::string& file, const std::string& bytes,
                           bool allow_outside_files);

/// A property of the vertices of a PLY file; any but a list.
Eigen::VectorXd ReadPlyProperty(const std::string& file, const std::string& text,
                                const std::string& property);
/// The array `name` of a VTK file's point data, which must have one number a point.
Eigen::VectorXd ReadVtkField(const std::string& file, const std::string& text,
                             const std::string& name);
Eigen::VectorXd ReadVtpField(const std::string& file, const std::string& text,
                             const std::string& name);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_FILES_DETAIL_READ_FORMATS_H_
