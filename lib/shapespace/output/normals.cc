#include <shapespace/output/normals.h>

#include <Eigen/Geometry>

namespace shapespace {
namespace {

// Cosine of 55 degrees: an eight-sided tube (45) still looks round, a box (90) does not.
constexpr float kCreaseCosine = 0.5735764f;

}  // namespace

CornerNormals::CornerNormals(const Connectivity& connectivity)
    : triangles_(connectivity.Triangles()),
      begin_(connectivity.NumVertices() + 1, 0),
      faces_(triangles_.size()) {
  for (Eigen::Index i = 0; i < triangles_.size(); ++i) ++begin_[triangles_.data()[i] + 1];
  for (size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  for (Eigen::Index i = 0; i < triangles_.size(); ++i) {
    faces_[next[triangles_.data()[i]]++] = static_cast<int>(i / 3);
  }
}

Eigen::Matrix3Xf CornerNormals::operator()(const Shape& shape) const {
  Eigen::Matrix3Xf unit(3, triangles_.cols());
  Eigen::VectorXf area(triangles_.cols());
  for (Eigen::Index f = 0; f < triangles_.cols(); ++f) {
    const Eigen::Vector3d origin = shape.col(triangles_(0, f));
    const Eigen::Vector3d normal =
        (shape.col(triangles_(1, f)) - origin).cross(shape.col(triangles_(2, f)) - origin).eval();
    area[f] = static_cast<float>(normal.norm());
    unit.col(f) = normal.stableNormalized().cast<float>();
  }
  Eigen::Matrix3Xf normals(3, triangles_.size());
  for (Eigen::Index i = 0; i < triangles_.size(); ++i) {
    const Eigen::Vector3f own = unit.col(i / 3);
    const int v = triangles_.data()[i];
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (int j = begin_[v]; j < begin_[v + 1]; ++j) {
      const Eigen::Vector3f other = unit.col(faces_[j]);
      if (own.dot(other) >= kCreaseCosine) sum += area[faces_[j]] * other;
    }
    normals.col(i) = sum.stableNormalized();
  }
  return normals;
}

}  // namespace shapespace
