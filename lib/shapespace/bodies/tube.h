#ifndef SHAPESPACE_BODIES_TUBE_H_
#define SHAPESPACE_BODIES_TUBE_H_

#include <shapespace/bodies/body.h>

namespace shapespace {

/// The form of a tube at rest: round, with hemispherical caps, tapered, and slightly thicker at its
/// two joints. The default is similar to a finger.
struct TubeForm {
  double length = 6;          ///< between the centres of the caps
  double base_radius = 0.62;  ///< of the cap that stays in place
  double tip_radius = 0.48;   ///< of the cap that moves
  double knuckle = 0.06;      ///< added to the radius at the middle of the joints; 0: a plain cone

  /// \throw InvalidOptions naming the field: length or radii not positive and finite, or differing
  ///        by more than a factor of 10000; the knuckle negative or larger than all of these.
  void Validate() const;
};

/// A closed tube along x that bends like a finger, of about `triangles` triangles with sides in
/// proportion to the radius. `pose(angle)` bends it by a total angle in degrees, somewhat more at
/// the joint near the base than at the other. The base stays in place, its cap's centre at the
/// origin; the tip rises to +z. Cross-sections stay round and normal to the centre line, which
/// keeps its length, so that the smooth body keeps its volume. The range ends at 150 degrees, or
/// earlier in thick short tubes: the inner side of a joint keeps at least a tenth of its length.
/// \throw InvalidOptions if the form is not valid, or `triangles` is negative or above 20 million.
///        Fewer than 50 are taken as 50.
ShapeFamily MakeTube(int triangles, const TubeForm& form = {});

}  // namespace shapespace

#endif  // SHAPESPACE_BODIES_TUBE_H_
