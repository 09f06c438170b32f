#include <shapespace/contact/obstacle.h>

#include <utility>
#include <vector>

#include <shapespace/base/error.h>

namespace shapespace {

void Obstacle::Validate() const {
  if (connectivity == nullptr || connectivity->NumTriangles() == 0) {
    throw MeshError("obstacle: it has no triangles");
  }
  if (shape.cols() != connectivity->NumVertices() || !shape.allFinite()) {
    throw MeshError("obstacle: its shape is not finite, or has another number of vertices");
  }
}

std::shared_ptr<const Connectivity> Obstacle::Joined(
    const std::shared_ptr<const Connectivity>& body) const {
  Eigen::Matrix3Xi triangles(3, body->NumTriangles() + connectivity->NumTriangles());
  triangles << body->Triangles(),
      (connectivity->Triangles().array() + body->NumVertices()).matrix();
  std::vector<int> begin(triangles.cols() + 1);
  for (size_t t = 0; t < begin.size(); ++t) begin[t] = static_cast<int>(3 * t);
  std::vector<std::pair<int, int>> segments;
  const auto add = [&](const Connectivity& mesh, int first) {
    for (const auto& [a, b] : mesh.Segments()) {
      segments.emplace_back(first + mesh.Representative(a), first + mesh.Representative(b));
    }
  };
  add(*body, 0);
  add(*connectivity, body->NumVertices());
  return Connectivity::Make(body->NumVertices() + connectivity->NumVertices(), std::move(begin),
                            {triangles.data(), triangles.data() + triangles.size()}, segments);
}

Shape Obstacle::Joined(const Shape& body) const {
  Shape both(3, body.cols() + shape.cols());
  both << body, shape;
  return both;
}

void internal::CheckObstacle(const std::optional<Obstacle>& obstacle, bool avoid_contact) {
  if (!obstacle) return;
  if (!avoid_contact) {
    throw InvalidOptions("obstacle", "is for paths that avoid contact: set avoid_contact");
  }
  obstacle->Validate();
}

}  // namespace shapespace
