#ifndef SHAPESPACE_MATCHING_DETAIL_EXTREMITIES_H_
#define SHAPESPACE_MATCHING_DETAIL_EXTREMITIES_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/matching/detail/farthest_points.h>
#include <shapespace/matching/detail/surface_graph.h>

namespace shapespace::internal {

/// A vertex at the end of a part that sticks out.
struct Extremity {
  int vertex = -1;
  double persistence = 0;
};

/// The extremities of a connected surface: local maxima of the mean distance from all of it, which
/// a sum over the samples stands for, weighted by the areas that are nearest to each. A maximum's
/// persistence is the difference between the value there and at the saddle where its surroundings
/// meet those of a higher one (H. Edelsbrunner, D. Letscher and A. Zomorodian, "Topological
/// persistence and simplification", 2002); the highest maximum's, that between it and the minimum.
/// Those whose persistence is greater than `least`, the most persistent ones first.
std::vector<Extremity> FindExtremities(const SurfaceGraph& graph, const EvenSamples& samples,
                                       const Eigen::VectorXd& areas, double least);

/// The vertices of those with which matching works: ends of limbs, tail and head, but not fingers
/// and ears. \param extremities in descending order of persistence.
std::vector<int> PrincipalExtremities(const std::vector<Extremity>& extremities);

/// The vertices of those that stick out less but are no fingers: snouts of animals with long ears,
/// ears of others.
std::vector<int> MinorExtremities(const std::vector<Extremity>& extremities);

/// Persistence above which an extremity is sought at all, as a share of the root of the area.
/// Fingers and toes have 0.02 to 0.05.
inline constexpr double kLeastPersistence = 0.02;

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_EXTREMITIES_H_
