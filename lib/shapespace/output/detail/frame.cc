#include <shapespace/output/detail/frame.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/base/parallel.h>

namespace shapespace::internal {
namespace {

constexpr unsigned kBackgroundHex = 0xfafafa;
constexpr unsigned kFrontHex[] = {kPoseHex, 0x58a56b, 0x8b68bf};  // by ShapeRole
constexpr unsigned kBackHex = 0xf08030;
constexpr unsigned kMarkHex[] = {0x48484c, 0xd23c3c};  // of marks 1 and 2

// Factors for colours of values. On front faces slightly less than 1, because the lights add up to
// more than 1; on back faces dark enough to differ from the front, and light enough to be read.
constexpr float kFrontUnderValues = 0.8f, kBackUnderValues = 0.4f;

// Lights, in the camera's axes (right, up, towards the eye): a key light from the upper left, a
// fill light from the right, and a sky that is brighter above. Their sum slightly exceeds 1 on
// surfaces that face the key light.
const Eigen::Vector3f kKey = Eigen::Vector3f(-0.5f, 0.65f, 0.62f).normalized();
const Eigen::Vector3f kFill = Eigen::Vector3f(0.85f, 0.05f, 0.5f).normalized();
constexpr float kKeyLight = 0.95f;
constexpr float kFillLight = 0.17f;
constexpr float kSkyLight = 0.42f, kGroundLight = 0.1f;
constexpr float kGloss = 0.1f, kGlossExponent = 20;

// Half-width of the key light as seen from the body, for soft shadows.
constexpr float kKeySpread = 0.12f;
// Occluders farther away than this (in radii of the largest shape) are ignored.
constexpr float kOcclusionReach = 0.4f;
// Distance from the surface at which rays start (same unit), greater than the float error of a hit.
constexpr float kOffset = 3e-4f;

// Occlusion and shadow are sampled with few rays per pixel in a pattern that repeats every 4 x 4
// pixels, and averaged over such a square of the same surface: 128 and 64 rays per point at the
// cost of 8 and 4, without noise.
constexpr int kSkyRays = 8, kKeyRays = 4, kPattern = 4;

// The data of a pixel before occlusion is known.
struct Pixel {
  Colour sky = Colour::Zero();  // light to be reduced by occlusion
  Colour key = Colour::Zero();  // light to be reduced by shadow
  Colour rest = Colour::Zero();
  float coverage = 0;
  // Of one of the samples that hit; averages are taken over the same surface only.
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float distance = 0;
  float open_sky = 1, open_key = 1;
};

// Mirrors bits at the binary point: 1 -> 1/2, 2 -> 1/4, 3 -> 3/4 ...
float RadicalInverse(unsigned i) {
  float result = 0;
  for (float digit = 0.5f; i != 0; i >>= 1, digit /= 2) {
    if (i & 1) result += digit;
  }
  return result;
}

// Sample `i` of `count` in the unit square, for position `cell` of the pattern.
Eigen::Vector2f Sample(int i, int count, int cell) {
  const float shift = (cell + 0.5f) / (kPattern * kPattern);
  const float v = RadicalInverse(i) + RadicalInverse(cell) / count;
  return {(i + shift) / count, v};
}

Eigen::Vector2f ToDisk(const Eigen::Vector2f& sample) {
  const float angle = 2 * static_cast<float>(EIGEN_PI) * sample[1];
  return std::sqrt(sample[0]) * Eigen::Vector2f(std::cos(angle), std::sin(angle));
}

Eigen::Matrix3f FrameAround(const Eigen::Vector3f& normal) {
  Eigen::Matrix3f frame;
  frame.col(2) = normal;
  frame.col(0) = normal.unitOrthogonal();
  frame.col(1) = normal.cross(frame.col(0));
  return frame;
}

class FramePainter {
 public:
  FramePainter(const RayScene& scene, const Camera& camera, const Paint& paint)
      : scene_(scene),
        camera_(camera),
        axes_(camera.axes.cast<float>()),
        key_frame_(FrameAround(axes_ * kKey)),
        front_(FromHex(kFrontHex[static_cast<int>(paint.role)])),
        paint_(paint),
        pixels_(static_cast<size_t>(camera.width) * camera.height) {}

  void Trace(int row) {
    for (int column = 0; column < camera_.width; ++column) TracePixel(row, column);
  }

  // Of a pixel that the shape covers, at least in part, over the colour `behind` it.
  Colour Finished(int row, int column, const Colour& behind) const;

  bool IsCovered(int row, int column) const {
    return pixels_[static_cast<size_t>(row) * camera_.width + column].coverage > 0;
  }

 private:
  void TracePixel(int row, int column);
  void Shade(const RayScene::Hit& hit, Pixel* pixel) const;
  void TraceLight(const RayScene::Hit& hit, const Eigen::Vector3f& point, int cell,
                  Pixel* pixel) const;

  const RayScene& scene_;
  const Camera& camera_;
  const Eigen::Matrix3f axes_, key_frame_;
  const Colour front_;
  const Paint& paint_;
  std::vector<Pixel> pixels_;
};

void FramePainter::TracePixel(int row, int column) {
  Pixel& pixel = pixels_[static_cast<size_t>(row) * camera_.width + column];
  const int n = camera_.samples;
  RayScene::Hit hit, first;
  Eigen::Vector3f first_point = Eigen::Vector3f::Zero();
  int hits = 0;
  for (int s = 0; s < n * n; ++s) {
    // A grid sheared in both directions: no two samples share a column or a row, so that nearly
    // vertical and nearly horizontal outlines have n * n levels of grey instead of n.
    const int i = s % n, j = s / n;
    const double x = column + (i + (j + 0.5) / n) / n - 0.5 * camera_.width;
    const double y = 0.5 * camera_.height - row - (j + (i + 0.5) / n) / n;
    const Eigen::Vector3f origin =
        (camera_.axes * Eigen::Vector3d(camera_.centre.x() + x / camera_.pixels_per_unit,
                                        camera_.centre.y() + y / camera_.pixels_per_unit, 2))
            .cast<float>();
    if (!scene_.Trace(origin, -axes_.col(2), &hit)) continue;
    if (hits++ == 0) {
      first = hit;
      first_point = origin - hit.distance * axes_.col(2);
    }
    Shade(hit, &pixel);
  }
  if (hits == 0) return;
  const float share = 1.0f / (n * n);
  pixel.coverage = hits * share;
  pixel.sky *= share;
  pixel.key *= share;
  pixel.rest *= share;
  pixel.normal = first.normal;
  pixel.distance = first.distance;
  TraceLight(first, first_point, row % kPattern * kPattern + column % kPattern, &pixel);
}

void FramePainter::Shade(const RayScene::Hit& hit, Pixel* pixel) const {
  static const Colour back = FromHex(kBackHex);
  Colour colour = hit.back ? back : front_;
  if (!hit.back && paint_.marks.size() > 0 && paint_.marks(hit.vertex) > 0) {
    colour = FromHex(kMarkHex[paint_.marks(hit.vertex) - 1]);
  }
  if (paint_.show_values || paint_.groups.size() > 0) {
    colour = (hit.back ? kBackUnderValues : kFrontUnderValues) *
             (paint_.show_values ? ValueColour(hit.value) : GroupColour(paint_.groups(hit.vertex)));
  }
  const Eigen::Vector3f normal = axes_.transpose() * hit.normal;
  const float sky = 0.5f + 0.5f * normal.y();
  const float key = std::max(0.0f, normal.dot(kKey));
  const float fill = std::max(0.0f, normal.dot(kFill));
  static const Eigen::Vector3f half = (kKey + Eigen::Vector3f::UnitZ()).normalized();
  const float gloss = kGloss * std::pow(std::max(0.0f, normal.dot(half)), kGlossExponent);
  pixel->sky += (sky * kSkyLight + (1 - sky) * kGroundLight) * colour;
  pixel->key += kKeyLight * key * colour + Colour::Constant(key > 0 ? gloss : 0);
  pixel->rest += kFillLight * fill * colour;
}

void FramePainter::TraceLight(const RayScene::Hit& hit, const Eigen::Vector3f& point, int cell,
                              Pixel* pixel) const {
  const Eigen::Vector3f origin = point + kOffset * hit.face_normal;
  const Eigen::Matrix3f around = FrameAround(hit.normal);
  int open = 0;
  for (int i = 0; i < kSkyRays; ++i) {
    const Eigen::Vector2f disk = ToDisk(Sample(i, kSkyRays, cell));
    Eigen::Vector3f local;
    local << disk, std::sqrt(std::max(0.0f, 1 - disk.squaredNorm()));
    const Eigen::Vector3f direction = around * local;
    open +=
        direction.dot(hit.face_normal) > 0 && !scene_.Blocked(origin, direction, kOcclusionReach);
  }
  pixel->open_sky = static_cast<float>(open) / kSkyRays;

  open = 0;
  for (int i = 0; i < kKeyRays; ++i) {
    Eigen::Vector3f local;
    local << kKeySpread * ToDisk(Sample(i, kKeyRays, cell)), 1;
    const Eigen::Vector3f direction = (key_frame_ * local).normalized();
    open += direction.dot(hit.face_normal) > 0 && !scene_.Blocked(origin, direction, 4);
  }
  pixel->open_key = static_cast<float>(open) / kKeyRays;
}

Colour FramePainter::Finished(int row, int column, const Colour& behind) const {
  const Pixel& pixel = pixels_[static_cast<size_t>(row) * camera_.width + column];
  // The ends have half the weight, so that every position of the pattern has the same weight.
  constexpr float kWeights[] = {0.5f, 1, 1, 1, 0.5f};
  const float depth_range = 6 / static_cast<float>(camera_.pixels_per_unit);
  float sky = 0, key = 0, total = 0;
  for (int i = std::max(0, row - 2); i <= std::min(camera_.height - 1, row + 2); ++i) {
    for (int j = std::max(0, column - 2); j <= std::min(camera_.width - 1, column + 2); ++j) {
      const Pixel& other = pixels_[static_cast<size_t>(i) * camera_.width + j];
      if (other.coverage == 0 || other.normal.dot(pixel.normal) < 0.7f ||
          std::abs(other.distance - pixel.distance) > depth_range) {
        continue;
      }
      const float weight = kWeights[i - row + 2] * kWeights[j - column + 2];
      sky += weight * other.open_sky;
      key += weight * other.open_key;
      total += weight;
    }
  }
  return pixel.sky * (sky / total) + pixel.key * (key / total) + pixel.rest +
         (1 - pixel.coverage) * behind;
}

}  // namespace

Colour Background() {
  static const Colour background = FromHex(kBackgroundHex);
  return background;
}

void DrawFrame(const RayScene& scene, const Camera& camera, const Paint& paint, int left, int top,
               RgbImage* image) {
  FramePainter painter(scene, camera, paint);
  ParallelFor(camera.height, [&](int row) { painter.Trace(row); });
  ParallelFor(camera.height, [&](int row) {
    unsigned char* out = &image->pixels[3 * (static_cast<size_t>(top + row) * image->width + left)];
    for (int column = 0; column < camera.width; ++column, out += 3) {
      if (!painter.IsCovered(row, column)) continue;
      const Colour behind(ToLinear(out[0] / 255.0f), ToLinear(out[1] / 255.0f),
                          ToLinear(out[2] / 255.0f));
      const Colour colour = painter.Finished(row, column, behind);
      for (int k = 0; k < 3; ++k) out[k] = ToByte(colour[k]);
    }
  });
}

}  // namespace shapespace::internal
