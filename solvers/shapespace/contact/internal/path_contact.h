#ifndef SHAPESPACE_CONTACT_INTERNAL_PATH_CONTACT_H_
#define SHAPESPACE_CONTACT_INTERNAL_PATH_CONTACT_H_

#include <vector>

#include <shapespace/contact/detail/motion_contact.h>
#include <shapespace/minimise/internal/minimise.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {

/// The contact potential of a path in the layout of a PathEnergy, for MinimiseThreadedLbfgs: the
/// mean over straight motions from one of its shapes to another.
///
/// Pairs that touch between the times of their potential get twice as many times, so that the paths
/// that `Allows` admits are free of contact at all times.
class PathContact {
 public:
  /// A motion, by the indices of its first and its last shape, which may be the same.
  struct Motion {
    int from, to;
  };
  /// Times of each segment in the relaxation of a path, at first.
  static constexpr int kTimes = 10;
  /// From each of `num_shapes` to the next.
  static std::vector<Motion> Segments(int num_shapes);

  /// During the motions between `shapes` nothing touches; the first and the last shape do not move.
  /// `model` and `energy` are kept by reference. Each pair begins with `times` times.
  PathContact(const ContactModel& model, const PathEnergy& energy, std::vector<Shape> shapes,
              std::vector<Motion> motions, int times);

  /// The potential. Its derivatives, times `factor`, are added to `gradient`.
  double Evaluate(const double* unknowns, double factor, double* gradient);
  /// As MinimiseOptions::longest_step.
  double LongestStep(const double* unknowns, const float* direction);
  /// As MinimiseOptions::allows: whether nothing touches anything.
  bool Allows(const double* unknowns);
  /// Sets these two, by reference to this object.
  void Limit(MinimiseOptions* options);

 private:
  int NumMotions() const { return static_cast<int>(motions_.size()); }

  const PathEnergy& energy_;
  const double mean_length_;
  std::vector<Shape> shapes_;
  std::vector<Shape> allowed_;    // the last path from which a step was taken
  std::vector<Tangent> changes_;  // zero at the ends
  std::vector<double> directions_;
  const std::vector<Motion> motions_;
  std::vector<MotionContact> contacts_;           // by motion
  std::vector<std::vector<VertexForce>> forces_;  // by motion
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CONTACT_INTERNAL_PATH_CONTACT_H_
