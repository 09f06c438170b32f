#ifndef SHAPESPACE_TESTS_SUPPORT_CONTACT_BODIES_H_
#define SHAPESPACE_TESTS_SUPPORT_CONTACT_BODIES_H_

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include <shapespace/bodies/bar.h>
#include <shapespace/contact/obstacle.h>
#include <shapespace/mesh/connectivity.h>

namespace shapespace::testing {

/// Two prongs of length 6 that hang from a block, all made of cubes: a fork, or legs. Without the
/// block they are two components.
class TwoProngs {
 public:
  explicit TwoProngs(bool with_block = true) {
    if (with_block) AddBox({-7, -3, 0}, {7, 2, 10});
    AddBox({-7, -3, -30}, {-2, 2, 0});
    AddBox({2, -3, -30}, {7, 2, 0});
    std::map<Corner, int> vertices;
    std::vector<Eigen::Vector3i> triangles;
    for (const Corner& cube : cubes_) AddOuterFaces(cube, &vertices, &triangles);
    rest_.resize(3, static_cast<int>(vertices.size()));
    for (const auto& [corner, vertex] : vertices) {
      rest_.col(vertex) = kEdge * Eigen::Vector3d(corner[0], corner[1], corner[2]);
    }
    connectivity = Connectivity::FromTriangles(
        static_cast<int>(rest_.cols()),
        Eigen::Map<Eigen::Matrix3Xi>(triangles.front().data(), 3,
                                     static_cast<int>(triangles.size())));
  }

  /// An arc of a circle with this angle in all, towards this side: 0 is x, 90 is y. Degrees.
  struct Bend {
    double angle, side;
  };
  Shape Pose(const Bend& left, const Bend& right) const {
    Shape shape = rest_;
    for (int v = 0; v < shape.cols(); ++v) {
      if (shape(2, v) < 0) shape.col(v) = Bent(shape.col(v), shape(0, v) < 0 ? left : right);
    }
    return shape;
  }

  std::shared_ptr<const Connectivity> connectivity;

 private:
  using Corner = std::array<int, 3>;
  static constexpr double kEdge = 0.2, kLength = 6;

  void AddBox(const Corner& low, const Corner& high) {
    for (int x = low[0]; x < high[0]; ++x) {
      for (int y = low[1]; y < high[1]; ++y) {
        for (int z = low[2]; z < high[2]; ++z) cubes_.insert({x, y, z});
      }
    }
  }

  // The faces of a cube behind which there is no other.
  void AddOuterFaces(const Corner& cube, std::map<Corner, int>* vertices,
                     std::vector<Eigen::Vector3i>* triangles) const {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        Corner beyond = cube;
        beyond[axis] += side == 1 ? 1 : -1;
        if (cubes_.count(beyond) > 0) continue;
        std::array<int, 4> face;
        for (int k = 0; k < 4; ++k) {
          Corner corner = cube;
          corner[axis] += side;
          // Round the axis, against the clock as seen from outside.
          const int around = side == 1 ? k : 3 - k;
          corner[(axis + 1) % 3] += around == 1 || around == 2 ? 1 : 0;
          corner[(axis + 2) % 3] += around >= 2 ? 1 : 0;
          face[k] = vertices->emplace(corner, static_cast<int>(vertices->size())).first->second;
        }
        const int first = (cube[0] + cube[1] + cube[2]) % 2 == 0 ? 0 : 1;
        for (const int k : {first, first + 2}) {
          triangles->push_back({face[k], face[(k + 1) % 4], face[(k + 2) % 4]});
        }
      }
    }
  }

  static Eigen::Vector3d Bent(const Eigen::Vector3d& point, const Bend& bend) {
    const double angle = bend.angle * M_PI / 180, side = bend.side * M_PI / 180;
    if (angle == 0) return point;
    const Eigen::Vector3d top(point.x() < 0 ? -1 : 1, 0, 0), up(0, 0, 1);
    const Eigen::Vector3d towards(std::cos(side), std::sin(side), 0), across = up.cross(towards);
    const Eigen::Vector3d offset(point.x() - top.x(), point.y(), 0);
    const double turned = -angle * point.z() / kLength, radius = kLength / angle;
    return top + across.dot(offset) * across +
           (radius * (1 - std::cos(turned)) + towards.dot(offset) * std::cos(turned)) * towards +
           (towards.dot(offset) * std::sin(turned) - radius * std::sin(turned)) * up;
  }

  std::set<Corner> cubes_;
  Shape rest_;
};

/// A ball of radius 1, of 12 `cells`^2 triangles, on either side of a wall at x = 0 with a round
/// hole.
struct BallAndWall {
  explicit BallAndWall(double hole, double of_unit = 1,
                       const Eigen::Vector3d& of_origin = Eigen::Vector3d::Zero(), int cells = 5)
      : unit(of_unit), origin(of_origin), cube(MakeBar(2, 2, 2, cells, cells, cells)) {
    connectivity = cube.connectivity;
    poses = {At(-2), At(2)};
    constexpr int kAround = 16, kRings = 3;
    Shape shape(3, kAround * (kRings + 1));
    Eigen::Matrix3Xi triangles(3, 2 * kAround * kRings);
    for (int ring = 0; ring <= kRings; ++ring) {
      for (int i = 0; i < kAround; ++i) {
        const double angle = 2 * M_PI * i / kAround, radius = hole + ring * (3 - hole) / kRings;
        shape.col(ring * kAround + i) << 0, radius * std::cos(angle), radius * std::sin(angle);
        if (ring == kRings) continue;
        const int a = ring * kAround + i, b = ring * kAround + (i + 1) % kAround;
        triangles.col(2 * a) << a, b, a + kAround;
        triangles.col(2 * a + 1) << b, b + kAround, a + kAround;
      }
    }
    wall = {Connectivity::FromTriangles(kAround * (kRings + 1), triangles), Moved(shape)};
  }
  Shape Moved(const Shape& shape) const { return (unit * shape).colwise() + origin; }
  Shape At(double x) const {
    Shape shape = cube.pose(0);
    const Eigen::Vector3d middle = shape.rowwise().mean();
    shape.colwise() -= middle;
    shape.colwise().normalize();
    shape.row(0).array() += x;
    return Moved(shape);
  }
  double unit;
  Eigen::Vector3d origin;
  ShapeFamily cube;
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Shape> poses;
  Obstacle wall;
};

/// A cube of edge 1 in a closed box of edge 3, or beside it: there is no way between without
/// contact. Each side has `cells`^2 squares.
struct CubeAndBox {
  explicit CubeAndBox(int cells)
      : cube(MakeBar(1, 1, 1, cells, cells, cells)), box(MakeBar(3, 3, 3, cells, cells, cells)) {
    around = {box.connectivity, box.pose(0)};
    connectivity = around.Joined(cube.connectivity);
  }
  /// Inside for x from 0 to 2.
  Shape At(double x) const {
    return around.Joined(Shape(cube.pose(0).colwise() + Eigen::Vector3d(x, 0.7, 0.8)));
  }
  ShapeFamily cube, box;
  Obstacle around;
  std::shared_ptr<const Connectivity> connectivity;
};

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_CONTACT_BODIES_H_
