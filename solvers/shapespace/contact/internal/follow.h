#ifndef SHAPESPACE_CONTACT_INTERNAL_FOLLOW_H_
#define SHAPESPACE_CONTACT_INTERNAL_FOLLOW_H_

#include <functional>
#include <memory>
#include <vector>

#include <shapespace/contact/internal/contact_model.h>
#include <shapespace/sparse/internal/cholesky.h>

namespace shapespace::internal {

/// A sequence of shapes, each of which is reached from the one before on a straight way without
/// contact.
struct FreeWay {
  std::vector<Shape> shapes;
  bool arrives = false;  ///< whether the last shape is the one that was to be reached
  /// For each shape of the guide, as far as it was followed, the index of the shape that it led to.
  std::vector<size_t> reached;
};

/// When the approach to a shape ends.
struct ApproachEnd {
  double tolerance;  ///< as MinimiseOptions::tolerance
  int max_iterations;
};
/// For shapes on a way that is minimised as a whole afterwards.
constexpr ApproachEnd kRoughApproach = {1e-2, 100};
/// For shapes that are results, and distances that are mainly of position, of which a step gains a
/// small share.
constexpr ApproachEnd kCloseApproach = {1e-4, 300};

/// How a shape is drawn towards another.
struct Attraction {
  std::shared_ptr<const Metric> metric;  ///< of the distance, of the model's mesh and unit
  const CholeskyFactor<float>& factor;   ///< of its scalar metric
  ApproachEnd end;
};

/// For MinimiseOptions::keep_going of an approach: false after some steps in a row that gain less
/// than this share, because steps become short where parts press against each other.
std::function<bool(int iteration, double energy)> UntilLittleIsGained(double tolerance);

/// Follows `guide`, the shapes of a path with contact, from its first shape to its last: at each of
/// its shapes in turn, minimises the squared distance to it in shape space plus `stiffness` / 2
/// times the contact potential, such that nothing passes through anything on the way. So parts
/// slide round others that are in their way. `go_on` is asked before each minimisation, and false
/// ends the way there.
FreeWay Follow(const ContactModel& model, const Attraction& attraction, double stiffness,
               const std::vector<Shape>& guide, const std::function<bool()>& go_on);

/// Leaves out shapes of a free way past which the straight way is free too, those first that change
/// its length least, until it has `most_parts` straight parts, or each shape is needed.
std::vector<Shape> Shorten(const ContactModel& model, std::vector<Shape> way, int most_parts);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CONTACT_INTERNAL_FOLLOW_H_
