#ifndef SHAPESPACE_SOLVERS_COST_SEGMENT_COST_H_
#define SHAPESPACE_SOLVERS_COST_SEGMENT_COST_H_

#include <algorithm>
#include <cmath>

#include <ceres/autodiff_cost_function.h>
#include <ceres/cost_function.h>
#include <ceres/dynamic_autodiff_cost_function.h>

#include <shapespace/metric/metric.h>
#include <shapespace/metric/trapezoid.h>

namespace shapespace::cost {

// Ceres cost functions of one segment of a path, automatically differentiated. Their parameter
// blocks are vertices (3 numbers): first the element's vertices in shape i, then the same in shape
// i + 1. Residuals are scaled so that Ceres' cost, half the sum of squares, is a quarter of the
// energy.

/// sqrt(w) (Phi_{i+1} - Phi_i) of one element of a feature.
template <typename Feature>
struct FeatureSegment {
  static constexpr int kResiduals = Feature::kValues;
  const Feature& feature;
  double root_weight;

  template <typename T>
  void Evaluate(const T* from, const T* to, T* residual) const {
    T a[Feature::kValues], b[Feature::kValues];
    feature(from, a);
    feature(to, b);
    for (int k = 0; k < kResiduals; ++k) residual[k] = root_weight * (b[k] - a[k]);
  }
};

/// The paper's (6) for one edge, with a weight for its quartic part (PathEnergy::SetQuarticWeight):
/// the residuals are a - b and a + b with the midpoint's a and a quartic b.
struct TrapezoidSegment {
  static constexpr int kResiduals = 2;
  double root_weight, root_quartic_weight;

  template <typename T>
  void Evaluate(const T* from, const T* to, T* residual) const {
    T ends[2];
    TrapezoidResiduals(from, to, ends);
    const T a = 0.5 * root_weight * M_SQRT1_2 * (ends[1] + ends[0]);
    const T b = 0.5 * root_weight * M_SQRT1_2 * root_quartic_weight * (ends[1] - ends[0]);
    residual[0] = a - b;
    residual[1] = a + b;
  }
};

/// Distributes Ceres' 2 kVertices parameter blocks over the two arrays that a segment's `Evaluate`
/// takes.
template <typename Segment, int kVertices>
class SegmentFunctor {
 public:
  explicit SegmentFunctor(const Segment& segment) : segment_(segment) {}

  template <typename T>
  bool operator()(const T* p0, const T* q0, T* residual) const {
    return Call<T>({p0, q0}, residual);
  }
  template <typename T>
  bool operator()(const T* p0, const T* p1, const T* q0, const T* q1, T* residual) const {
    return Call<T>({p0, p1, q0, q1}, residual);
  }
  template <typename T>
  bool operator()(const T* p0, const T* p1, const T* p2, const T* q0, const T* q1, const T* q2,
                  T* residual) const {
    return Call<T>({p0, p1, p2, q0, q1, q2}, residual);
  }
  template <typename T>
  bool operator()(const T* p0, const T* p1, const T* p2, const T* p3, const T* q0, const T* q1,
                  const T* q2, const T* q3, T* residual) const {
    return Call<T>({p0, p1, p2, p3, q0, q1, q2, q3}, residual);
  }

 private:
  template <typename T>
  bool Call(const T* const (&blocks)[2 * kVertices], T* residual) const {
    T from[3 * kVertices], to[3 * kVertices];
    for (int k = 0; k < kVertices; ++k) {
      std::copy_n(blocks[k], 3, from + 3 * k);
      std::copy_n(blocks[kVertices + k], 3, to + 3 * k);
    }
    segment_.Evaluate(from, to, residual);
    return true;
  }

  Segment segment_;
};

/// The cost of `segment`, whose element has kVertices (1 to 4) vertices; the caller owns it.
template <int kVertices, typename Segment>
ceres::CostFunction* MakeSegmentCost(const Segment& segment) {
  using Functor = SegmentFunctor<Segment, kVertices>;
  constexpr int kResiduals = Segment::kResiduals;
  if constexpr (kVertices == 1) {
    return new ceres::AutoDiffCostFunction<Functor, kResiduals, 3, 3>(new Functor(segment));
  } else if constexpr (kVertices == 2) {
    return new ceres::AutoDiffCostFunction<Functor, kResiduals, 3, 3, 3, 3>(new Functor(segment));
  } else if constexpr (kVertices == 3) {
    return new ceres::AutoDiffCostFunction<Functor, kResiduals, 3, 3, 3, 3, 3, 3>(
        new Functor(segment));
  } else {
    static_assert(kVertices == 4);
    return new ceres::AutoDiffCostFunction<Functor, kResiduals, 3, 3, 3, 3, 3, 3, 3, 3>(
        new Functor(segment));
  }
}

/// A sum feature couples all vertices: the blocks are all m vertices of shape i, then those of i +
/// 1.
template <typename Feature>
struct SumSegment {
  const Feature& feature;
  int num_vertices;
  double root_weight;

  template <typename T>
  bool operator()(const T* const* blocks, T* residual) const {
    residual[0] = T(0);
    for (int e = 0; e < feature.stencils.cols(); ++e) {
      T from[3 * Feature::kVertices], to[3 * Feature::kVertices], a, b;
      for (int k = 0; k < Feature::kVertices; ++k) {
        std::copy_n(blocks[feature.stencils(k, e)], 3, from + 3 * k);
        std::copy_n(blocks[num_vertices + feature.stencils(k, e)], 3, to + 3 * k);
      }
      feature(from, &a);
      feature(to, &b);
      residual[0] += root_weight * (b - a);
    }
    return true;
  }
};

/// The rigid metric (3) for one vertex, with (c, c_bar) of the segment as an additional block of 6.
struct RigidSegment {
  double root_weight;

  template <typename T>
  bool operator()(const T* from, const T* to, const T* motion, T* residual) const {
    RigidForm::Residual(from, to, motion, motion + 3, residual);
    for (int k = 0; k < 3; ++k) residual[k] *= root_weight;
    return true;
  }
};

}  // namespace shapespace::cost

#endif  // SHAPESPACE_SOLVERS_COST_SEGMENT_COST_H_
