#ifndef SHAPESPACE_DEFORMATION_DETAIL_CONTACT_DEFORMATION_H_
#define SHAPESPACE_DEFORMATION_DETAIL_CONTACT_DEFORMATION_H_

#include <functional>
#include <vector>

#include <shapespace/contact/internal/contact_model.h>
#include <shapespace/deformation/detail/handle_targets.h>
#include <shapespace/deformation/detail/held_level.h>
#include <shapespace/minimise/internal/minimise.h>

namespace shapespace::internal {

/// A deformation whose shapes do not touch themselves, if one was found.
struct ContactFreeDeformation {
  std::vector<Shape> shapes;  ///< empty if there is none
  double reached = 0;         ///< the time up to which the handles were followed; 1 if there is one
  MinimiseResult result;      ///< of the objective with the contact potential
};

/// Deforms a body by handles such that it does not pass through itself.
///
/// `guide` is the deformation with contact on the mesh of `level`, at even times, `model` that of
/// this mesh. Follows the handles in small steps: moves them as far as nothing touches, and then
/// lets the rest of the body, which is drawn to the guide's shape, give way. Then relaxes the whole
/// path, with the potential times 2 `stiffness` / n. Segments whose straight motion is free of
/// contact stay so; of others, the shapes. If something still touches in one of those, and no
/// hard handle moves, relaxes again from shapes of the way between which nothing touches, so that
/// all segments are free of contact. `go_on` is asked before each step, and false ends the way
/// there.
ContactFreeDeformation DeformWithoutContact(const ContactModel& model, const HandleTargets& targets,
                                            double stiffness, const std::vector<Shape>& guide,
                                            const MinimiseOptions& options,
                                            const std::function<bool()>& go_on, HeldLevel* level);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_DEFORMATION_DETAIL_CONTACT_DEFORMATION_H_
