#include <shapespace/output/detail/vertex_numbers.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/output/internal/text.h>

namespace shapespace::internal {
namespace {

// How far beside a vertex, and before or behind it, the surface may be hit; the shape lies in the
// unit ball. A ray at a vertex of the outline itself may miss the surface.
constexpr double kBeside = 0.01;
constexpr float kNear = 0.02f;

bool IsVisible(const RayScene& scene, const Camera& camera, const Eigen::Vector3d& vertex) {
  constexpr float kDistance = 3;  // outside of the ball
  const Eigen::Vector3f eye = camera.axes.col(2).cast<float>();
  const Eigen::Vector3d right = kBeside * camera.axes.col(0), up = kBeside * camera.axes.col(1);
  for (const Eigen::Vector3d& beside :
       {Eigen::Vector3d(0, 0, 0), right, up, Eigen::Vector3d(-right), Eigen::Vector3d(-up)}) {
    const Eigen::Vector3f origin = (vertex + beside).cast<float>() + kDistance * eye;
    RayScene::Hit hit;
    if (scene.Trace(origin, -eye, &hit) && std::abs(hit.distance - kDistance) < kNear) return true;
  }
  return false;
}

}  // namespace

void DrawVertexNumbers(const RayScene& scene, const Shape& shape, const Camera& camera,
                       const Eigen::VectorXi& numbers, int text_size, int left, int top,
                       RgbImage* image) {
  const int rim = std::max(1, text_size / 8), height = LineHeight(text_size);
  const Eigen::AlignedBox2i frame(Eigen::Vector2i(left, top),
                                  Eigen::Vector2i(left + camera.width, top + camera.height));
  std::vector<Eigen::AlignedBox2i> taken;
  for (int v = 0; v < numbers.size(); ++v) {
    if (numbers(v) == 0 || !IsVisible(scene, camera, shape.col(v))) continue;
    const Eigen::Vector2d at =
        camera.pixels_per_unit *
        (camera.axes.leftCols<2>().transpose() * shape.col(v) - camera.centre);
    const Eigen::Vector2i place(left + static_cast<int>(camera.width / 2.0 + at.x()),
                                top + static_cast<int>(camera.height / 2.0 - at.y()));
    const std::string text = std::to_string(numbers(v));
    const int width = TextWidth(text, text_size);
    // Upper left corners of the text, relative to the vertex; the first that is free is taken.
    const int gap = text_size / 3;
    const Eigen::Vector2i sides[] = {{gap, -height},     {-width - gap, -height},
                                     {gap, 0},           {-width - gap, 0},
                                     {gap, -height / 2}, {-width - gap, -height / 2},
                                     {-width / 2, gap},  {-width / 2, -height - gap}};
    Eigen::AlignedBox2i best;
    for (const Eigen::Vector2i& side : sides) {
      const Eigen::AlignedBox2i box(place + side, place + side + Eigen::Vector2i(width, height));
      const bool is_free = frame.contains(box) &&
                           std::none_of(taken.begin(), taken.end(),
                                        [&](const auto& other) { return box.intersects(other); });
      if (!best.isEmpty() && !is_free) continue;
      best = box;
      if (is_free) break;
    }
    taken.push_back(best);
    DrawRimmedText(image, best.min().x(), best.min().y(), text, text_size, rim);
  }
}

}  // namespace shapespace::internal
