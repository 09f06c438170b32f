#ifndef SHAPESPACE_METRIC_LINE_JET_H_
#define SHAPESPACE_METRIC_LINE_JET_H_

#include <cmath>

#include <Eigen/Core>

namespace shapespace::internal {

/// f(s) and its first two derivatives along a line: the scalar that features take for their second
/// derivative along a tangent. (Nested Jets of Ceres do not mix with plain numbers.)
struct LineJet {
  double value = 0, first = 0, second = 0;

  LineJet() = default;
  LineJet(double constant) : value(constant) {}  // NOLINT: plain numbers are constants
  LineJet(double v, double d, double dd) : value(v), first(d), second(dd) {}

  LineJet& operator+=(const LineJet& b) {
    return *this = {value + b.value, first + b.first, second + b.second};
  }
};

inline LineJet operator-(const LineJet& a) { return {-a.value, -a.first, -a.second}; }
inline LineJet operator+(const LineJet& a, const LineJet& b) {
  return {a.value + b.value, a.first + b.first, a.second + b.second};
}
inline LineJet operator-(const LineJet& a, const LineJet& b) {
  return {a.value - b.value, a.first - b.first, a.second - b.second};
}
inline LineJet operator*(const LineJet& a, const LineJet& b) {
  return {a.value * b.value, a.first * b.value + a.value * b.first,
          a.second * b.value + 2 * a.first * b.first + a.value * b.second};
}
/// g(a) for a function with derivatives g', g'' at a.
inline LineJet Chain(const LineJet& a, double g, double g1, double g2) {
  return {g, g1 * a.first, g1 * a.second + g2 * a.first * a.first};
}
inline LineJet operator/(const LineJet& a, const LineJet& b) {
  const double inverse = 1 / b.value;
  return a * Chain(b, inverse, -inverse * inverse, 2 * inverse * inverse * inverse);
}
inline bool operator<(const LineJet& a, const LineJet& b) { return a.value < b.value; }
inline LineJet sqrt(const LineJet& a) {
  const double root = std::sqrt(a.value);
  return Chain(a, root, 0.5 / root, -0.25 / (root * a.value));
}
inline LineJet log(const LineJet& a) {
  return Chain(a, std::log(a.value), 1 / a.value, -1 / (a.value * a.value));
}

}  // namespace shapespace::internal

namespace Eigen {
template <>
struct NumTraits<shapespace::internal::LineJet> : GenericNumTraits<double> {
  using Real = shapespace::internal::LineJet;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = double;
};
}  // namespace Eigen

#endif  // SHAPESPACE_METRIC_LINE_JET_H_
