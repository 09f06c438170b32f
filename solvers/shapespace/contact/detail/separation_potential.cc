#include <shapespace/contact/detail/separation_potential.h>

#include <algorithm>
#include <numeric>

#include <shapespace/base/parallel.h>

namespace shapespace::internal {
namespace {

// With fewer, a thin part may have none where it passes through another.
constexpr int kMostVertices = 400;

// Of each segment: with one time alone, parts would pass through each other between shapes.
constexpr int kTimes = 4;

// Pairs that are nearer in a pose than this share of the reach are of one part.
constexpr double kOfOnePart = 0.2;

}  // namespace

SeparationPotential::SeparationPotential(const Metric& metric, const std::vector<Shape>& poses,
                                         double reach) {
  const int vertices = metric.connectivity->NumVertices();
  const int stride = (vertices + kMostVertices - 1) / kMostVertices;
  double area = 0;
  for (int i = 0; i < vertices; i += stride) area += metric.vertex_area(i);
  for (int i = 0; i < vertices; i += stride) {
    for (int j = 0; j < i; j += stride) {
      double nearest = reach / 0.9;
      for (const Shape& pose : poses) {
        nearest = std::min(nearest, (pose.col(i) - pose.col(j)).norm());
      }
      if (nearest < kOfOnePart * reach) continue;
      const double weight = metric.vertex_area(i) * metric.vertex_area(j) / (area * area);
      pairs_.push_back({i, j, weight, 0.81 * nearest * nearest});
    }
  }
}

double SeparationPotential::Evaluate(const PathEnergy& energy, const double* unknowns,
                                     double factor, std::vector<Shape>* path, double* gradient) {
  energy.Store(unknowns, path);
  const std::vector<Shape>& shapes = *path;
  const int inner = energy.Inner(), stride = energy.Stride(), places = (inner + 1) * kTimes;
  std::vector<double> values(places, 0.);
  forces_.resize(places);
  const auto time_of = [](int place) { return static_cast<double>(place % kTimes) / kTimes; };
  ParallelFor(places, [&](int place) {
    const double time = time_of(place);
    const Shape& from = shapes[place / kTimes];
    const Shape shape = (1 - time) * from + time * shapes[place / kTimes + 1];
    forces_[place].setZero(3, shape.cols());
    for (const SeparationPair& pair : pairs_) values[place] += pair.Add(shape, &forces_[place]);
  });
  const double share = factor / places;
  for (int place = 0; place < places; ++place) {
    const double time = time_of(place);
    const int from = place / kTimes;
    for (int v = 0; v < shapes.front().cols(); ++v) {
      for (int axis = 0; axis < 3; ++axis) {
        double* const row = gradient + (3 * static_cast<size_t>(energy.Row(v)) + axis) * stride;
        const double force = share * forces_[place](axis, v);
        if (from > 0) row[from - 1] += (1 - time) * force;
        if (from < inner) row[from] += time * force;
      }
    }
  }
  return share * std::accumulate(values.begin(), values.end(), 0.);
}

}  // namespace shapespace::internal
