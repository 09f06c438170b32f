#ifndef SHAPESPACE_BODIES_QUADRUPED_H_
#define SHAPESPACE_BODIES_QUADRUPED_H_

#include <string>
#include <utility>
#include <vector>

#include <shapespace/bodies/skinned.h>

namespace shapespace {

/// Lengths and girths of a quadruped relative to the default, each in [0.3, 3].
struct QuadrupedForm {
  double body_length = 1, body_girth = 1;
  double neck_length = 1, neck_girth = 1;
  double head_size = 1;
  double ear_length = 1;
  double leg_length = 1, leg_girth = 1;
  double tail_length = 1;

  /// The names of the fields and their values.
  std::vector<std::pair<std::string, double>> Measures() const;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// The names for `NamedQuadrupedForm`: normal, long (like a giraffe), short (a dachshund), heavy (a
/// bear).
std::vector<std::string> QuadrupedProportions();

/// \throw InvalidOptions if the name is not known; the message lists those that are.
QuadrupedForm NamedQuadrupedForm(const std::string& name);

/// `form` with each measure multiplied by a random factor between 3/4 and 4/3, whose logarithm is
/// uniformly distributed, within the limits of a form. The same for the same seed on every machine.
QuadrupedForm RandomQuadrupedForm(const QuadrupedForm& form, unsigned seed);

/// The names of its poses.
std::vector<std::string> QuadrupedPoses();

/// An animal, about 1.7 high and 2 long: body, neck, head with ears, four legs and a tail. As in
/// glTF, y is up and it faces +z; its lowest point has y = 0. Closed, of genus 0, with about
/// `triangles` nearly equilateral triangles, which are smaller where it is thinner. Connectivity
/// and vertex order depend on `triangles` alone: other forms move the vertices, and their triangles
/// are less regular. With 20000 triangles no hinge of the default form is folded beyond 120 degrees
/// in any pose; in the other named forms up to 30 hinges are, behind the knees of the sitting pose.
/// \throw InvalidOptions if the form is not valid, or `triangles` is negative or above a million.
///        Fewer than 500 are taken as 500.
SkinnedBody MakeQuadruped(int triangles, const QuadrupedForm& form = {});

}  // namespace shapespace

#endif  // SHAPESPACE_BODIES_QUADRUPED_H_
