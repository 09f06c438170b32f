#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_LIMB_TURNS_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_LIMB_TURNS_H_

#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/correspondence/correspondence.h>
#include <shapespace/correspondence/detail/closest.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// Turns limbs of a template, which is fitted to a target but for detail, by half a turn about
/// their axes, where the fit of the limb alone then has less energy. A limb is nearly round, so
/// that a hand whose palm is where its back belongs holds itself there: each of its points has a
/// near one on the target.
///
/// `rest` and `*shape` are of `level`, in the target's frame; vertices that are `held` stay where
/// they are. \return how many limbs were turned. \throw Cancelled.
int TurnLimbs(const Level& level, const Shape& rest, const std::vector<int>& held,
              const Target& target, const CorrespondenceOptions& options, Progress* progress,
              Shape* shape);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_LIMB_TURNS_H_
