#ifndef SHAPESPACE_FILES_VERTEX_FIELD_H_
#define SHAPESPACE_FILES_VERTEX_FIELD_H_

#include <string>

#include <Eigen/Core>

namespace shapespace {

/// Reads one number per vertex, in the order of the mesh: from a text with one number per line, in
/// which `#` begins a comment, or, if `source` has the form "body.ply:name", from the property
/// `name` of that PLY file's vertices. Of "body.vtk:name" and "body.vtp:name" it is the array
/// `name` of the point data. \throw FileError naming the file, the line and the error.
Eigen::VectorXd ReadVertexField(const std::string& source);

}  // namespace shapespace

#endif  // SHAPESPACE_FILES_VERTEX_FIELD_H_
