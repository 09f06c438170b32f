#ifndef SHAPESPACE_METRIC_TRAPEZOID_H_
#define SHAPESPACE_METRIC_TRAPEZOID_H_

namespace shapespace {

/// The two residuals of an edge and a segment in the paper's energy (6), which evaluates the metric
/// at both of the segment's ends: <de, e_i> and <de, e_{i+1}>, de = e_{i+1} - e_i.
/// `from` and `to` are the edge's end points (2 x 3) in the two shapes.
template <typename T>
void TrapezoidResiduals(const T* from, const T* to, T* residual) {
  residual[0] = residual[1] = T(0);
  for (int axis = 0; axis < 3; ++axis) {
    const T e0 = from[3 + axis] - from[axis];
    const T e1 = to[3 + axis] - to[axis];
    residual[0] += (e1 - e0) * e0;
    residual[1] += (e1 - e0) * e1;
  }
}

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_TRAPEZOID_H_
