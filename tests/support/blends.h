#ifndef SHAPESPACE_TESTS_SUPPORT_BLENDS_H_
#define SHAPESPACE_TESTS_SUPPORT_BLENDS_H_

#include <vector>

#include <shapespace/metric/metric.h>

namespace shapespace::testing {

struct Blend {
  const char* name;
  MetricOptions options;
};

/// Metrics that together contain every feature, in both discretisations; for closed surfaces only.
inline std::vector<Blend> AllBlends() {
  MetricOptions membrane, everything, paper_with_bending = MetricOptions::Paper();
  membrane.bending = 0;
  everything.volume = 0.3;
  everything.isometric = 1;
  everything.strain = 0.3;
  paper_with_bending.bending = 1e-3;
  return {{"default", {}},
          {"membrane", membrane},
          {"isometric", MetricOptions::Isometric()},
          {"everything", everything},
          {"paper", MetricOptions::Paper()},
          {"paper with bending", paper_with_bending}};
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_BLENDS_H_
