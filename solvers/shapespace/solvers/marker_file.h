#ifndef SHAPESPACE_SOLVERS_MARKER_FILE_H_
#define SHAPESPACE_SOLVERS_MARKER_FILE_H_

#include <string>
#include <vector>

#include <shapespace/mesh/read.h>
#include <shapespace/solvers/correspondence.h>

namespace shapespace {

/// Reads a file of markers, which a person writes (docs/file-formats.md): a line each, of a vertex
/// of the template and one of the target, counted from 1 as in OBJ; `#` begins a comment. In place
/// of a number a vertex may be named by a group of its mesh: it is the group's vertex nearest to
/// the mean of them all.
/// \throw FileError naming file and line.
std::vector<Marker> ReadMarkers(const std::string& file, const Poses& template_mesh,
                                const Poses& target);

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_MARKER_FILE_H_
