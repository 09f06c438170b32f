#ifndef SHAPESPACE_CONTACT_DETAIL_MOTION_CONTACT_H_
#define SHAPESPACE_CONTACT_DETAIL_MOTION_CONTACT_H_

#include <array>
#include <map>
#include <utility>
#include <vector>

#include <shapespace/contact/internal/contact_model.h>

namespace shapespace::internal {

/// The derivative of a potential with respect to a vertex of the body at both ends of a motion.
struct VertexForce {
  int vertex;
  Eigen::Vector3d from, to;
};

/// The greatest length of a tangent's vectors.
double GreatestNorm(const Tangent& tangent);

/// The contact potential of a straight motion from one shape to another: the sum over all pairs
/// (pair_potential.h) of the mean over equidistant times, the first of which is the beginning and
/// the last of which is before the end. Keeps a list of the pairs that are near to each other as
/// long as shapes do not move much.
class MotionContact {
 public:
  /// Each pair begins with `times` times. `model` is kept by reference.
  MotionContact(const ContactModel& model, int times) : model_(model), times_(times) {}

  /// Prepares for motions whose shapes differ from these in no vertex by more than `room`.
  void Prepare(const Shape& from, const Shape& to, double room);
  /// How much further vertices may move from these shapes than they have since `Prepare`; negative
  /// if they have moved too far.
  double Room(const Shape& from, const Shape& to) const;

  // What follows is valid while there is room.

  /// The potential. Derivatives are appended to `forces` unless that is null.
  double Evaluate(const Shape& from, const Shape& to, std::vector<VertexForce>* forces) const;

  /// A step up to which, in all of the times, every pair keeps some of its distance while the
  /// shapes change by the step times these tangents.
  double SafeStep(const Shape& from, const Shape& to, const Tangent& from_change,
                  const Tangent& to_change) const;

  /// The pairs that touch at some time of the motion, also between those of the potential.
  std::vector<NearPair> Touching(const Shape& from, const Shape& to) const;

  /// Doubles the number of times of some pairs, unless it is too large already; `Prepare` is to be
  /// called next.
  void Refine(const std::vector<NearPair>& pairs);

 private:
  struct Entry {
    NearPair pair;
    PairPotential potential;
    int times;
    // The least distance during the prepared motion, or less, minus the potential's reach. While
    // vertices have moved by less than half of it, the pair has no potential.
    double excess;

    /// The first and the last of the times at which the pair may have a potential.
    int FirstTime() const;
    int LastTime() const;
  };

  double Displacement(const Shape& from, const Shape& to) const;
  /// The first entries, which may have a potential.
  size_t NumActive(const Shape& from, const Shape& to) const;

  const ContactModel& model_;
  const int times_;
  // Of the pairs that were refined.
  std::map<std::pair<PairKind, std::array<int, 4>>, int> refined_;
  Shape from_, to_;  // prepared
  double room_ = -1;
  std::vector<Entry> entries_;  // by excess
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CONTACT_DETAIL_MOTION_CONTACT_H_
