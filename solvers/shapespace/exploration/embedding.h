#ifndef SHAPESPACE_EXPLORATION_EMBEDDING_H_
#define SHAPESPACE_EXPLORATION_EMBEDDING_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/base/not_computed.h>

namespace shapespace {

struct EmbeddingOptions {
  /// The majorisation ends when an iteration lowers the stress by less than this share of it.
  double tolerance = 1e-9;
  int max_iterations = 10000;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// Points of the plane that represent objects of which only the distances are known.
struct Embedding {
  Eigen::Matrix2Xd points;  ///< centred; the first axis is the direction of greatest extent
  /// sqrt(sum (|x_i - x_j| - d_ij)^2 / sum d_ij^2) over all pairs; 0 if the plane reproduces all
  /// distances (Kruskal's stress-1, normalised by the given distances).
  double stress = kNotComputed;
  std::vector<double> stresses;  ///< the same for the start and after every iteration; does not
                                 ///< increase
  bool converged = false;
};

/// Metric multidimensional scaling of symmetric `distances`, n x n: starts from classical scaling
/// (Torgerson 1952) and continues with stress majorisation by SMACOF (de Leeuw 1977; Borg and
/// Groenen, Modern Multidimensional Scaling, chapter 8), with all weights 1.
/// \throw InvalidOptions (options; distances that are not square, symmetric, finite and zero on the
///        diagonal, or negative).
Embedding Embed(const Eigen::MatrixXd& distances, const EmbeddingOptions& options = {});

}  // namespace shapespace

#endif  // SHAPESPACE_EXPLORATION_EMBEDDING_H_
