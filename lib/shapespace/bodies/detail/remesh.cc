#include <shapespace/bodies/detail/remesh.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <Eigen/Geometry>
#include <OpenMesh/Core/Mesh/TriConnectivity.hh>

#include <shapespace/base/internal/ranges.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace::internal {
namespace {

using OpenMesh::EdgeHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

/// Edge lengths are proportional to the local radius to this power. With power 1, thick parts of a
/// coarse mesh would become too coarse; with power 0, its thin parts would.
constexpr double kSizePower = 0.65;
/// Greatest edge length in units of the local radius, which leaves three edges around a limb.
constexpr double kMaxPerRadius = 2;
/// Edge lengths may grow by this share of the distance along the surface.
constexpr double kGradation = 0.35;
/// Botsch and Kobbelt's limits, relative to the target length.
constexpr double kLongest = 4.0 / 3, kShortest = 4.0 / 5;
/// Greatest depth of a triangle's centre below the surface, in units of the local radius. A tip or
/// a limb that a triangle cuts off could not be restored.
constexpr double kDeepest = 0.25;
/// Least cosine of the angle between a triangle's normal and the surface's; a larger angle would be
/// a fold.
constexpr double kMinCosine = 0.3;
/// Rounds until the number of triangles is near the requested one, and final rounds, which adjust
/// the number and improve the angles.
constexpr int kRounds = 4, kLastRounds = 3;

class Remesher {
 public:
  Remesher(const TriangleMesh& mesh, const std::vector<RoundCone>& cones)
      : cones_(cones), points_(mesh.points) {
    mesh_.request_vertex_status();
    mesh_.request_edge_status();
    mesh_.request_halfedge_status();
    mesh_.request_face_status();
    mesh_.reserve(points_.size(), 3 * points_.size(), 2 * points_.size());
    for (size_t v = 0; v < points_.size(); ++v) mesh_.add_vertex();
    for (const Eigen::Vector3i& t : mesh.triangles) {
      mesh_.add_face(VertexHandle(t(0)), VertexHandle(t(1)), VertexHandle(t(2)));
    }
    ProjectAll();
  }

  TriangleMesh Run(int triangles) {
    for (int round = 0; round < kRounds + kLastRounds; ++round) {
      const bool last = round >= kRounds;
      // The actual number of triangles differs slightly from the expected one.
      if (last) correction_ = CountTriangles() / Promised();
      SetSizes(triangles);
      SplitLongEdges();
      CollapseShortEdges();
      FlipEdges(last);
      for (int i = 0; i < 2; ++i) Relax();
    }
    FlipEdges(true);
    return Result();
  }

 private:
  bool Exists(VertexHandle v) const { return !mesh_.status(v).deleted(); }
  bool Exists(EdgeHandle e) const { return !mesh_.status(e).deleted(); }
  VertexHandle From(HalfedgeHandle h) const { return mesh_.from_vertex_handle(h); }
  VertexHandle To(HalfedgeHandle h) const { return mesh_.to_vertex_handle(h); }
  HalfedgeHandle Half(EdgeHandle e, int side) const { return mesh_.halfedge_handle(e, side); }
  /// The third vertex of the triangle at `h`.
  VertexHandle Apex(HalfedgeHandle h) const { return To(mesh_.next_halfedge_handle(h)); }
  const Eigen::Vector3d& Point(VertexHandle v) const { return points_[v.idx()]; }

  /// The length of an edge relative to its target length.
  double Relative(VertexHandle a, VertexHandle b) const {
    return (Point(a) - Point(b)).norm() * 2 / (sizes_[a.idx()] + sizes_[b.idx()]);
  }
  double Relative(EdgeHandle e) const { return Relative(From(Half(e, 0)), To(Half(e, 0))); }

  /// Twice a triangle's area, times its normal.
  Eigen::Vector3d Normal(VertexHandle a, VertexHandle b, VertexHandle c) const {
    return AreaNormal(Point(a), Point(b), Point(c));
  }
  /// Whether a triangle's normal is close to the surface's at its corners.
  bool Faces(VertexHandle a, VertexHandle b, VertexHandle c) const {
    const Eigen::Vector3d normal = Normal(a, b, c);
    const double least = kMinCosine * normal.norm();
    for (VertexHandle v : {a, b, c}) {
      if (normal.dot(normals_[v.idx()]) <= least) return false;
    }
    return true;
  }
  bool IsDeep(VertexHandle a, VertexHandle b, VertexHandle c) const {
    const ImplicitValue middle = Evaluate(cones_, (Point(a) + Point(b) + Point(c)) / 3);
    return middle.value < -kDeepest * middle.radius;
  }

  void ForEachVertex(const std::function<void(VertexHandle)>& body) const {
    ForIndices(static_cast<int>(mesh_.n_vertices()), [&](int v) {
      if (Exists(VertexHandle(v))) body(VertexHandle(v));
    });
  }

  void ProjectAll() {
    normals_.resize(points_.size());
    radii_.resize(points_.size());
    ForEachVertex([&](VertexHandle v) {
      Eigen::Vector3d& point = points_[v.idx()];
      const ImplicitValue here = Project(cones_, &point);
      normals_[v.idx()] = here.gradient.normalized();
      radii_[v.idx()] = here.radius;
    });
  }

  int CountTriangles() const {
    int count = 0;
    for (OpenMesh::FaceHandle f : mesh_.all_faces()) count += !mesh_.status(f).deleted();
    return count;
  }

  /// The expected number of triangles: equilateral ones of the target sizes that cover the surface.
  double Promised() const {
    double sum = 0;
    for (OpenMesh::FaceHandle f : mesh_.all_faces()) {
      if (mesh_.status(f).deleted()) continue;
      const HalfedgeHandle h = mesh_.halfedge_handle(f);
      const VertexHandle a = From(h), b = To(h), c = Apex(h);
      const double size = (sizes_[a.idx()] + sizes_[b.idx()] + sizes_[c.idx()]) / 3;
      sum += Normal(a, b, c).norm() / 2 / (std::sqrt(3.0) / 4 * size * size);
    }
    return sum;
  }

  /// Computes target sizes from the thickness, limited by the gradation and scaled so that about
  /// `triangles` triangles of these sizes cover the surface.
  void SetSizes(int triangles) {
    sizes_.resize(points_.size());
    for (int pass = 0; pass < 3; ++pass) {
      for (size_t v = 0; v < points_.size(); ++v) {
        sizes_[v] = std::min(scale_ * std::pow(radii_[v], kSizePower), kMaxPerRadius * radii_[v]);
      }
      for (int sweep = 0; sweep < 3; ++sweep) {
        for (EdgeHandle e : mesh_.all_edges()) {
          if (!Exists(e)) continue;
          double& a = sizes_[From(Half(e, 0)).idx()];
          double& b = sizes_[To(Half(e, 0)).idx()];
          const double more = kGradation * (Point(From(Half(e, 0))) - Point(To(Half(e, 0)))).norm();
          a = std::min(a, b + more);
          b = std::min(b, a + more);
        }
      }
      const double factor = std::sqrt(Promised() * correction_ / triangles);
      scale_ *= factor;
    }
  }

  void SplitLongEdges() {
    const int count = static_cast<int>(mesh_.n_edges());
    for (int i = 0; i < count; ++i) {
      const EdgeHandle e(i);
      if (!Exists(e) || Relative(e) <= kLongest) continue;
      const int a = From(Half(e, 0)).idx(), b = To(Half(e, 0)).idx();
      points_.push_back((points_[a] + points_[b]) / 2);
      sizes_.push_back((sizes_[a] + sizes_[b]) / 2);
      mesh_.split(e, mesh_.add_vertex());
    }
    ProjectAll();
  }

  /// Whether moving `From(h)` to `To(h)` makes no edge too long and no triangle point away from the
  /// surface.
  bool MayCollapse(HalfedgeHandle h) {
    const VertexHandle gone = From(h), kept = To(h);
    for (HalfedgeHandle spoke : mesh_.voh_range(gone)) {
      const VertexHandle a = To(spoke);
      if (a != kept && Relative(a, kept) > kLongest) return false;
    }
    if (!mesh_.is_collapse_ok(h)) return false;
    for (HalfedgeHandle spoke : mesh_.voh_range(gone)) {
      const VertexHandle a = To(spoke), b = Apex(spoke);
      if (a != kept && b != kept && (!Faces(kept, a, b) || IsDeep(kept, a, b))) return false;
    }
    return true;
  }

  void CollapseShortEdges() {
    for (EdgeHandle e : mesh_.all_edges()) {
      if (!Exists(e) || Relative(e) >= kShortest) continue;
      for (int side : {0, 1}) {
        if (!MayCollapse(Half(e, side))) continue;
        mesh_.collapse(Half(e, side));
        break;
      }
    }
  }

  /// Flips an edge if the valences then are nearer to six or, with `by_angles`, if the smallest
  /// angle of both triangles is then larger.
  void FlipEdges(bool by_angles) {
    for (EdgeHandle e : mesh_.all_edges()) {
      if (!Exists(e) || !mesh_.is_flip_ok(e)) continue;
      const VertexHandle a = From(Half(e, 0)), b = To(Half(e, 0));
      const VertexHandle c = Apex(Half(e, 0)), d = Apex(Half(e, 1));
      const bool better =
          by_angles
              ? std::max(LargestCosine(a, b, c), LargestCosine(b, a, d)) >
                    1e-9 + std::max(LargestCosine(c, d, b), LargestCosine(d, c, a))
              : ValenceError(a, 0) + ValenceError(b, 0) + ValenceError(c, 0) + ValenceError(d, 0) >
                    ValenceError(a, -1) + ValenceError(b, -1) + ValenceError(c, 1) +
                        ValenceError(d, 1);
      if (better && Faces(c, d, b) && Faces(d, c, a)) mesh_.flip(e);
    }
  }

  int ValenceError(VertexHandle v, int change) const {
    const int error = static_cast<int>(mesh_.valence(v)) + change - 6;
    return error * error;
  }

  /// The cosine of a triangle's smallest angle.
  double LargestCosine(VertexHandle a, VertexHandle b, VertexHandle c) const {
    const Eigen::Vector3d u = (Point(b) - Point(a)).normalized();
    const Eigen::Vector3d v = (Point(c) - Point(b)).normalized();
    const Eigen::Vector3d w = (Point(a) - Point(c)).normalized();
    return std::max({-u.dot(w), -v.dot(u), -w.dot(v)});
  }

  /// Moves every vertex, within the surface, to the mean of its triangles' centres, weighted by the
  /// ratio of area to target area, which preserves the gradation.
  void Relax() {
    std::vector<Eigen::Vector3d> moved(points_.size());
    ForEachVertex([&](VertexHandle v) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      double weights = 0;
      for (HalfedgeHandle h : mesh_.voh_range(v)) {
        const VertexHandle a = To(h), b = Apex(h);
        const double size = sizes_[a.idx()] + sizes_[b.idx()] + sizes_[v.idx()];
        const double weight = Normal(v, a, b).norm() / (size * size);
        weights += weight;
        sum += weight / 3 * (Point(v) + Point(a) + Point(b));
      }
      const Eigen::Vector3d& normal = normals_[v.idx()];
      const Eigen::Vector3d way = sum / weights - Point(v);
      moved[v.idx()] = Point(v) + (way - way.dot(normal) * normal);
    });
    points_.swap(moved);
    ProjectAll();
  }

  TriangleMesh Result() const {
    TriangleMesh result;
    std::vector<int> number(points_.size(), -1);
    for (VertexHandle v : mesh_.all_vertices()) {
      if (!Exists(v)) continue;
      number[v.idx()] = static_cast<int>(result.points.size());
      result.points.push_back(Point(v));
    }
    for (OpenMesh::FaceHandle f : mesh_.all_faces()) {
      if (mesh_.status(f).deleted()) continue;
      const HalfedgeHandle h = mesh_.halfedge_handle(f);
      result.triangles.emplace_back(number[From(h).idx()], number[To(h).idx()],
                                    number[Apex(h).idx()]);
    }
    return result;
  }

  const std::vector<RoundCone>& cones_;
  OpenMesh::TriConnectivity mesh_;  // never garbage collected: deleted elements keep their index
  // One per vertex, including deleted ones.
  std::vector<Eigen::Vector3d> points_, normals_;
  std::vector<double> radii_, sizes_;
  double scale_ = 1;       // edge length where the radius is 1
  double correction_ = 1;  // ratio of actual to expected triangles
};

}  // namespace

TriangleMesh Remesh(const TriangleMesh& mesh, const std::vector<RoundCone>& cones, int triangles) {
  return Remesher(mesh, cones).Run(triangles);
}

}  // namespace shapespace::internal
