#ifndef SHAPESPACE_MATCHING_DETAIL_LANDMARKS_H_
#define SHAPESPACE_MATCHING_DETAIL_LANDMARKS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/matching/detail/matching_body.h>

namespace shapespace::internal {

/// Descriptors of a body's vertices by its extremities and other known points, its landmarks.
class Landmarks {
 public:
  /// Landmarks are `vertices`, described are the vertices body.spread.
  Landmarks(const MatchingBody& body, std::vector<int> vertices);

  const std::vector<int>& Vertices() const { return vertices_; }

  /// Distances of the first `count` landmarks (rows) from each other, and from those behind the
  /// first `extremities`.
  Eigen::MatrixXd Between(int count, size_t extremities) const;

  /// A column for each vertex of body.spread: its distances d_i from the landmarks `chosen`, as
  /// shares of the mean distance of landmark i from the others, and the smoothed turns
  /// n . (grad d_i x grad d_j), which tell the front of a body from its back.
  Eigen::MatrixXf Describe(const std::vector<int>& chosen) const;

 private:
  std::vector<int> vertices_;
  Eigen::MatrixXf between_;    // landmarks x landmarks
  Eigen::MatrixXf distances_;  // vertices of body.spread x landmarks
  Eigen::MatrixXf turns_;      // vertices of body.spread x pairs i < j of landmarks
  Eigen::MatrixXi pair_;       // the column of turns_ for i < j
};

/// How different the surroundings of vertices of two bodies are: the mean absolute difference of
/// the logarithms of their heat kernel signatures (J. Sun, M. Ovsjanikov and L. Guibas, "A concise
/// and provably informative multi-scale signature based on heat diffusion", SGP 2009), at times
/// up to `last_time`, in units of the first body's area. The second body is larger by `scale`.
Eigen::MatrixXd HeatDifference(const Spectrum& first, const std::vector<int>& first_vertices,
                               const Spectrum& second, const std::vector<int>& second_vertices,
                               double last_time, double scale);

/// Until then heat tells how thin and long a limb is.
inline constexpr double kLimbTime = 0.3;

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_LANDMARKS_H_
