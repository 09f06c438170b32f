#include <shapespace/metric/feature_map.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>

#include <ceres/jet.h>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#include <shapespace/metric/line_jet.h>

namespace shapespace {

// What all derivatives of one map share.
struct FeatureDerivative::Layout {
  struct Term {  // of the feature with the same index
    int first_value = 0;
    // Where each vertex occurs, in the order of the elements: kVertices * element + corner.
    std::vector<int> begin, occurrences;
  };
  const Metric& metric;
  int num_values = 0;
  std::vector<Term> terms;
};

namespace {

// Elements, or vertices, that one task of a thread takes.
constexpr int kPerTask = 512;

// Calls body(begin, end) for ranges of [0, count).
template <typename Body>
void ForRanges(int count, const Body& body) {
  ParallelFor((count + kPerTask - 1) / kPerTask,
              [&](int task) { body(task * kPerTask, std::min(count, (task + 1) * kPerTask)); });
}

// The sum of value(i) over all i, in an order that does not depend on threads.
template <typename Value>
double Sum(int count, const Value& value) {
  std::vector<double> partial((count + kPerTask - 1) / kPerTask, 0.0);
  ForRanges(count, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) partial[begin / kPerTask] += value(i);
  });
  return std::accumulate(partial.begin(), partial.end(), 0.0);
}

// Calls body(i, feature) for every feature of the metric.
template <typename Body>
void ForFeatures(const Metric& metric, const Body& body) {
  for (size_t i = 0; i < metric.features.size(); ++i) {
    std::visit([&](const auto& feature) { body(i, feature); }, metric.features[i]);
  }
}

// Writes what `value(e, out)` says of each element into the feature's part of Phi, times the root
// of its weight; of a sum feature, whose elements share a weight, the sum.
template <typename Feature, typename Value>
void FillValues(const Feature& feature, double* result, const Value& value) {
  const int num_elements = static_cast<int>(feature.stencils.cols());
  if constexpr (Feature::kSum) {
    static_assert(Feature::kValues == 1);
    *result = std::sqrt(feature.weights(0)) * Sum(num_elements, [&](int e) {
                double out;
                value(e, &out);
                return out;
              });
  } else {
    ForRanges(num_elements, [&](int begin, int end) {
      for (int e = begin; e < end; ++e) {
        double* const out = result + static_cast<size_t>(Feature::kValues) * e;
        value(e, out);
        const double root = std::sqrt(feature.weights(e));
        for (int k = 0; k < Feature::kValues; ++k) out[k] *= root;
      }
    });
  }
}

}  // namespace

FeatureMap::FeatureMap(const Metric& metric) : metric_(metric) {
  if (metric.rigid.Active()) {
    throw InvalidOptions(
        "rigid: the rigid metric is no feature map, so it has no exponential map, parallel "
        "transport or deformation transfer; use rigid 0");
  }
  auto layout =
      std::make_shared<FeatureDerivative::Layout>(FeatureDerivative::Layout{metric, 0, {}});
  const int num_vertices = metric.connectivity->NumVertices();
  ForFeatures(metric, [&](size_t, const auto& feature) {
    using Feature = std::decay_t<decltype(feature)>;
    FeatureDerivative::Layout::Term term;
    term.first_value = layout->num_values;
    const int num_elements = static_cast<int>(feature.stencils.cols());
    layout->num_values += Feature::kSum ? 1 : Feature::kValues * num_elements;
    term.begin.assign(num_vertices + 1, 0);
    for (int v : feature.stencils.reshaped()) ++term.begin[v + 1];
    std::partial_sum(term.begin.begin(), term.begin.end(), term.begin.begin());
    term.occurrences.resize(term.begin.back());
    std::vector<int> fill(term.begin.begin(), term.begin.end() - 1);
    for (int i = 0; i < feature.stencils.size(); ++i) {
      term.occurrences[fill[feature.stencils.data()[i]]++] = i;
    }
    layout->terms.push_back(std::move(term));
  });
  layout_ = std::move(layout);
}

Eigen::VectorXd FeatureMap::Values(const Shape& shape) const {
  Eigen::VectorXd result(layout_->num_values);
  ForFeatures(metric_, [&](size_t i, const auto& feature) {
    using Feature = std::decay_t<decltype(feature)>;
    FillValues(feature, result.data() + layout_->terms[i].first_value, [&](int e, double* out) {
      double x[3 * Feature::kVertices];
      Gather(feature, e, shape, x);
      feature(x, out);
    });
  });
  return result;
}

int FeatureMap::FirstValue(size_t feature) const { return layout_->terms[feature].first_value; }

Eigen::VectorXd FeatureMap::SecondDerivative(const Shape& shape, const Tangent& x) const {
  Eigen::VectorXd result(layout_->num_values);
  ForFeatures(metric_, [&](size_t i, const auto& feature) {
    using Feature = std::decay_t<decltype(feature)>;
    FillValues(feature, result.data() + layout_->terms[i].first_value, [&](int e, double* out) {
      constexpr int kSize = 3 * Feature::kVertices;
      double at[kSize], along[kSize];
      Gather(feature, e, shape, at);
      Gather(feature, e, x, along);
      internal::LineJet jet[kSize], value[Feature::kValues];
      for (int k = 0; k < kSize; ++k) jet[k] = {at[k], along[k], 0};
      feature(jet, value);
      for (int k = 0; k < Feature::kValues; ++k) out[k] = value[k].second;
    });
  });
  return result;
}

FeatureDerivative FeatureMap::Derivative(const Shape& shape) const {
  FeatureDerivative derivative;
  derivative.layout_ = layout_;
  ForFeatures(metric_, [&](size_t, const auto& feature) {
    using Feature = std::decay_t<decltype(feature)>;
    constexpr int kSize = 3 * Feature::kVertices;
    const int num_elements = static_cast<int>(feature.stencils.cols());
    std::vector<double> blocks(static_cast<size_t>(num_elements) * kSize * Feature::kValues);
    ForRanges(num_elements, [&](int begin, int end) {
      using Jet = ceres::Jet<double, kSize>;
      for (int e = begin; e < end; ++e) {
        double x[kSize];
        Gather(feature, e, shape, x);
        Jet jet[kSize], value[Feature::kValues];
        for (int k = 0; k < kSize; ++k) jet[k] = Jet(x[k], k);
        feature(jet, value);
        const double root = std::sqrt(feature.weights(Feature::kSum ? 0 : e));
        double* out = &blocks[static_cast<size_t>(e) * kSize * Feature::kValues];
        for (int corner = 0; corner < Feature::kVertices; ++corner) {
          for (int k = 0; k < Feature::kValues; ++k) {
            for (int axis = 0; axis < 3; ++axis) *out++ = root * value[k].v[3 * corner + axis];
          }
        }
      }
    });
    derivative.blocks_.push_back(std::move(blocks));
  });
  return derivative;
}

Eigen::VectorXd FeatureDerivative::Times(const Tangent& x) const {
  Eigen::VectorXd result(layout_->num_values);
  ForFeatures(layout_->metric, [&](size_t i, const auto& feature) {
    using Feature = std::decay_t<decltype(feature)>;
    constexpr int kVertices = Feature::kVertices, kValues = Feature::kValues;
    const double* const blocks = blocks_[i].data();
    double* const values = result.data() + layout_->terms[i].first_value;
    const auto product = [&](int e, double* out) {
      const double* block = blocks + static_cast<size_t>(e) * 3 * kVertices * kValues;
      std::fill(out, out + kValues, 0.0);
      for (int corner = 0; corner < kVertices; ++corner) {
        const double* const at = x.col(feature.stencils(corner, e)).data();
        for (int k = 0; k < kValues; ++k, block += 3) {
          out[k] += block[0] * at[0] + block[1] * at[1] + block[2] * at[2];
        }
      }
    };
    const int num_elements = static_cast<int>(feature.stencils.cols());
    if constexpr (Feature::kSum) {
      *values = Sum(num_elements, [&](int e) {
        double out;
        product(e, &out);
        return out;
      });
    } else {
      ForRanges(num_elements, [&](int begin, int end) {
        for (int e = begin; e < end; ++e) product(e, values + static_cast<size_t>(kValues) * e);
      });
    }
  });
  return result;
}

Tangent FeatureDerivative::TransposeTimes(const Eigen::VectorXd& y) const {
  // Gathered by vertex, so that no two threads add to one place.
  Tangent result = Tangent::Zero(3, layout_->metric.connectivity->NumVertices());
  ForFeatures(layout_->metric, [&](size_t i, const auto& feature) {
    using Feature = std::decay_t<decltype(feature)>;
    constexpr int kVertices = Feature::kVertices, kValues = Feature::kValues;
    const Layout::Term& term = layout_->terms[i];
    const double* const blocks = blocks_[i].data();
    const double* const values = y.data() + term.first_value;
    ForRanges(static_cast<int>(result.cols()), [&](int begin, int end) {
      for (int v = begin; v < end; ++v) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (int k = term.begin[v]; k < term.begin[v + 1]; ++k) {
          const int place = term.occurrences[k];
          const double* block = blocks + static_cast<size_t>(place) * 3 * kValues;
          const double* const at = Feature::kSum ? values : values + place / kVertices * kValues;
          for (int value = 0; value < kValues; ++value, block += 3) {
            sum += at[value] * Eigen::Map<const Eigen::Vector3d>(block);
          }
        }
        result.col(v) += sum;
      }
    });
  });
  return result;
}

Eigen::SparseMatrix<double> FeatureDerivative::MetricMatrix() const {
  const int num_vertices = layout_->metric.connectivity->NumVertices();
  std::vector<Eigen::Triplet<double>> triplets;
  ForFeatures(layout_->metric, [&](size_t, const auto& feature) {
    using Feature = std::decay_t<decltype(feature)>;
    if constexpr (!Feature::kSum) {
      for (int e = 0; e < feature.stencils.cols(); ++e) {
        for (int p : feature.stencils.col(e)) {
          for (int q : feature.stencils.col(e)) {
            if (p >= q) triplets.emplace_back(p, q, 0.0);
          }
        }
      }
    }
  });
  Eigen::SparseMatrix<double> blocks(num_vertices, num_vertices);
  blocks.setFromTriplets(triplets.begin(), triplets.end());

  // Each entry becomes a block of three by three, on the diagonal its lower triangle.
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
  double* const entries = matrix->valuePtr();
  const int* const rows = matrix->innerIndexPtr();
  const int* const begins = matrix->outerIndexPtr();
  std::fill(entries, entries + matrix->nonZeros(), 0.0);
  ForFeatures(layout_->metric, [&](size_t i, const auto& feature) {
    using Feature = std::decay_t<decltype(feature)>;
    constexpr int kVertices = Feature::kVertices, kValues = Feature::kValues;
    if constexpr (!Feature::kSum) {
      const double* element = blocks_[i].data();
      for (int e = 0; e < feature.stencils.cols(); ++e, element += 3 * kVertices * kValues) {
        for (int k = 0; k < kVertices; ++k) {
          for (int l = 0; l < kVertices; ++l) {
            const int p = feature.stencils(k, e), q = feature.stencils(l, e);
            if (p < q) continue;
            const double* const left = element + 3 * kValues * k;
            const double* const right = element + 3 * kValues * l;
            for (int b = 0; b < 3; ++b) {
              const int column = 3 * q + b;
              const int first = p == q ? column : 3 * p;
              double* entry = entries + (std::lower_bound(rows + begins[column],
                                                          rows + begins[column + 1], first) -
                                         rows);
              for (int a = first - 3 * p; a < 3; ++a, ++entry) {
                for (int v = 0; v < kValues; ++v) *entry += left[3 * v + a] * right[3 * v + b];
              }
            }
          }
        }
      }
    }
  });
}

}  // namespace shapespace
