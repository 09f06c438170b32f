#include <shapespace/metric/feature.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace shapespace {

void Feature::GatherCoordinates(int begin, int end, const Shape& shape, double* x) const {
  for (int e = begin; e < end; ++e) {
    for (int k = 0; k < vertices_; ++k, x += 3) {
      Eigen::Map<Eigen::Vector3d> vertex(x);
      vertex = shape.col(Element(e)[k]);
    }
    x = std::copy_n(Numbers(e), numbers_per_element_, x);
  }
}

void Feature::Differentiate(int count, const double* x, double* values, double* derivatives) const {
  Evaluate(count, x, values, derivatives);
}

void Feature::ScalarRows(int count, const double* x, double* rows) const {
  // A derivative acts along one direction, but the scalar rows along all three. A third would be
  // the mean over directions; with 0.6 the unit step of a quasi-Newton method is acceptable from
  // the first iteration on, as measured with edge lengths.
  const double root = std::sqrt(0.6);
  const int num_rows = 3 * values_;
  std::vector<double> values(static_cast<size_t>(values_) * count);
  std::vector<double> derivatives(3 * vertices_ * values.size());
  Evaluate(count, x, values.data(), derivatives.data());
  const double* next = derivatives.data();
  for (int e = 0; e < count; ++e, rows += vertices_ * num_rows) {
    for (int corner = 0; corner < vertices_; ++corner) {
      for (int row = 0; row < num_rows; ++row) rows[vertices_ * row + corner] = root * *next++;
    }
  }
}

}  // namespace shapespace
