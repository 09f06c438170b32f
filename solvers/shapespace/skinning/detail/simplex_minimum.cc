#include <shapespace/skinning/detail/simplex_minimum.h>

#include <cmath>
#include <limits>

namespace shapespace::internal {
namespace {

// Added to the diagonal, as a share of its mean, so that of two bones with the same motion each
// gets half. Far above rounding errors, and weights change by as much at most.
constexpr double kRidge = 1e-10;

// A coordinate joins if it lowers the value at a rate above this share of the value: coordinates
// that gain less cost time and say nothing.
constexpr double kLeastRate = 1e-5;

constexpr int kMost = SimplexPoint::kMost;
using SmallMatrix = std::array<std::array<double, kMost>, kMost>;
using SmallVector = std::array<double, kMost>;

// Solves a symmetric positive definite system of the first n rows in place, by Cholesky; only the
// lower triangle is read.
void SolveSmall(int n, SmallMatrix* matrix, SmallVector* x) {
  SmallMatrix& a = *matrix;
  SmallVector& b = *x;
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < j; ++k) a[j][j] -= a[j][k] * a[j][k];
    a[j][j] = std::sqrt(std::fmax(a[j][j], std::numeric_limits<double>::min()));
    for (int i = j + 1; i < n; ++i) {
      for (int k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
      a[i][j] /= a[j][j];
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int k = i + 1; k < n; ++k) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
}

// The minimum over the plane of sum 1, without bounds, of the coordinates of `point`: the first is
// 1 minus the sum of the others, for which the equations are solved.
SmallVector MinimumOnPlane(const Eigen::MatrixXd& gram, const SimplexPoint& point) {
  const int n = point.count - 1;
  const int first = point.index[0];
  const double square = gram(first, first);
  SmallMatrix matrix;
  SmallVector others;
  double trace = 0;
  for (int i = 0; i < n; ++i) {
    const int row = point.index[i + 1];
    others[i] = square - gram(row, first);
    for (int j = 0; j <= i; ++j) {
      const int column = point.index[j + 1];
      matrix[i][j] = gram(row, column) - gram(row, first) - gram(column, first) + square;
    }
    trace += matrix[i][i];
  }
  for (int i = 0; i < n; ++i) matrix[i][i] += kRidge * trace / n;
  SolveSmall(n, &matrix, &others);
  SmallVector result;
  result[0] = 1;
  for (int i = 0; i < n; ++i) {
    result[i + 1] = others[i];
    result[0] -= others[i];
  }
  return result;
}

// The gradient, infinite for the point's own coordinates; returns half the value's rate of descent
// along the best new one, which is `*best`.
double BestDescent(const Eigen::MatrixXd& gram, const SimplexPoint& point,
                   Eigen::VectorXd* gradient, int* best, double* value) {
  gradient->setZero(gram.rows());
  for (int i = 0; i < point.count; ++i) {
    *gradient += point.weight[i] * gram.col(point.index[i]);
  }
  *value = 0;
  for (int i = 0; i < point.count; ++i) {
    *value += point.weight[i] * (*gradient)(point.index[i]);
  }
  for (int i = 0; i < point.count; ++i) (*gradient)(point.index[i]) = HUGE_VAL;
  return *value - gradient->minCoeff(best);
}

}  // namespace

void SimplexPoint::Append(int i, double w) {
  index[count] = i;
  weight[count] = w;
  ++count;
}

void SimplexPoint::Remove(int position) {
  double sum = 0;
  --count;
  for (int i = position; i < count; ++i) {
    index[i] = index[i + 1];
    weight[i] = weight[i + 1];
  }
  for (int i = 0; i < count; ++i) sum += weight[i];
  for (int i = 0; i < count; ++i) weight[i] = sum > 0 ? weight[i] / sum : 1.0 / count;
}

double ValueAt(const Eigen::MatrixXd& gram, const SimplexPoint& point) {
  double value = 0;
  for (int i = 0; i < point.count; ++i) {
    for (int j = 0; j < point.count; ++j) {
      value += point.weight[i] * point.weight[j] * gram(point.index[i], point.index[j]);
    }
  }
  return value;
}

void MinimiseOnSupport(const Eigen::MatrixXd& gram, SimplexPoint* point) {
  while (point->count > 1) {
    const SmallVector target = MinimumOnPlane(gram, *point);
    // Goes towards the target until the first coordinate is zero, and removes that one.
    double step = 1;
    int leaving = -1;
    for (int i = 0; i < point->count; ++i) {
      if (target[i] > 0) continue;
      const double way = point->weight[i] - target[i];
      const double share = way > 0 ? point->weight[i] / way : 0;
      if (leaving >= 0 && share >= step) continue;
      step = share;
      leaving = i;
    }
    for (int i = 0; i < point->count; ++i) {
      point->weight[i] += step * (target[i] - point->weight[i]);
    }
    if (leaving < 0) return;
    point->weight[leaving] = 0;
    for (int i = 0; i < point->count; ++i) point->weight[i] = std::fmax(0, point->weight[i]);
    point->Remove(leaving);
  }
  point->weight[0] = 1;
}

void MinimiseOnSimplex(const Eigen::MatrixXd& gram, SimplexPoint* point,
                       Eigen::VectorXd* gradient) {
  MinimiseOnSupport(gram, point);
  while (point->count < kMost && point->count < gram.rows()) {
    int best = 0;
    double value = 0;
    if (!(BestDescent(gram, *point, gradient, &best, &value) > kLeastRate * value)) return;
    SimplexPoint larger = *point;
    larger.Append(best, 0);
    MinimiseOnSupport(gram, &larger);
    // Each step lowers the value, so that no support comes twice. `value` is another sum of the
    // same terms, and differs by rounding errors, which are all that is left where bones fit
    // exactly.
    if (!(ValueAt(gram, larger) < ValueAt(gram, *point))) return;
    *point = larger;
  }
}

void RemoveLeastUseful(const Eigen::MatrixXd& gram, int most, SimplexPoint* point) {
  while (point->count > most) {
    SimplexPoint best;
    double least = HUGE_VAL;
    for (int i = 0; i < point->count; ++i) {
      SimplexPoint smaller = *point;
      smaller.Remove(i);
      MinimiseOnSupport(gram, &smaller);
      const double value = ValueAt(gram, smaller);
      if (best.count > 0 && !(value < least)) continue;
      least = value;
      best = smaller;
    }
    *point = best;
  }
}

}  // namespace shapespace::internal
