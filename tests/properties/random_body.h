#ifndef SHAPESPACE_TESTS_PROPERTIES_RANDOM_BODY_H_
#define SHAPESPACE_TESTS_PROPERTIES_RANDOM_BODY_H_

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

namespace shapespace::testing {

/// Random numbers that are the same with every standard library, whose distributions differ.
class Random {
 public:
  explicit Random(int seed) : generator_(static_cast<std::uint32_t>(seed)) {}

  double Between(double low, double high) {
    return low + (high - low) * (generator_() / 4294967296.0);
  }
  int Below(int count) { return static_cast<int>(Between(0, count)); }
  bool OneIn(int count) { return Below(count) == 0; }
  Eigen::Vector3d Direction();
  Eigen::Matrix3d Rotation();
  /// The numbers from 0 to count - 1 in random order.
  std::vector<int> Order(int count);

 private:
  std::mt19937 generator_;
};

/// Kinds of random bodies.
enum class BodyKind {
  kSheet,      ///< flat at rest, with holes; diagonals at random
  kPlate,      ///< closed, with as many handles as it has holes
  kTube,       ///< the library's own
  kBall,       ///< an octahedron, divided twice
  kTorus,      ///< of rectangles that are not flat
  kDelaunay,   ///< the Delaunay triangulation of random points of the plane
  kMoebius,    ///< a band with one side
  kWhiskered,  ///< a sheet with segments that hang from it
  kBook,       ///< three sheets at one edge
  kTwo,        ///< a ball and a sheet
  kFlexible,   ///< the library's bodies that move isometrically
  kGraph,      ///< edges without polygons
};
inline constexpr int kNumBodyKinds = 12;

/// A body in some poses, with everything else that a solver is told of it.
struct RandomBody {
  std::string name;
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Shape> poses;
  MetricOptions metric;
  /// Two sets of vertices without a common one, at opposite ends, for handles.
  std::vector<int> held, moved;
};

/// A body of up to 400 triangles in so many poses: the rest shape, bent, twisted, bulged and dented
/// at random, each in a place of its own, with a metric. A seed always gives the same body. The
/// deformations are moderate, so that no two ways from one pose to another cost nearly the same.
/// Where parts can swing without bending a hinge, only the cost of position tells how they do; it
/// is greater there, so that solves determine it.
RandomBody MakeRandomBody(BodyKind kind, int seed, int poses);

/// The same with all lengths multiplied, moved and turned.
RandomBody Moved(const RandomBody& body, double scale, const Eigen::Matrix3d& rotation,
                 const Eigen::Vector3d& translation);

/// A body with its vertices and polygons in another order, and polygons that begin at another of
/// their corners.
struct Renumbered {
  RandomBody body;
  std::vector<int> to;  ///< the new number of each vertex

  /// A shape of the first body as one of the second, and the other way round.
  Shape operator()(const Shape& shape) const;
  Shape Back(const Shape& shape) const;
};
Renumbered Renumber(const RandomBody& body, int seed);

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_PROPERTIES_RANDOM_BODY_H_
