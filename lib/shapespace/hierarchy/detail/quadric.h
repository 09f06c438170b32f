#ifndef SHAPESPACE_HIERARCHY_DETAIL_QUADRIC_H_
#define SHAPESPACE_HIERARCHY_DETAIL_QUADRIC_H_

#include <Eigen/Core>

namespace shapespace::internal {

/// A sum of weighted squared distances from planes, as a function of a point (Garland and Heckbert,
/// "Surface Simplification Using Quadric Error Metrics", SIGGRAPH 1997). Points are relative to an
/// origin near the planes, so that the sum does not suffer from cancellation.
class Quadric {
 public:
  /// Adds `weight` times the squared distance from the plane through `point` with unit `normal`.
  void AddPlane(const Eigen::Vector3d& normal, const Eigen::Vector3d& point, double weight) {
    const double d = -normal.dot(point);
    const double n[4] = {normal.x(), normal.y(), normal.z(), d};
    int k = 0;
    for (int i = 0; i < 4; ++i) {
      for (int j = i; j < 4; ++j) c_[k++] += weight * n[i] * n[j];
    }
  }

  Quadric& operator+=(const Quadric& other) {
    for (int k = 0; k < 10; ++k) c_[k] += other.c_[k];
    return *this;
  }

  /// The same function of points relative to `origin`, a point relative to the origin so far.
  Quadric From(const Eigen::Vector3d& origin) const {
    const double x = origin.x(), y = origin.y(), z = origin.z();
    Quadric result = *this;
    result.c_[3] += c_[0] * x + c_[1] * y + c_[2] * z;
    result.c_[6] += c_[1] * x + c_[4] * y + c_[5] * z;
    result.c_[8] += c_[2] * x + c_[5] * y + c_[7] * z;
    result.c_[9] = (*this)(origin);
    return result;
  }

  double operator()(const Eigen::Vector3d& p) const {
    const double x = p.x(), y = p.y(), z = p.z();
    return x * (c_[0] * x + 2 * (c_[1] * y + c_[2] * z + c_[3])) +
           y * (c_[4] * y + 2 * (c_[5] * z + c_[6])) + z * (c_[7] * z + 2 * c_[8]) + c_[9];
  }

  double AtOrigin() const { return c_[9]; }

 private:
  double c_[10] = {};  // upper triangle of the symmetric 4 x 4 matrix, row by row
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_HIERARCHY_DETAIL_QUADRIC_H_
