#ifndef SHAPESPACE_METRIC_LINE_JET_H_
#define SHAPESPACE_METRIC_LINE_JET_H_

#include <cmath>

#include <Eigen/Core>

namespace shapespace::internal {

/// f(s) and its first two derivatives along a line: the scalar type for features' second
/// derivatives along a tangent. (Nested Ceres Jets cannot be combined with plain numbers.) It has
/// the operators and the usual functions of a Jet.
struct LineJet {
  double value = 0, first = 0, second = 0;

  LineJet() = default;
  LineJet(double constant) : value(constant) {}  // NOLINT: plain numbers are constants
  LineJet(double v, double d, double dd) : value(v), first(d), second(dd) {}

  LineJet& operator+=(const LineJet& b);
  LineJet& operator-=(const LineJet& b);
  LineJet& operator*=(const LineJet& b);
  LineJet& operator/=(const LineJet& b);
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
inline LineJet& LineJet::operator+=(const LineJet& b) { return *this = *this + b; }
inline LineJet& LineJet::operator-=(const LineJet& b) { return *this = *this - b; }
inline LineJet& LineJet::operator*=(const LineJet& b) { return *this = *this * b; }
inline LineJet& LineJet::operator/=(const LineJet& b) { return *this = *this / b; }

inline bool operator<(const LineJet& a, const LineJet& b) { return a.value < b.value; }
inline bool operator>(const LineJet& a, const LineJet& b) { return a.value > b.value; }
inline bool operator<=(const LineJet& a, const LineJet& b) { return a.value <= b.value; }
inline bool operator>=(const LineJet& a, const LineJet& b) { return a.value >= b.value; }
inline bool operator==(const LineJet& a, const LineJet& b) { return a.value == b.value; }
inline bool operator!=(const LineJet& a, const LineJet& b) { return a.value != b.value; }

inline LineJet abs(const LineJet& a) { return a.value < 0 ? -a : a; }
inline LineJet sqrt(const LineJet& a) {
  const double root = std::sqrt(a.value);
  return Chain(a, root, 0.5 / root, -0.25 / (root * a.value));
}
inline LineJet log(const LineJet& a) {
  return Chain(a, std::log(a.value), 1 / a.value, -1 / (a.value * a.value));
}
inline LineJet exp(const LineJet& a) {
  const double e = std::exp(a.value);
  return Chain(a, e, e, e);
}
/// a^p for a constant p.
inline LineJet pow(const LineJet& a, double p) {
  return Chain(a, std::pow(a.value, p), p * std::pow(a.value, p - 1),
               p * (p - 1) * std::pow(a.value, p - 2));
}
inline LineJet sin(const LineJet& a) {
  const double s = std::sin(a.value);
  return Chain(a, s, std::cos(a.value), -s);
}
inline LineJet cos(const LineJet& a) {
  const double c = std::cos(a.value);
  return Chain(a, c, -std::sin(a.value), -c);
}
inline LineJet tan(const LineJet& a) {
  const double t = std::tan(a.value), slope = 1 + t * t;
  return Chain(a, t, slope, 2 * t * slope);
}
inline LineJet asin(const LineJet& a) {
  const double square = 1 - a.value * a.value, root = std::sqrt(square);
  return Chain(a, std::asin(a.value), 1 / root, a.value / (square * root));
}
inline LineJet acos(const LineJet& a) { return 0.5 * M_PI - asin(a); }
inline LineJet atan(const LineJet& a) {
  const double slope = 1 / (1 + a.value * a.value);
  return Chain(a, std::atan(a.value), slope, -2 * a.value * slope * slope);
}
inline LineJet tanh(const LineJet& a) {
  const double t = std::tanh(a.value), slope = 1 - t * t;
  return Chain(a, t, slope, -2 * t * slope);
}
/// The angle of (x, y); undefined at the origin.
inline LineJet atan2(const LineJet& y, const LineJet& x) {
  // Near the axes one of the two quotients is large; use the other one.
  LineJet angle = std::abs(x.value) > std::abs(y.value) ? atan(y / x) : -atan(x / y);
  angle.value = std::atan2(y.value, x.value);
  return angle;
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
