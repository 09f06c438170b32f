#include <shapespace/bodies/bar.h>

#include <algorithm>
#include <utility>

#include <shapespace/bodies/detail/bend.h>
#include <shapespace/bodies/detail/checks.h>
#include <shapespace/bodies/detail/grid.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace {
namespace {

/// Numbers the surface nodes of a box grid slice by slice along x: the two end slices are complete,
/// the others are rings.
class BoxNodes {
 public:
  BoxNodes(int nx, int ny, int nz) : nx_(nx), ny_(ny), nz_(nz) {}

  int Count() const { return 2 * Slice() + (nx_ - 1) * Ring(); }

  int operator()(int i, int j, int k) const {
    if (i == 0) return j * (nz_ + 1) + k;
    if (i == nx_) return Count() - Slice() + j * (nz_ + 1) + k;
    return Slice() + (i - 1) * Ring() + OnRing(j, k);
  }

 private:
  int Slice() const { return (ny_ + 1) * (nz_ + 1); }
  int Ring() const { return 2 * (ny_ + nz_); }
  int OnRing(int j, int k) const {
    if (k == 0) return j;
    if (j == ny_) return ny_ + k;
    if (k == nz_) return ny_ + nz_ + (ny_ - j);
    return 2 * ny_ + nz_ + (nz_ - k);
  }

  int nx_, ny_, nz_;
};

}  // namespace

ShapeFamily MakeBar(double length, double width, double height, int nx, int ny, int nz) {
  internal::CheckLength("length", length);
  internal::CheckLength("width", width);
  internal::CheckLength("height", height);
  internal::CheckCount("nx", nx, 1);
  internal::CheckCount("ny", ny, 1);
  internal::CheckCount("nz", nz, 1);
  // Each count is checked first, because products of three large counts would overflow.
  internal::CheckTriangles(std::max({nx, ny, nz}));
  internal::CheckTriangles(4 *
                           (std::int64_t{nx} * ny + std::int64_t{ny} * nz + std::int64_t{nz} * nx));

  const BoxNodes node(nx, ny, nz);
  internal::TriangleList triangles;
  internal::AddGrid(
      nx, ny, [&](int i, int j) { return node(i, j, nz); }, &triangles);
  internal::AddGrid(
      ny, nx, [&](int j, int i) { return node(i, j, 0); }, &triangles);
  internal::AddGrid(
      ny, nz, [&](int j, int k) { return node(nx, j, k); }, &triangles);
  internal::AddGrid(
      nz, ny, [&](int k, int j) { return node(0, j, k); }, &triangles);
  internal::AddGrid(
      nz, nx, [&](int k, int i) { return node(i, ny, k); }, &triangles);
  internal::AddGrid(
      nx, nz, [&](int i, int k) { return node(i, 0, k); }, &triangles);

  Shape rest(3, node.Count());
  for (int i = 0; i <= nx; ++i) {
    for (int j = 0; j <= ny; ++j) {
      const bool inside = i > 0 && i < nx && j > 0 && j < ny;
      for (int k = 0; k <= nz; k += inside ? nz : 1) {
        rest.col(node(i, j, k)) << length * (double(i) / nx - 0.5), width * (double(j) / ny - 0.5),
            height * (double(k) / nz - 0.5);
      }
    }
  }

  ShapeFamily body;
  body.name = "bar";
  body.connectivity = internal::ConnectivityOf(node.Count(), triangles);
  body.parameter = "bend angle, degrees";
  body.end = std::min({360.0, 90.0 * nx, 0.9 * 2 * length / height / internal::kRadians});
  body.pose = [rest = std::move(rest), length](double angle) {
    Shape shape(3, rest.cols());
    const double curvature = angle * internal::kRadians / length;
    for (int v = 0; v < rest.cols(); ++v) shape.col(v) = internal::Bend(rest.col(v), curvature);
    return shape;
  };
  return internal::WithCheckedRange(std::move(body));
}

}  // namespace shapespace
