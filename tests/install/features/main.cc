// Computes the lower bound of the energy between two poses, which are read from files, under a
// metric with a feature that is defined here.
#include <cmath>
#include <cstdio>

#include <shapespace/files/read.h>
#include <shapespace/metric/define_feature.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/energy.h>

// The length of every edge.
struct Length : shapespace::ElementFeature<2, 1> {
  static constexpr const char* kName = "length";

  static Length Freeze(const shapespace::MetricBasis& basis) {
    Length feature;
    feature.stencils = basis.connectivity->Edges();
    feature.weights = basis.edge_area;
    return feature;
  }

  template <typename T>
  void operator()(const T* x, T* value) const {
    using std::sqrt;
    T square(0);
    for (int axis = 0; axis < 3; ++axis)
      square += (x[3 + axis] - x[axis]) * (x[3 + axis] - x[axis]);
    value[0] = sqrt(square);
  }
};

int main(int, char** arguments) {
  shapespace::RegisterFeature<Length>();
  const shapespace::Poses poses = shapespace::ReadPoses({arguments[1], arguments[2]});
  shapespace::MetricOptions options;
  options.features = {{"length", 1.0}};
  const auto metric = shapespace::FreezeMetric(options, poses.connectivity, poses.shapes);
  const double bound = shapespace::EnergyLowerBound(*metric, poses.shapes[0] / metric->unit,
                                                    poses.shapes[1] / metric->unit, 1);
  std::printf("lower bound %g\n", bound);
  return bound > 0 ? 0 : 1;
}
