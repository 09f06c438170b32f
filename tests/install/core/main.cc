// Computes the lower bound of the energy between two poses, which are read from files.
#include <cstdio>

#include <shapespace/files/read.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/energy.h>

int main(int, char** arguments) {
  const shapespace::Poses poses = shapespace::ReadPoses({arguments[1], arguments[2]});
  const auto metric = shapespace::FreezeMetric(shapespace::MetricOptions::Isometric(),
                                               poses.connectivity, poses.shapes);
  const double bound = shapespace::EnergyLowerBound(*metric, poses.shapes[0] / metric->unit,
                                                    poses.shapes[1] / metric->unit, 1);
  std::printf("lower bound %g\n", bound);
  return bound > 0 ? 0 : 1;
}
