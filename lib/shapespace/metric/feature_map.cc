#include <shapespace/metric/feature_map.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/ranges.h>
#include <shapespace/base/parallel.h>
#include <shapespace/metric/internal/lower_block.h>

namespace shapespace {

// The data shared by all derivatives of one map.
struct FeatureDerivative::Layout {
  std::shared_ptr<const Metric> metric;
  int num_values = 0;
  std::vector<int> first_value;  // of each feature
};

namespace {

using internal::ForRanges;
using internal::kPerTask;

// Parts of the elements that are summed side by side. More parts would take more memory, and more
// time to add.
constexpr int kParts = 8;

// The sum of value(i) over all i, in an order that does not depend on the number of threads.
template <typename Value>
double Sum(int count, const Value& value) {
  std::vector<double> partial((count + kPerTask - 1) / kPerTask, 0.0);
  ForRanges(count, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) partial[begin / kPerTask] += value(i);
  });
  return std::accumulate(partial.begin(), partial.end(), 0.0);
}

// The coordinates and the numbers of elements [begin, end).
std::vector<double> CoordinatesOf(const Feature& feature, int begin, int end, const Shape& shape) {
  std::vector<double> x(static_cast<size_t>(feature.InputsPerElement()) * (end - begin));
  feature.GatherCoordinates(begin, end, shape, x.data());
  return x;
}

// Writes the values that `evaluate(begin, end, out)` computes, times the square roots of the
// weights, into the feature's part of Phi; for a sum feature, whose elements share a weight, their
// sum.
template <typename Evaluate>
void FillValues(const Feature& feature, double* result, const Evaluate& evaluate) {
  const int num_elements = feature.NumElements(), num_values = feature.ValuesPerElement();
  if (feature.IsSum()) {
    std::vector<double> partial((num_elements + kPerTask - 1) / kPerTask, 0.0);
    ForRanges(num_elements, [&](int begin, int end) {
      std::vector<double> out(end - begin);
      evaluate(begin, end, out.data());
      partial[begin / kPerTask] = std::accumulate(out.begin(), out.end(), 0.0);
    });
    *result = std::sqrt(feature.Weight(0)) * std::accumulate(partial.begin(), partial.end(), 0.0);
    return;
  }
  ForRanges(num_elements, [&](int begin, int end) {
    double* const out = result + static_cast<size_t>(num_values) * begin;
    evaluate(begin, end, out);
    for (int e = begin; e < end; ++e) {
      const double root = std::sqrt(feature.Weight(e));
      for (int k = 0; k < num_values; ++k) out[num_values * (e - begin) + k] *= root;
    }
  });
}

}  // namespace

FeatureMap::FeatureMap(std::shared_ptr<const Metric> metric) : metric_(std::move(metric)) {
  if (metric_->rigid.Active()) {
    throw InvalidOptions(
        "rigid",
        "the rigid metric is no feature map, so it has no exponential map, parallel "
        "transport or deformation transfer; use rigid 0");
  }
  auto layout =
      std::make_shared<FeatureDerivative::Layout>(FeatureDerivative::Layout{metric_, 0, {}});
  for (const auto& feature : metric_->features) {
    layout->first_value.push_back(layout->num_values);
    layout->num_values += feature->NumValues();
  }
  layout_ = std::move(layout);
}

Eigen::VectorXd FeatureMap::Values(const Shape& shape) const {
  Eigen::VectorXd result(layout_->num_values);
  for (size_t i = 0; i < metric_->features.size(); ++i) {
    const Feature& feature = *metric_->features[i];
    FillValues(feature, result.data() + FirstValue(i), [&](int begin, int end, double* out) {
      feature.Evaluate(end - begin, CoordinatesOf(feature, begin, end, shape).data(), out);
    });
  }
  return result;
}

int FeatureMap::FirstValue(size_t feature) const { return layout_->first_value[feature]; }

Eigen::VectorXd FeatureMap::SecondDerivative(const Shape& shape, const Tangent& x) const {
  Eigen::VectorXd result(layout_->num_values);
  for (size_t i = 0; i < metric_->features.size(); ++i) {
    const Feature& feature = *metric_->features[i];
    FillValues(feature, result.data() + FirstValue(i), [&](int begin, int end, double* out) {
      feature.SecondDerivatives(end - begin, CoordinatesOf(feature, begin, end, shape).data(),
                                CoordinatesOf(feature, begin, end, x).data(), out);
    });
  }
  return result;
}

FeatureDerivative FeatureMap::Derivative(const Shape& shape) const {
  FeatureDerivative derivative;
  derivative.layout_ = layout_;
  for (const auto& feature : metric_->features) {
    const size_t size = 3 * static_cast<size_t>(feature->VerticesPerElement()) *
                        feature->ValuesPerElement();  // numbers of an element
    std::vector<double> blocks(feature->NumElements() * size);
    ForRanges(feature->NumElements(), [&](int begin, int end) {
      std::vector<double> values(static_cast<size_t>(feature->ValuesPerElement()) * (end - begin));
      double* out = &blocks[begin * size];
      feature->Evaluate(end - begin, CoordinatesOf(*feature, begin, end, shape).data(),
                        values.data(), out);
      for (int e = begin; e < end; ++e) {
        const double root = std::sqrt(feature->Weight(e));
        for (size_t k = 0; k < size; ++k) *out++ *= root;
      }
    });
    derivative.blocks_.push_back(std::move(blocks));
  }
  return derivative;
}

Eigen::VectorXd FeatureDerivative::Times(const Tangent& x) const {
  Eigen::VectorXd result(layout_->num_values);
  for (size_t i = 0; i < blocks_.size(); ++i) {
    const Feature& feature = *layout_->metric->features[i];
    const int num_vertices = feature.VerticesPerElement(), num_values = feature.ValuesPerElement();
    const double* const blocks = blocks_[i].data();
    double* const values = result.data() + layout_->first_value[i];
    const auto product = [&](int e, double* out) {
      const double* block = blocks + static_cast<size_t>(e) * 3 * num_vertices * num_values;
      std::fill(out, out + num_values, 0.0);
      for (int corner = 0; corner < num_vertices; ++corner) {
        const double* const at = x.col(feature.Element(e)[corner]).data();
        for (int k = 0; k < num_values; ++k, block += 3) {
          out[k] += block[0] * at[0] + block[1] * at[1] + block[2] * at[2];
        }
      }
    };
    if (feature.IsSum()) {
      *values = Sum(feature.NumElements(), [&](int e) {
        double out;
        product(e, &out);
        return out;
      });
    } else {
      ForRanges(feature.NumElements(), [&](int begin, int end) {
        for (int e = begin; e < end; ++e) product(e, values + static_cast<size_t>(num_values) * e);
      });
    }
  }
  return result;
}

Tangent FeatureDerivative::TransposeTimes(const Eigen::VectorXd& y) const {
  // Each part of the elements is summed by itself, and the sums are added in order.
  const int num_vertices = layout_->metric->connectivity->NumVertices();
  std::vector<Tangent> sums(kParts);
  ParallelFor(kParts, [&](int part) {
    Tangent& sum = sums[part];
    sum = Tangent::Zero(3, num_vertices);
    for (size_t i = 0; i < blocks_.size(); ++i) {
      const Feature& feature = *layout_->metric->features[i];
      const int corners = feature.VerticesPerElement(), num_values = feature.ValuesPerElement();
      const double* const values = y.data() + layout_->first_value[i];
      const auto part_begin = [&](int of) {
        return static_cast<int>(static_cast<int64_t>(feature.NumElements()) * of / kParts);
      };
      const int begin = part_begin(part), end = part_begin(part + 1);
      const double* block =
          blocks_[i].data() + static_cast<size_t>(begin) * 3 * corners * num_values;
      for (int e = begin; e < end; ++e) {
        const double* const at =
            feature.IsSum() ? values : values + static_cast<size_t>(num_values) * e;
        for (int corner = 0; corner < corners; ++corner) {
          double* const to = sum.col(feature.Element(e)[corner]).data();
          for (int value = 0; value < num_values; ++value, block += 3) {
            for (int axis = 0; axis < 3; ++axis) to[axis] += at[value] * block[axis];
          }
        }
      }
    }
  });
  Tangent result(3, num_vertices);
  ForRanges(num_vertices, [&](int begin, int end) {
    auto range = result.middleCols(begin, end - begin);
    range = sums[0].middleCols(begin, end - begin);
    for (int part = 1; part < kParts; ++part) range += sums[part].middleCols(begin, end - begin);
  });
  return result;
}

std::vector<Tangent> FeatureDerivative::SumRows() const {
  std::vector<Tangent> rows;
  for (size_t i = 0; i < blocks_.size(); ++i) {
    if (!layout_->metric->features[i]->IsSum()) continue;
    rows.push_back(
        TransposeTimes(Eigen::VectorXd::Unit(layout_->num_values, layout_->first_value[i])));
  }
  return rows;
}

Eigen::SparseMatrix<double> FeatureDerivative::MetricMatrix() const {
  const int num_vertices = layout_->metric->connectivity->NumVertices();
  std::vector<Eigen::Triplet<double>> triplets;
  for (const auto& feature : layout_->metric->features) {
    if (feature->IsSum()) continue;
    const int corners = feature->VerticesPerElement();
    for (int e = 0; e < feature->NumElements(); ++e) {
      const int* const vertices = feature->Element(e);
      for (int k = 0; k < corners; ++k) {
        for (int l = 0; l < corners; ++l) {
          if (vertices[k] >= vertices[l]) triplets.emplace_back(vertices[k], vertices[l], 0.0);
        }
      }
    }
  }
  Eigen::SparseMatrix<double> blocks(num_vertices, num_vertices);
  blocks.setFromTriplets(triplets.begin(), triplets.end());

  // Each entry becomes a 3 x 3 block, on the diagonal its lower triangle.
  Eigen::SparseMatrix<double> matrix(3 * num_vertices, 3 * num_vertices);
  matrix.reserve(9 * blocks.nonZeros());
  for (int q = 0; q < num_vertices; ++q) {
    for (int b = 0; b < 3; ++b) {
      matrix.startVec(3 * q + b);
      for (Eigen::SparseMatrix<double>::InnerIterator p(blocks, q); p; ++p) {
        for (int a = p.row() == q ? b : 0; a < 3; ++a) {
          matrix.insertBackByOuterInner(3 * q + b, 3 * static_cast<int>(p.row()) + a) = 0;
        }
      }
    }
  }
  matrix.finalize();
  UpdateMetricMatrix(&matrix);
  return matrix;
}

void FeatureDerivative::UpdateMetricMatrix(Eigen::SparseMatrix<double>* matrix) const {
  std::fill_n(matrix->valuePtr(), matrix->nonZeros(), 0.0);
  for (size_t i = 0; i < blocks_.size(); ++i) {
    const Feature& feature = *layout_->metric->features[i];
    if (feature.IsSum()) continue;
    const int num_vertices = feature.VerticesPerElement(), num_values = feature.ValuesPerElement();
    const double* element = blocks_[i].data();
    for (int e = 0; e < feature.NumElements(); ++e, element += 3 * num_vertices * num_values) {
      for (int k = 0; k < num_vertices; ++k) {
        for (int l = 0; l < num_vertices; ++l) {
          const int p = feature.Element(e)[k], q = feature.Element(e)[l];
          if (p < q) continue;
          const double* const left = element + 3 * num_values * k;
          const double* const right = element + 3 * num_values * l;
          internal::ForLowerBlock(p, q, matrix, [&](int a, int b, double* entry) {
            for (int v = 0; v < num_values; ++v) *entry += left[3 * v + a] * right[3 * v + b];
          });
        }
      }
    }
  }
}

}  // namespace shapespace
