#include <shapespace/correspondence/detail/gradient_fit.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/SparseCore>

#include <shapespace/sparse/internal/solve.h>
#include <shapespace/transfer/internal/frames.h>

namespace shapespace::internal {
namespace {

// Keeps the system definite, for instance for vertices without triangles.
constexpr double kRegularisation = 1e-9;
// A triangle whose area is less than this share of its longest side's square is given less weight,
// because its gradient is dominated by rounding.
constexpr double kThin = 1e-2;

// T_f is linear in four points: the triangle's corners and its fourth vertex.
struct Element {
  std::array<int, 4> unknowns;
  std::array<Eigen::Vector3d, 4> gradients;
  double quality;
};

void AddSquare(const std::vector<int>& unknowns, const std::vector<Eigen::Vector3d>& gradients,
               double weight, std::vector<Eigen::Triplet<double>>* entries) {
  for (size_t i = 0; i < unknowns.size(); ++i) {
    for (size_t j = 0; j < unknowns.size(); ++j) {
      if (unknowns[i] < unknowns[j]) continue;
      entries->emplace_back(unknowns[i], unknowns[j], weight * gradients[i].dot(gradients[j]));
    }
  }
}

Element MakeElement(const Shape& rest, const Eigen::Vector3i& triangle, int fourth) {
  Element element;
  const Eigen::Matrix3d frame = Frame(rest, triangle);
  const Eigen::Matrix3d inverse = InverseFrame(frame);
  for (int k = 0; k < 3; ++k) {
    element.unknowns[k] = triangle(k);
    element.gradients[k + 1] = inverse.row(k);
  }
  element.unknowns[3] = fourth;
  element.gradients[0] = -(element.gradients[1] + element.gradients[2] + element.gradients[3]);
  const double longest = std::max({frame.col(0).squaredNorm(), frame.col(1).squaredNorm(),
                                   (frame.col(1) - frame.col(0)).squaredNorm()});
  const double share = 0.5 * frame.col(2).squaredNorm() / (kThin * longest);
  element.quality = share < 1 ? share * share : 1;
  if (!(element.quality > 0)) element.quality = 0;  // collapsed to a point
  return element;
}

// The square of T_f - T_g, as a function of the six unknowns of both.
void AddDifference(const Element& f, const Element& g,
                   std::vector<Eigen::Triplet<double>>* entries) {
  std::vector<int> unknowns(f.unknowns.begin(), f.unknowns.end());
  std::vector<Eigen::Vector3d> gradients(f.gradients.begin(), f.gradients.end());
  for (int k = 0; k < 4; ++k) {
    const auto found = std::find(unknowns.begin(), unknowns.end(), g.unknowns[k]);
    if (found == unknowns.end()) {
      unknowns.push_back(g.unknowns[k]);
      gradients.emplace_back(-g.gradients[k]);
    } else {
      gradients[found - unknowns.begin()] -= g.gradients[k];
    }
  }
  AddSquare(unknowns, gradients, std::min(f.quality, g.quality), entries);
}

}  // namespace

GradientFit::GradientFit(const Connectivity& connectivity, const Shape& rest, std::vector<int> held,
                         double identity)
    : num_vertices_(connectivity.NumVertices()), held_(std::move(held)) {
  const Eigen::Matrix3Xi& triangles = connectivity.Triangles();
  const int num_unknowns = num_vertices_ + connectivity.NumTriangles();
  std::vector<Element> elements(connectivity.NumTriangles());
  std::vector<Eigen::Triplet<double>> entries;
  right_ = Eigen::MatrixX3d::Zero(num_unknowns, 3);
  for (int v = 0; v < num_vertices_; ++v) {
    entries.emplace_back(v, v, kRegularisation);
    right_.row(v) = kRegularisation * rest.col(v).transpose();
  }
  for (int f = 0; f < triangles.cols(); ++f) {
    elements[f] = MakeElement(rest, triangles.col(f), num_vertices_ + f);
    const auto& [unknowns, gradients, quality] = elements[f];
    const double weight = identity * quality;
    AddSquare({unknowns.begin(), unknowns.end()}, {gradients.begin(), gradients.end()}, weight,
              &entries);
    for (int k = 0; k < 4; ++k) right_.row(unknowns[k]) += weight * gradients[k].transpose();
    entries.emplace_back(num_vertices_ + f, num_vertices_ + f, kRegularisation);
  }
  for (int e = 0; e < connectivity.NumTriangleEdges(); ++e) {
    const IndexLists::Row around = connectivity.TrianglesOfEdges()[e];
    for (int i = 1; i < around.size(); ++i) {
      AddDifference(elements[around[i - 1]], elements[around[i]], &entries);
    }
  }
  Eigen::SparseMatrix<double> matrix(num_unknowns, num_unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());

  // The equations of held vertices become x = place, and their couplings go to the right-hand side.
  std::vector<int> place_of(num_unknowns, -1);
  for (size_t i = 0; i < held_.size(); ++i) place_of[held_[i]] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> couplings;
  for (int column = 0; column < matrix.outerSize(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry) {
      const int row = static_cast<int>(entry.row());
      if (place_of[row] < 0 && place_of[column] < 0) continue;
      if (row == column) {
        entry.valueRef() = 1;
        continue;
      }
      if (place_of[row] < 0) couplings.emplace_back(row, place_of[column], entry.value());
      if (place_of[column] < 0) couplings.emplace_back(column, place_of[row], entry.value());
      entry.valueRef() = 0;
    }
  }
  couplings_.resize(num_unknowns, static_cast<Eigen::Index>(held_.size()));
  couplings_.setFromTriplets(couplings.begin(), couplings.end());
  factor_.emplace(matrix);
}

Shape GradientFit::operator()(const Shape& places) const {
  Eigen::MatrixX3d right = right_ - couplings_ * places.transpose();
  for (size_t i = 0; i < held_.size(); ++i) {
    right.row(held_[i]) = places.col(static_cast<Eigen::Index>(i)).transpose();
  }
  return Solve(*factor_, right).topRows(num_vertices_).transpose();
}

}  // namespace shapespace::internal
