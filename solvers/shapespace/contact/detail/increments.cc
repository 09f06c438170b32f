#include <shapespace/contact/detail/increments.h>

#include <utility>

namespace shapespace::internal {

Increments::Increments(const std::shared_ptr<const Metric>& metric, const PathEnergy& energy,
                       std::vector<Shape> guide)
    : energy_(energy),
      single_(metric, 1),
      guide_(std::move(guide)),
      path_(guide_),
      unknowns_(single_.Size()),
      gradient_(single_.Size()) {
  for (int i = 1; i <= energy.Inner(); ++i) {
    at_guide_ -= Between(guide_[i - 1], i, guide_[i + 1], 1, nullptr);
  }
  for (const double squared : SquaredLengths(metric, guide_)) at_guide_ += 2 * squared;
}

double Increments::Between(const Shape& before, int i, const Shape& after, double factor,
                           double* gradient) {
  single_.Load({before, path_[i], after}, unknowns_.data());
  const double value =
      single_.Evaluate(unknowns_.data(), gradient == nullptr ? nullptr : gradient_.data());
  if (gradient != nullptr) {
    const size_t rows = gradient_.size() / single_.Stride();
    for (size_t row = 0; row < rows; ++row) {
      gradient[row * energy_.Stride() + i - 1] += factor * gradient_[row * single_.Stride()];
    }
  }
  return factor * value;
}

double Increments::Evaluate(const double* unknowns, double* gradient) {
  energy_.Store(unknowns, &path_);
  double value = -at_guide_;
  for (int i = 1; i <= energy_.Inner(); ++i) {
    value += Between(guide_[i], i, guide_[i], 1, gradient);
    value += Between(guide_[i - 1], i, guide_[i + 1], -1, gradient);
  }
  return value;
}

}  // namespace shapespace::internal
