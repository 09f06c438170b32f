#ifndef SHAPESPACE_ANALYSIS_VERTEX_ENERGY_H_
#define SHAPESPACE_ANALYSIS_VERTEX_ENERGY_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/path/path.h>

namespace shapespace {

/// Where a motion costs its energy: of each shape of a path the density of its squared speed at
/// every vertex, per area, as a pure number. The squared change of features from shape to shape,
/// over the squared time between them, is divided evenly among the vertices of each element (for
/// volume, which is one number for the whole body, in proportion to area), and over the vertex's
/// area. Inner shapes have the mean of the segments before and after them. So the sum of density *
/// `Metric::vertex_area` over a segment is the squared speed of that segment in midpoint form
/// (docs/mathematics.md, section 2).
/// \throw InvalidOptions if the metric has a rigid part, which is not made of elements.
std::vector<Eigen::VectorXd> VertexEnergy(const Path& path);

}  // namespace shapespace

#endif  // SHAPESPACE_ANALYSIS_VERTEX_ENERGY_H_
