#include <shapespace/exploration/triangulation.h>

#include <algorithm>
#include <string>

#include <libqhullcpp/Qhull.h>
#include <libqhullcpp/QhullError.h>
#include <libqhullcpp/QhullFacetList.h>
#include <libqhullcpp/QhullVertexSet.h>
#include <Eigen/Eigenvalues>

#include <shapespace/base/error.h>

namespace shapespace {
namespace {

// Points nearer to each other than this share of the extent coincide.
constexpr double kCoincident = 1e-9;

Eigen::Matrix3Xi Delaunay(const Eigen::Matrix2Xd& points, const std::vector<int>& kept) {
  std::vector<double> coordinates;
  for (int i : kept) coordinates.insert(coordinates.end(), {points(0, i), points(1, i)});
  const double extent = points.cwiseAbs().maxCoeff();
  for (double& coordinate : coordinates) coordinate /= extent;
  orgQhull::Qhull qhull;
  // Options of Qhull: scaled to the unit cube, with a point at infinity, non-simplicial facets
  // triangulated.
  try {
    qhull.runQhull("", 2, static_cast<int>(kept.size()), coordinates.data(), "d Qbb Qz Qt Q12");
  } catch (const orgQhull::QhullError& error) {
    throw SolverError(std::string("the points could not be triangulated: ") + error.what());
  }
  std::vector<Eigen::Vector3i> triangles;
  for (const orgQhull::QhullFacet& facet : qhull.facetList()) {
    if (!facet.isGood() || facet.isUpperDelaunay()) continue;
    Eigen::Vector3i triangle;
    int k = 0;
    for (const orgQhull::QhullVertex& vertex : facet.vertices()) {
      triangle(k++) = kept[vertex.point().id()];
    }
    const Eigen::Vector2d a = points.col(triangle(0)), b = points.col(triangle(1)) - a,
                          c = points.col(triangle(2)) - a;
    if (b.x() * c.y() < b.y() * c.x()) std::swap(triangle(1), triangle(2));
    triangles.push_back(triangle);
  }
  Eigen::Matrix3Xi result(3, triangles.size());
  for (size_t t = 0; t < triangles.size(); ++t) result.col(t) = triangles[t];
  return result;
}

}  // namespace

Triangulation DelaunayTriangulation(const Eigen::Matrix2Xd& points) {
  if (!points.allFinite()) throw InvalidOptions("points", "one is not finite");
  Triangulation result;
  const int count = static_cast<int>(points.cols());
  if (count == 0) throw InvalidOptions("points", "at least two must differ");
  const double extent = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
  std::vector<int> kept;
  for (int i = 0; i < count; ++i) {
    const bool coincides = std::any_of(kept.begin(), kept.end(), [&](int j) {
      return (points.col(i) - points.col(j)).norm() <= kCoincident * extent;
    });
    (coincides ? result.left_out : kept).push_back(i);
  }
  if (kept.size() < 2) throw InvalidOptions("points", "at least two must differ");

  const Eigen::Matrix2Xd centred =
      points(Eigen::all, kept).colwise() - points(Eigen::all, kept).rowwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(centred * centred.transpose());
  const Eigen::RowVectorXd along = axes.eigenvectors().col(1).transpose() * centred;
  const Eigen::RowVectorXd across = axes.eigenvectors().col(0).transpose() * centred;
  const auto spread = [](const Eigen::RowVectorXd& x) { return x.maxCoeff() - x.minCoeff(); };
  if (spread(across) >= kFlatSpread * spread(along)) {
    result.triangles = Delaunay(points, kept);
    return result;
  }
  std::vector<int> order(kept.size());
  for (size_t i = 0; i < kept.size(); ++i) order[i] = static_cast<int>(i);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return along(a) < along(b); });
  result.segments.resize(2, kept.size() - 1);
  for (size_t i = 0; i + 1 < kept.size(); ++i) {
    result.segments.col(i) << kept[order[i]], kept[order[i + 1]];
  }
  return result;
}

}  // namespace shapespace
