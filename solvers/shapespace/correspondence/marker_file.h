#ifndef SHAPESPACE_CORRESPONDENCE_MARKER_FILE_H_
#define SHAPESPACE_CORRESPONDENCE_MARKER_FILE_H_

#include <string>
#include <vector>

#include <shapespace/correspondence/correspondence.h>
#include <shapespace/files/read.h>

namespace shapespace {

/// Reads a file of markers written by the user (docs/file-formats.md). Each line has a vertex of
/// the template and one of the target, counted from 1 as in OBJ; `#` begins a comment. In place of
/// a number a vertex may be given by the name of a group of its mesh, which stands for the group's
/// vertex that is nearest to the group's centroid.
/// \throw FileError naming file and line.
std::vector<CorrespondenceMarker> ReadMarkers(const std::string& file, const Poses& template_mesh,
                                              const Poses& target);

/// Writes markers as such a file: to be looked at, mended, and read again.
/// \throw FileError.
void WriteMarkers(const std::string& file, const std::vector<CorrespondenceMarker>& markers);

}  // namespace shapespace

#endif  // SHAPESPACE_CORRESPONDENCE_MARKER_FILE_H_
