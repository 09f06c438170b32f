#include <shapespace/mesh/mirrored.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/internal/sides.h>

namespace shapespace {
namespace {

using internal::Side;
using internal::Sides;
using internal::UnionFind;

Sides SidesOf(const Eigen::Matrix3Xi& triangles, int num_vertices) {
  std::vector<int> begin(triangles.cols() + 1);
  for (size_t t = 0; t < begin.size(); ++t) begin[t] = static_cast<int>(3 * t);
  return internal::MakeSides(num_vertices, begin,
                             {triangles.data(), triangles.data() + triangles.size()});
}

/// Both shapes of one surface.
struct Pair {
  Eigen::Matrix3Xi triangles;
  Shape reference, pose;
};

/// Closes the ends of tubes: every border of a component that has more than one, by a cone onto its
/// middle. A tube is rolled up of a flat sheet, but bending alone cannot turn it inside out; with
/// its ends closed this shows at their rims.
Pair CloseTubes(const Eigen::Matrix3Xi& triangles, const Shape& reference, const Shape& pose) {
  Pair closed = {triangles, reference, pose};
  const int num_vertices = static_cast<int>(reference.cols());
  const Sides sides = SidesOf(triangles, num_vertices);
  std::vector<std::pair<int, int>> border;  // in the direction of its triangle
  UnionFind components(num_vertices), loops(num_vertices);
  for (int e = 0; e < sides.NumEdges(); ++e) {
    const auto [low, high] = sides.Ends(e);
    components.Join(low, high);
    if (sides.Count(e) > 1) continue;
    loops.Join(low, high);
    const bool ascending = sides.sides[sides.begin[e]].ascending;
    border.emplace_back(ascending ? low : high, ascending ? high : low);
  }
  std::map<int, std::set<int>> loops_of;
  for (const auto& [a, b] : border) loops_of[components.Find(a)].insert(loops.Find(a));
  std::map<int, std::vector<std::pair<int, int>>> ends;
  for (const auto& side : border) {
    if (loops_of[components.Find(side.first)].size() > 1) {
      ends[loops.Find(side.first)].push_back(side);
    }
  }
  for (const auto& [loop, edges] : ends) {
    const auto middle = static_cast<int>(closed.reference.cols());
    const Eigen::Index begin = closed.triangles.cols();
    closed.triangles.conservativeResize(Eigen::NoChange, begin + edges.size());
    for (Shape* shape : {&closed.reference, &closed.pose}) {
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (const auto& [a, b] : edges) mean += (shape->col(a) + shape->col(b)) / 2 / edges.size();
      shape->conservativeResize(Eigen::NoChange, middle + 1);
      shape->col(middle) = mean;
    }
    for (size_t k = 0; k < edges.size(); ++k) {
      closed.triangles.col(begin + k) << edges[k].second, edges[k].first, middle;
    }
  }
  return closed;
}

/// An edge between two triangles of consistent orientation.
struct Hinge {
  int low, high;    ///< its ends
  int left, right;  ///< the triangle that runs from low to high, and the other
};

struct Hinges {
  std::vector<Hinge> hinges;
  std::vector<char> inner;  ///< of each vertex: whether all its edges are hinges
  bool has_border = false;
};

Hinges HingesOf(const Sides& sides, int num_vertices) {
  Hinges result;
  result.inner.assign(num_vertices, 0);
  for (const Side& side : sides.sides) result.inner[side.high] = 1;
  for (const int low : sides.low) result.inner[low] = 1;
  for (int e = 0; e < sides.NumEdges(); ++e) {
    const auto [low, high] = sides.Ends(e);
    const Side* side = &sides.sides[sides.begin[e]];
    if (sides.Count(e) == 2 && !sides.WoundAlike(e)) {
      if (!side[0].ascending) ++side;
      const Side* other = side == &sides.sides[sides.begin[e]] ? side + 1 : side - 1;
      result.hinges.push_back({low, high, side->polygon, other->polygon});
    } else {
      result.inner[low] = result.inner[high] = 0;
      result.has_border = true;
    }
  }
  return result;
}

/// The sine of the dihedral angle of every hinge. Unlike the angle it is continuous where a hinge
/// is folded together, which has no side to which it bulges.
Eigen::VectorXd Sines(const std::vector<Hinge>& hinges, const Eigen::Matrix3Xi& triangles,
                      const Shape& shape) {
  Eigen::Matrix3Xd normals(3, triangles.cols());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    normals.col(t) = internal::UnitNormal(shape, triangles.col(t));
  }
  Eigen::VectorXd sines(hinges.size());
  for (size_t h = 0; h < hinges.size(); ++h) {
    const Eigen::Vector3d along = shape.col(hinges[h].high) - shape.col(hinges[h].low);
    sines(h) = normals.col(hinges[h].left)
                   .cross(normals.col(hinges[h].right))
                   .dot(along.stableNormalized());
  }
  return sines;
}

/// The Gaussian curvature of every inner vertex, integrated over its surroundings: what its angles
/// lack of a full turn. 0 at other vertices.
Eigen::VectorXd AngleDefects(const std::vector<char>& inner, const Eigen::Matrix3Xi& triangles,
                             const Shape& shape) {
  Eigen::VectorXd defects(inner.size());
  for (size_t v = 0; v < inner.size(); ++v) defects(v) = inner[v] ? 2 * internal::kPi : 0;
  for (const auto& t : triangles.colwise()) {
    for (int k = 0; k < 3; ++k) {
      if (!inner[t(k)]) continue;
      const Eigen::Vector3d u = shape.col(t((k + 1) % 3)) - shape.col(t(k));
      const Eigen::Vector3d w = shape.col(t((k + 2) % 3)) - shape.col(t(k));
      defects(t(k)) -= std::atan2(u.cross(w).norm(), u.dot(w));
    }
  }
  return defects;
}

/// Averages each column over the neighbours of each vertex, several times, so that noise and the
/// choice of triangles, which cancel over a few vertices, do not count as curvature.
void Smooth(const Sides& sides, Eigen::MatrixXd* columns) {
  constexpr int kPasses = 3;
  Eigen::VectorXd count = Eigen::VectorXd::Ones(columns->rows());
  for (int e = 0; e < sides.NumEdges(); ++e) {
    const auto [low, high] = sides.Ends(e);
    ++count(low);
    ++count(high);
  }
  for (int pass = 0; pass < kPasses; ++pass) {
    Eigen::MatrixXd sum = *columns;
    for (int e = 0; e < sides.NumEdges(); ++e) {
      const auto [low, high] = sides.Ends(e);
      sum.row(low) += columns->row(high);
      sum.row(high) += columns->row(low);
    }
    *columns = count.cwiseInverse().asDiagonal() * sum;
  }
}

}  // namespace

bool IsMirrored(const Eigen::Matrix3Xi& triangles, const Shape& reference, const Shape& pose) {
  // Shares of the solid angle of what bulges: in 80 pairs of real poses at most 1.2 % bulges to the
  // other side. Where a body is turned inside out in part, the rest of it keeps its side.
  constexpr double kKept = 0.05;
  // Of a sheet whose larger curvature is 20 times the smaller, and which is turned over at nearly
  // no cost of stretching. Rolled sheets have 10 times less.
  constexpr double kDoublyCurved = 0.05;
  // Steradians: a dent of less is not as deep as 2 % of its width.
  constexpr double kLeast = 0.01;
  // Standard deviations of what independent hinges would do by chance: few of them prove nothing.
  // Those of a tetrahedron do.
  constexpr double kSignificant = 2.3;

  const Pair pair = CloseTubes(triangles, reference, pose);
  const auto num_vertices = static_cast<int>(pair.reference.cols());
  const Sides sides = SidesOf(pair.triangles, num_vertices);
  const Hinges found = HingesOf(sides, num_vertices);
  const Eigen::VectorXd before = Sines(found.hinges, pair.triangles, pair.reference);
  const Eigen::VectorXd after = Sines(found.hinges, pair.triangles, pair.pose);
  const Eigen::VectorXd products = before.cwiseProduct(after);
  if (!(products.sum() < -kSignificant * products.norm())) return false;

  // Columns: the product of the bends, the bend of either shape, and its Gaussian curvature.
  Eigen::MatrixXd at = Eigen::MatrixXd::Zero(num_vertices, 5);
  for (size_t h = 0; h < found.hinges.size(); ++h) {
    for (const int v : {found.hinges[h].low, found.hinges[h].high}) {
      at.row(v).head<3>() += Eigen::RowVector3d(products(h), before(h), after(h)) / 2;
    }
  }
  at.col(3) = AngleDefects(found.inner, pair.triangles, pair.reference);
  at.col(4) = AngleDefects(found.inner, pair.triangles, pair.pose);
  Smooth(sides, &at);

  double kept = 0, turned = 0, bending = 0;
  for (int v = 0; v < num_vertices; ++v) {
    bending += std::abs(at(v, 1) * at(v, 2));
    // Saddles may turn into their mirror images by bending; domes may not. What is folded together
    // bends by hardly anything, to no side.
    const double dome = std::sqrt(std::max(0.0, at(v, 3)) * std::max(0.0, at(v, 4)));
    (at(v, 0) > 0 ? kept : turned) += std::min(dome, std::abs(at(v, 0)));
  }
  return turned > kLeast && kept <= kKept * (kept + turned) &&
         (!found.has_border || turned > kDoublyCurved * bending);
}

}  // namespace shapespace
