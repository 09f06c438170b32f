#include <shapespace/matching/detail/zoomout.h>

#include <algorithm>

#include <Eigen/Cholesky>

#include <shapespace/matching/detail/nearest_columns.h>

namespace shapespace::internal {
namespace {

// Added to the squares of functions in the least-squares fit, as a share of the number of samples;
// functions have a mean square of about 1.
constexpr double kMapRidge = 1e-6;

// The first `rows` numbers of some columns.
Eigen::MatrixXf Gather(const Eigen::MatrixXf& columns, int rows, const std::vector<int>& which) {
  Eigen::MatrixXf gathered(rows, which.size());
  for (size_t i = 0; i < which.size(); ++i) gathered.col(i) = columns.col(which[i]).head(rows);
  return gathered;
}

}  // namespace

SpectralPoints::SpectralPoints(const Spectrum& spectrum, const std::vector<int>& vertices,
                               int samples, const std::vector<int>& counts)
    : samples_(std::min(samples, static_cast<int>(vertices.size()))) {
  const int most = *std::max_element(counts.begin(), counts.end());
  Eigen::MatrixXd functions(most, vertices.size());
  for (size_t i = 0; i < vertices.size(); ++i) {
    functions.col(i) = spectrum.functions.row(vertices[i]).head(most).transpose();
  }
  for (const int count : counts) {
    const auto sampled = functions.topLeftCorner(count, samples_);
    Eigen::MatrixXd squares = sampled * sampled.transpose();
    squares.diagonal().array() += kMapRidge * samples_;
    inverses_[count] = squares.llt().solve(sampled).cast<float>();
  }
  functions_ = functions.cast<float>();
}

Eigen::MatrixXf SpectralPoints::Coefficients(int count, const Eigen::MatrixXf& values) const {
  return inverses_.at(count) * values.transpose();
}

void ZoomOut(const SpectralPoints& on_template, const SpectralPoints& on_target, int count,
             SpectralMap* map) {
  map->from_target =
      on_template.Coefficients(count, Gather(on_target.Functions(), count, map->to_target));
  map->from_template =
      on_target.Coefficients(count, Gather(on_template.Functions(), count, map->to_template));
  const AlignedPoints points = Align(on_template.Functions(), on_target.Functions(), *map);
  map->to_target =
      NearestColumns(points.on_template.leftCols(on_template.NumSamples()), points.on_target);
  map->to_template =
      NearestColumns(points.on_target.leftCols(on_target.NumSamples()), points.on_template);
}

void ZoomOutFromPart(const SpectralPoints& on_template, const SpectralPoints& on_target, int count,
                     int target_count, SpectralMap* map) {
  const Eigen::MatrixXf pulled = on_target.Coefficients(
      target_count, Gather(on_template.Functions(), count, map->to_template));
  map->from_target = pulled.transpose();
  // The target's functions, 0 outside of it, have these shares of the template's: their integrals
  // are over an area that is scale^2 of the template's.
  map->from_template = static_cast<float>(map->scale * map->scale) * pulled;
  const AlignedPoints points = Align(on_template.Functions(), on_target.Functions(), *map);
  map->to_template =
      NearestColumns(points.on_target.leftCols(on_target.NumSamples()), points.on_template);
}

AlignedPoints Align(const Eigen::MatrixXf& template_functions,
                    const Eigen::MatrixXf& target_functions, const SpectralMap& map) {
  const Eigen::Index count = map.from_target.rows(), target_count = map.from_target.cols();
  const auto first = template_functions.topRows(count),
             second = target_functions.topRows(target_count);
  AlignedPoints points;
  points.on_template.resize(count + target_count, first.cols());
  points.on_template.topRows(count) = first;
  points.on_template.bottomRows(target_count).noalias() = map.from_template * first;
  points.on_target.resize(count + target_count, second.cols());
  points.on_target.topRows(count).noalias() = map.from_target * second;
  points.on_target.bottomRows(target_count) = second;
  return points;
}

}  // namespace shapespace::internal
