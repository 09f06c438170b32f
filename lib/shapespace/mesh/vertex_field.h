#ifndef SHAPESPACE_MESH_VERTEX_FIELD_H_
#define SHAPESPACE_MESH_VERTEX_FIELD_H_

#include <string>

#include <Eigen/Core>

namespace shapespace {

/// Reads one number for each vertex, in the order of the mesh: from a text with one number a line,
/// in which `#` begins a comment, or, where `source` is like "body.ply:name", from the property
/// `name` of that PLY file's vertices.
/// \throw FileError naming the file, the line and what is wrong.
Eigen::VectorXd ReadVertexField(const std::string& source);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_VERTEX_FIELD_H_
