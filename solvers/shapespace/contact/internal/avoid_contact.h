#ifndef SHAPESPACE_CONTACT_INTERNAL_AVOID_CONTACT_H_
#define SHAPESPACE_CONTACT_INTERNAL_AVOID_CONTACT_H_

#include <functional>
#include <string>
#include <vector>

#include <shapespace/contact/internal/contact_model.h>
#include <shapespace/minimise/internal/minimise.h>
#include <shapespace/sparse/internal/cholesky.h>

namespace shapespace::internal {

/// The weight of contact, as a multiple of the energy of the path with contact. With a tenth of it
/// parts come so near to each other that they touch between the times of the potential. Past an
/// obstacle, which may be in the way of a rigid motion without energy, of that of the free way.
constexpr double kContactStiffness = 3;

/// Of more pairs of intersecting triangles than in the poses, solves without contact warn. Fewer
/// hardly show: folded skin between limbs that come near to each other.
constexpr double kManyIntersections = 5;

/// A path during which nothing touches, if one was found.
struct ContactFreePath {
  std::vector<Shape> shapes;  ///< empty if there is none
  int parts = 0;              ///< if it needs more straight parts than there are to be segments
  MinimiseResult result;      ///< of the energy with the contact potential
};

/// Half the squared length of a polyline, the energy of a path along it with constant speed.
double EnergyAlong(const Metric& metric, const std::vector<Shape>& shapes);

/// Divides the straight ways between `states` into `segments` parts in all, as many or more, so
/// that the longest is short.
std::vector<Shape> Divide(const Metric& metric, const std::vector<Shape>& states, int segments);

/// The segments during whose straight motion something touches.
std::vector<int> SegmentsWithContact(const ContactModel& model, const std::vector<Shape>& shapes);

/// The least distance of two parts at some times of each segment, in the user's unit; NaN if none
/// come nearer than the potential reaches.
double LeastDistance(const ContactModel& model, const std::vector<Shape>& shapes);

/// The coarsest level up to `finest` on which to begin: it has enough detail, and the poses of its
/// model intersect at no more than `intersections` places, as many as those of the mesh.
int FirstLevelOfContact(int finest, int intersections,
                        const std::function<ContactModel(int level)>& model);

/// Warnings: that contact is not avoided at the intersections of `model`, whose poses `what` names
/// with a verb ("the mesh intersects itself"); that segments are not certified.
std::string WarningOfIntersections(const std::string& what, const ContactModel& model);
std::string WarningOfUncertified(int segments);

/// Finds a way from the first shape of `guide` to its last round whatever is touched in between,
/// starting at one of the ends (`Follow`), if need be of a path whose parts have been pushed out of
/// each other (`SeparationPotential`), shortens it, and minimises
///   E(P) + (2 kappa / n^2) sum_i B_i
/// over all paths of n segments without contact, with the potential B_i of segment i
/// (motion_contact.h). `factor` is that of the scalar metric, `energy` that of the path with
/// contact, to which kappa is proportional unless there is an obstacle. If the way has more than n
/// straight parts, the path is relaxed with a multiple of n segments first, and then shortened
/// again.
ContactFreePath AvoidContact(const ContactModel& model, const CholeskyFactor<float>& factor,
                             double energy, const std::vector<Shape>& guide, int segments,
                             const MinimiseOptions& options);

/// Moves the inner shapes of `shapes`, a path without contact, so that it has no contact and its
/// increments are near those of `guide`, a path of as many shapes with the same ends:
///   sum_i |(Phi(P_{i+1}) - Phi(P_i)) - (Phi(Q_{i+1}) - Phi(Q_i))|^2
/// and the contact potential are least, of all paths that can be reached without contact. Past an
/// obstacle Phi has positions too, so that the body moves as smoothly as the guide.
MinimiseResult KeepIncrements(const ContactModel& model, const std::vector<Shape>& guide,
                              const MinimiseOptions& options, std::vector<Shape>* shapes);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CONTACT_INTERNAL_AVOID_CONTACT_H_
