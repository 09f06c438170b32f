#ifndef SHAPESPACE_STATISTICS_INTERNAL_SUMMARY_FIELDS_H_
#define SHAPESPACE_STATISTICS_INTERNAL_SUMMARY_FIELDS_H_

#include <shapespace/base/internal/fields.h>
#include <shapespace/statistics/assess.h>
#include <shapespace/statistics/regression.h>
#include <shapespace/summary/internal/report.h>

// The fields of summaries (base/internal/fields.h).

namespace shapespace::internal {

template <typename Visit>
void ForFields(Of<AverageSummary>, const Visit& visit) {
  visit("termination", &AverageSummary::termination);
  visit("converged", &AverageSummary::Converged);
  visit("vertices", &AverageSummary::vertices);
  visit("triangles", &AverageSummary::triangles);
  visit("poses", &AverageSummary::poses);
  visit("metric", &AverageSummary::metric);
  visit("unit", &AverageSummary::unit);
  visit("variance", &AverageSummary::variance);
  visit("residual", &AverageSummary::residual);
  visit("energy", &AverageSummary::energy);
  visit("lower_bound", &AverageSummary::lower_bound);
  visit("ratio", &AverageSummary::Ratio);
  visit("edge_rms", &AverageSummary::edge_rms);
  visit("ambiguous_hinges", &AverageSummary::ambiguous_hinges);
  visit("iterations", &AverageSummary::iterations);
  visit("refinements", &AverageSummary::refinements);
  visit("refined_by", &AverageSummary::refined_by);
  visit("estimated_bytes", &AverageSummary::estimated_bytes);
  visit("certificate_seconds", &AverageSummary::certificate_seconds);
  visit("total_seconds", &AverageSummary::total_seconds);
  visit("warnings", &AverageSummary::warnings);
}

template <typename Visit>
void ForFields(Of<ShapeModelSummary>, const Visit& visit) {
  visit("termination", [](const ShapeModelSummary& s) { return s.average.termination; });
  visit("converged", &ShapeModelSummary::Converged);
  visit("average", &ShapeModelSummary::average);
  visit("modes", &ShapeModelSummary::modes);
  visit("rank", &ShapeModelSummary::rank);
  visit("variances", &ShapeModelSummary::variances);
  visit("warnings", &ShapeModelSummary::warnings);
  visit("total_seconds", &ShapeModelSummary::total_seconds);
}

template <typename Visit>
void ForFields(Of<ModelQuality>, const Visit& visit) {
  visit("modes", &ModelQuality::modes);
  visit("compactness", &ModelQuality::compactness);
  visit("generalisation", &ModelQuality::generalisation);
  visit("generalisation_edges", &ModelQuality::generalisation_edges);
  visit("specificity", &ModelQuality::specificity);
  visit("beyond", &ModelQuality::beyond);
}

template <typename Visit>
void ForFields(Of<Assessment>, const Visit& visit) {
  visit("rows", &Assessment::rows);
  visit("poses", &Assessment::poses);
  visit("unconverged", &Assessment::unconverged);
  visit("total_seconds", &Assessment::total_seconds);
}

// Arrays of Eigen as lists; matrices as lists of their columns.
inline std::vector<double> ListOf(const Eigen::VectorXd& values) {
  return {values.begin(), values.end()};
}

template <typename Visit>
void ForFields(Of<Regression>, const Visit& visit) {
  visit("scalars", &Regression::scalars);
  visit("intercept", [](const Regression& r) { return ListOf(r.intercept); });
  visit("slopes", [](const Regression& r) {
    std::vector<std::vector<double>> slopes;
    for (const auto& column : r.slopes.colwise()) slopes.push_back(ListOf(column));
    return slopes;
  });
  visit("least", [](const Regression& r) { return ListOf(r.least); });
  visit("most", [](const Regression& r) { return ListOf(r.most); });
  visit("mean", [](const Regression& r) { return ListOf(r.mean); });
  visit("r_squared", &Regression::r_squared);
  visit("p_value", &Regression::p_value);
  visit("p_values", &Regression::p_values);
}

template <typename Visit>
void ForFields(Of<GroupDifference>, const Visit& visit) {
  visit("first", &GroupDifference::first);
  visit("second", &GroupDifference::second);
  visit("first_count", &GroupDifference::first_count);
  visit("second_count", &GroupDifference::second_count);
  visit("modes", &GroupDifference::modes);
  visit("t_squared", &GroupDifference::t_squared);
  visit("t_squared_p", &GroupDifference::t_squared_p);
  visit("distance", &GroupDifference::distance);
  visit("distance_p", &GroupDifference::distance_p);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_STATISTICS_INTERNAL_SUMMARY_FIELDS_H_
