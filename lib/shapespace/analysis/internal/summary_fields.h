#ifndef SHAPESPACE_ANALYSIS_INTERNAL_SUMMARY_FIELDS_H_
#define SHAPESPACE_ANALYSIS_INTERNAL_SUMMARY_FIELDS_H_

#include <shapespace/analysis/path_intersections.h>
#include <shapespace/analysis/quality.h>
#include <shapespace/analysis/shape_error.h>
#include <shapespace/base/internal/fields.h>

// The fields of summaries (base/internal/fields.h).

namespace shapespace::internal {

template <typename Visit>
void ForFields(Of<PathQuality>, const Visit& visit) {
  visit("inner_shapes", &PathQuality::inner_shapes);
  visit("edge_rms", &PathQuality::edge_rms);
  visit("edge_p99", &PathQuality::edge_p99);
  visit("edge_max", &PathQuality::edge_max);
  visit("first_rms", &PathQuality::first_rms);
  visit("first_p99", &PathQuality::first_p99);
  visit("first_max", &PathQuality::first_max);
  visit("roughness", &PathQuality::roughness);
  visit("folds", &PathQuality::folds);
  visit("speed_max", &PathQuality::speed_max);
}

template <typename Visit>
void ForFields(Of<ShapeError>, const Visit& visit) {
  visit("edge_rms", &ShapeError::edge_rms);
  visit("edge_p99", &ShapeError::edge_p99);
  visit("edge_max", &ShapeError::edge_max);
  visit("volume", &ShapeError::volume);
  visit("inverted_hinges", &ShapeError::inverted_hinges);
}

template <typename Visit>
void ForFields(Of<PathIntersections>, const Visit& visit) {
  visit("pairs", &PathIntersections::pairs);
  visit("poses_max", &PathIntersections::poses_max);
  visit("inner_max", &PathIntersections::inner_max);
  visit("inner_mean", &PathIntersections::inner_mean);
  visit("beyond_poses", &PathIntersections::beyond_poses);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_ANALYSIS_INTERNAL_SUMMARY_FIELDS_H_
