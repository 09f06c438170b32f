#include <shapespace/statistics/shape_model.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include <Eigen/Cholesky>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/random.h>
#include <shapespace/exponential/internal/nearest_shape.h>
#include <shapespace/exponential/internal/step.h>
#include <shapespace/mesh/different_meshes.h>
#include <shapespace/statistics/detail/feature_statistics.h>
#include <shapespace/statistics/detail/logarithms.h>
#include <shapespace/statistics/detail/size.h>
#include <shapespace/statistics/detail/triangle_preview.h>

namespace shapespace {
namespace {

// An iteration that lowers the squared distance of the features by less than this share of the
// poses' variance ends the search for a shape.
constexpr double kTolerance = 1e-10;
constexpr int kMaxIterations = 100;

// A round of a fit that lowers the squared distance by less than this share is the last.
constexpr double kLeastGain = 1e-3;
constexpr int kMaxRounds = 6;

}  // namespace

class ShapeModel::Solver {
 public:
  explicit Solver(PoseModes modes)
      : modes_(Validated(std::move(modes))),
        map_(modes_.metric),
        statistics_(map_, modes_.poses, modes_.weights),
        chart_(map_, statistics_.Mean()),
        changes_(Eigen::MatrixXd::Zero(chart_.Centre().size(), modes_.NumModes())),
        logarithms_(map_, chart_, modes_.mean),
        preview_(modes_) {
    for (int i = 0; i < modes_.NumPoses(); ++i) {
      const Eigen::VectorXd relative = chart_.Log(map_.Values(modes_.poses[i]));
      for (int k = 0; k < modes_.NumModes(); ++k) {
        changes_.col(k) += modes_.coefficients(i, k) * relative;
      }
    }
  }

  const PoseModes& Modes() const { return modes_; }

  void Check(const Eigen::VectorXd& coordinates) const {
    if (coordinates.size() > modes_.NumModes()) {
      throw InvalidOptions("coordinates", "must be at most " + std::to_string(modes_.NumModes()) +
                                              ", one for each mode, not " +
                                              std::to_string(coordinates.size()));
    }
    if (!coordinates.allFinite()) throw InvalidOptions("coordinates", "must be finite");
  }

  Shape Preview(const Eigen::VectorXd& coordinates) const { return preview_.At(coordinates); }

  // In the metric's unit. `solver` has the factor of the last iteration's metric.
  internal::NearestShape At(const Eigen::VectorXd& coordinates, Progress* progress,
                            internal::MetricSolver* solver) const {
    const Eigen::VectorXd wanted = chart_.Exp(changes_.leftCols(coordinates.size()) * coordinates);
    const double rounding = 1e3 * std::numeric_limits<double>::epsilon() * wanted.norm();
    const double least = std::max(kTolerance * statistics_.Variance(), rounding * rounding);
    return internal::FindNearestShape(
        map_, wanted, preview_.At(coordinates), {least, kMaxIterations},
        [&] { ReportProgress(progress, "finding the shape", 0, 0); }, solver);
  }

  // To the frame of the model.
  Shape Centred(const Shape& shape) const {
    const Metric& metric = *modes_.metric;
    const double scale = modes_.size == PoseSize::kKeep
                             ? 1 / metric.unit
                             : internal::Size(*metric.connectivity, modes_.poses[0]) /
                                   internal::Size(*metric.connectivity, shape);
    const Shape centred = shape.colwise() - Centroid(shape, metric.vertex_area);
    return FitRigidMotion(scale * centred, modes_.mean, metric.vertex_area)(scale * centred);
  }

  // Of a shape in the frame of the model.
  Eigen::VectorXd Coordinates(const Shape& shape, int count) const {
    const Tangent weighted =
        logarithms_.Of(chart_.Log(map_.Values(shape))) * modes_.metric->vertex_area.asDiagonal();
    Eigen::VectorXd coordinates(count);
    for (int k = 0; k < count; ++k) {
      coordinates(k) = weighted.cwiseProduct(modes_.modes[k]).sum() / modes_.variances(k);
    }
    return coordinates;
  }

  // The derivatives, by the coordinates, of the shape that has been found at them.
  std::vector<Tangent> Derivatives(const Shape& shape, int count,
                                   internal::MetricSolver* solver) const {
    const Eigen::VectorXd values = map_.Values(shape);
    const FeatureDerivative derivative = map_.Derivative(shape);
    solver->Factor(derivative);
    std::vector<Tangent> derivatives;
    for (int k = 0; k < count; ++k) {
      derivatives.push_back(internal::SolveMetric(
          derivative, derivative.TransposeTimes(chart_.ChangeAt(values, changes_.col(k))), solver));
      internal::RemoveRigidPart(shape, modes_.metric->vertex_area, &derivatives.back());
      modes_.metric->connectivity->CopyToTwins(&derivatives.back());
    }
    return derivatives;
  }

 private:
  static PoseModes Validated(PoseModes modes) {
    modes.Validate();
    return modes;
  }

  const PoseModes modes_;
  const FeatureMap map_;
  const internal::FeatureStatistics statistics_;
  const internal::FeatureChart chart_;
  Eigen::MatrixXd changes_;  // of the features, by one standard deviation: a column per mode
  const internal::Logarithms logarithms_;
  const internal::TrianglePreview preview_;
};

ShapeModel::ShapeModel(PoseModes modes) : solver_(new Solver(std::move(modes))) {}
ShapeModel::~ShapeModel() = default;
ShapeModel::ShapeModel(ShapeModel&&) noexcept = default;

const PoseModes& ShapeModel::Modes() const { return solver_->Modes(); }

Shape ShapeModel::Placed(const Shape& shape) const {
  Shape placed = Modes().place(Modes().metric->unit * shape);
  Modes().metric->connectivity->CopyToTwins(&placed);
  return placed;
}

ModelShape ShapeModel::At(const Eigen::VectorXd& coordinates, Progress* progress) const {
  solver_->Check(coordinates);
  internal::MetricSolver solver;
  internal::NearestShape nearest = solver_->At(coordinates, progress, &solver);
  ModelShape result;
  result.shape = Placed(nearest.shape);
  result.iterations = nearest.iterations;
  result.termination = nearest.termination;
  return result;
}

Shape ShapeModel::Preview(const Eigen::VectorXd& coordinates) const {
  solver_->Check(coordinates);
  return Placed(solver_->Preview(coordinates));
}

ModelCoordinates ShapeModel::Coordinates(const Shape& shape, bool fit, int modes,
                                         Progress* progress) const {
  const Metric& metric = *Modes().metric;
  const int vertices = metric.connectivity->NumVertices();
  if (shape.cols() != vertices) {
    throw MeshError(internal::OfOtherMesh("the shape", shape.cols(), vertices));
  }
  if (!shape.allFinite()) throw MeshError("the shape has a coordinate that is not finite");
  if (modes < 0 || modes > Modes().NumModes()) {
    throw InvalidOptions("modes", "must be from 0 to " + std::to_string(Modes().NumModes()));
  }
  if (modes == 0) modes = Modes().NumModes();
  const Shape target = solver_->Centred(shape);
  const double area = metric.vertex_area.sum();
  internal::MetricSolver solver;
  // The shape at coordinates, moved rigidly onto the target.
  const auto shape_at = [&](const Eigen::VectorXd& coordinates) {
    const Shape found = solver_->At(coordinates, progress, &solver).shape;
    return FitRigidMotion(found, target, metric.vertex_area)(found);
  };
  const auto squared_distance = [&](const Shape& found) {
    return (found - target).colwise().squaredNorm().dot(metric.vertex_area) / area;
  };
  ModelCoordinates result;
  result.coordinates = solver_->Coordinates(target, modes);
  Shape best = shape_at(result.coordinates);
  double least = squared_distance(best);
  while (fit && modes > 0 && result.rounds < kMaxRounds) {
    ++result.rounds;
    const std::vector<Tangent> derivatives = solver_->Derivatives(best, modes, &solver);
    Eigen::MatrixXd normal(modes, modes);
    Eigen::VectorXd gradient(modes);
    for (int k = 0; k < modes; ++k) {
      const Tangent weighted = derivatives[k] * metric.vertex_area.asDiagonal();
      gradient(k) = weighted.cwiseProduct(target - best).sum();
      for (int l = 0; l < modes; ++l) {
        normal(k, l) = weighted.cwiseProduct(derivatives[l]).sum();
      }
    }
    const Eigen::VectorXd step = normal.ldlt().solve(gradient);
    if (!step.allFinite()) break;
    const Shape trial = shape_at(result.coordinates + step);
    const double squared = squared_distance(trial);
    if (!(squared < least)) break;
    const bool last = squared > (1 - kLeastGain) * least;
    result.coordinates += step;
    best = trial;
    least = squared;
    if (last) break;
  }
  // Back onto the given shape, which may be of another size.
  const double scale = Modes().size == PoseSize::kKeep
                           ? metric.unit
                           : internal::Size(*metric.connectivity, shape) /
                                 internal::Size(*metric.connectivity, Modes().poses[0]);
  result.shape = FitRigidMotion(scale * best, shape, metric.vertex_area)(scale * best);
  metric.connectivity->CopyToTwins(&result.shape);
  result.distance = scale * std::sqrt(least);
  return result;
}

Eigen::VectorXd ShapeModel::Sample(unsigned seed) const {
  // Normally distributed numbers of Box and Muller (1958), which need uniform ones above 0.
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return internal::Uniform(&random) + 0x1p-54; };
  Eigen::VectorXd coordinates(Modes().NumModes());
  for (double& coordinate : coordinates) {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    coordinate = radius * std::cos(2 * M_PI * uniform());
  }
  return coordinates;
}

}  // namespace shapespace
