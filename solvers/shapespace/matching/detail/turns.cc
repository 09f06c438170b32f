#include <shapespace/matching/detail/turns.h>

namespace shapespace::internal {

Eigen::MatrixXf GradientTurns(const Connectivity& connectivity, const Eigen::VectorXd& areas,
                              const Eigen::MatrixXf& functions,
                              const std::vector<std::pair<int, int>>& pairs) {
  Eigen::MatrixXf turns = Eigen::MatrixXf::Zero(functions.rows(), pairs.size());
  for (size_t p = 0; p < pairs.size(); ++p) {
    const auto f = functions.col(pairs[p].first), g = functions.col(pairs[p].second);
    auto turn = turns.col(p);
    for (const auto& triangle : connectivity.Triangles().colwise()) {
      const int a = triangle(0), b = triangle(1), c = triangle(2);
      // Of functions that are linear on a triangle, the integral of n . (grad f x grad g) is half
      // of this determinant, whatever the triangle's shape; a third of it is each vertex's.
      const float determinant = (f(b) - f(a)) * (g(c) - g(a)) - (f(c) - f(a)) * (g(b) - g(a));
      for (const int v : triangle) turn(v) += determinant / 6;
    }
  }
  return areas.cwiseInverse().cast<float>().asDiagonal() * turns;
}

std::vector<std::pair<int, int>> AllPairs(int count) {
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) pairs.emplace_back(i, j);
  }
  return pairs;
}

}  // namespace shapespace::internal
