#ifndef SHAPESPACE_COST_TRANSPORT_CONSTRAINT_H_
#define SHAPESPACE_COST_TRANSPORT_CONSTRAINT_H_

#include <ceres/problem.h>

#include <shapespace/mesh/shape.h>

namespace shapespace::cost {

/// Adds the paper's transport (section 5) to `problem`: |Y - x|^2, where x is the current value of
/// `y`, and the constraint <Y, normal> = bound as a residual of weight `weight`, because Ceres has
/// no constraints. The parameter blocks are y->col(v).data() and `bound`, one number, which is set
/// constant. `y` and `bound` must outlive the problem; `normal` is copied.
void AddTransportConstraint(Tangent normal, double weight, double* bound, Tangent* y,
                            ceres::Problem* problem);

}  // namespace shapespace::cost

#endif  // SHAPESPACE_COST_TRANSPORT_CONSTRAINT_H_
