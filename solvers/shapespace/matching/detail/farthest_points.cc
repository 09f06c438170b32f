#include <shapespace/matching/detail/farthest_points.h>

#include <algorithm>
#include <limits>

#include <shapespace/base/internal/clones.h>

namespace shapespace::internal {
namespace {

// least[i] <- min(least[i], squared distance of point i from `from`); `rows` has a row of `count`
// numbers for each coordinate.
SHAPESPACE_CLONES
void LowerSquares(const float* rows, int dimensions, int count, const float* from, float* least) {
  constexpr int kChunk = 64;  // points whose sums stay in registers
  for (int begin = 0; begin < count; begin += kChunk) {
    const int size = std::min(kChunk, count - begin);
    float sums[kChunk] = {};
    for (int d = 0; d < dimensions; ++d) {
      const float* const row = rows + static_cast<size_t>(d) * count + begin;
      for (int i = 0; i < size; ++i) sums[i] += (row[i] - from[d]) * (row[i] - from[d]);
    }
    for (int i = 0; i < size; ++i) least[begin + i] = std::min(least[begin + i], sums[i]);
  }
}

}  // namespace

EvenSamples SampleEvenly(const SurfaceGraph& graph, const Shape& shape,
                         const Eigen::VectorXd& areas, int count, int among) {
  const Eigen::Vector3d centroid = shape * areas / areas.sum();
  Eigen::Index next;
  (shape.colwise() - centroid).colwise().squaredNorm().minCoeff(&next);
  graph.From(static_cast<int>(next)).head(among).maxCoeff(&next);
  EvenSamples samples;
  samples.distances.resize(graph.NumVertices(), std::min(count, among));
  Eigen::VectorXf least =
      Eigen::VectorXf::Constant(graph.NumVertices(), std::numeric_limits<float>::infinity());
  for (int k = 0; k < samples.distances.cols() && least(next) > 0; ++k) {
    samples.vertices.push_back(static_cast<int>(next));
    samples.distances.col(k) = graph.From(static_cast<int>(next));
    least = least.cwiseMin(samples.distances.col(k));
    least.head(among).maxCoeff(&next);
  }
  samples.distances.conservativeResize(Eigen::NoChange, samples.vertices.size());
  return samples;
}

std::vector<int> FarthestColumns(const Eigen::MatrixXf& points, int first, int count) {
  const Eigen::MatrixXf rows = points.transpose();
  const auto size = static_cast<int>(points.cols());
  Eigen::VectorXf least = Eigen::VectorXf::Constant(size, std::numeric_limits<float>::infinity());
  std::vector<int> chosen;
  for (Eigen::Index next = first; static_cast<int>(chosen.size()) < count && least(next) > 0;) {
    chosen.push_back(static_cast<int>(next));
    LowerSquares(rows.data(), static_cast<int>(points.rows()), size, points.col(next).data(),
                 least.data());
    least.maxCoeff(&next);
  }
  return chosen;
}

}  // namespace shapespace::internal
