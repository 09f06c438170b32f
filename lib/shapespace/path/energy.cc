#include <shapespace/path/energy.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/ranges.h>
#include <shapespace/base/parallel.h>
#include <shapespace/path/detail/energy_kernels.h>
#include <shapespace/path/detail/energy_term.h>

namespace shapespace {
namespace {

// Rows are padded to whole SIMD registers, except for few shapes, where that would multiply the
// work.
int PaddedLength(int inner) { return inner <= internal::kFewShapes ? inner : (inner + 7) / 8 * 8; }

// Breadth-first order from vertices of low degree: neighbours get rows that are close together, so
// that memory is accessed sequentially and elements use few blocks.
std::vector<int> BreadthFirstOrder(const Connectivity& connectivity) {
  const int num_vertices = connectivity.NumVertices();
  std::vector<char> seen(num_vertices, 0);
  std::vector<int> order;
  order.reserve(num_vertices);
  const auto visit_from = [&](int root, std::vector<int>* visited, std::vector<char>* mark) {
    size_t next = visited->size();
    visited->push_back(root);
    (*mark)[root] = 1;
    for (; next < visited->size(); ++next) {
      const int v = (*visited)[next];
      for (const int e : connectivity.EdgesOfVertices()[v]) {
        const int neighbour = connectivity.OtherEnd(e, v);
        if (!(*mark)[neighbour]) {
          (*mark)[neighbour] = 1;
          visited->push_back(neighbour);
        }
      }
    }
  };
  for (int v = 0; v < num_vertices; ++v) {
    if (seen[v]) continue;
    // The vertex found last from anywhere is at an end of the component, from where the fronts of
    // the search are smaller.
    std::vector<int> component;
    visit_from(v, &component, &seen);
    for (int u : component) seen[u] = 0;
    visit_from(component.back(), &order, &seen);
  }
  return order;
}

}  // namespace

struct PathEnergy::Term {
  std::shared_ptr<const Feature> feature;
  internal::TermKernel kernel;   // of other features than sums
  internal::SumKernel of_a_sum;  // of sum features
  std::vector<internal::ElementGroup> groups[kPhases];
};

PathEnergy::PathEnergy(std::shared_ptr<const Metric> metric, int inner, End end)
    : metric_(std::move(metric)), end_(end) {
  SetInner(inner);
  vertex_of_row_ = BreadthFirstOrder(*metric_->connectivity);
  const int num_vertices = static_cast<int>(vertex_of_row_.size());
  row_of_vertex_.resize(num_vertices);
  for (int r = 0; r < num_vertices; ++r) row_of_vertex_[vertex_of_row_[r]] = r;
  constexpr int kVerticesInABlock = 256, kMostBlocks = 64;
  blocks_ = std::clamp(num_vertices / kVerticesInABlock, 1, kMostBlocks);
  first_.resize(3 * num_vertices);
  last_.resize(3 * num_vertices);
  terms_.resize(metric_->features.size());
  ParallelFor(static_cast<int>(terms_.size()),
              [&](int i) { terms_[i] = MakeTerm(metric_->features[i]); });
  if (metric_->rigid.Active()) {
    for (int v : vertex_of_row_) rigid_weights_.push_back(metric_->rigid.weights(v));
  }
}

void PathEnergy::SetInner(int inner) {
  if (inner < 1) throw InvalidOptions("inner", "a path energy needs at least one inner shape");
  inner_ = inner;
  stride_ = PaddedLength(inner);
}

PathEnergy::PathEnergy(PathEnergy&&) noexcept = default;
PathEnergy::~PathEnergy() = default;

// The groups of elements whose lowest and highest rows lie in the blocks `low` and `high`. Groups
// of one phase have no rows in common, so that threads may add to the gradient at the same time:
//   phase 0: elements within one block; a group for each block. These come first, and set their
//            rows of the gradient to zero before they add to them
//   phase 1: elements across the border of an even block and the next one; a group for each border
//   phase 2: the same of odd blocks
//   phase 3: all others, such as long stiffeners, in one group
PathEnergy::GroupPlace PathEnergy::PlaceOf(int low, int high) {
  if (low == high) return {0, low};
  if (high > low + 1) return {3, 0};
  return {1 + low % 2, low / 2};
}

int PathEnergy::NumGroups(int phase) const {
  const int groups[kPhases] = {blocks_, (blocks_ + 1) / 2, blocks_ / 2, 1};
  return groups[phase];
}

int PathEnergy::FirstRow(int block) const {
  return static_cast<int>(static_cast<int64_t>(vertex_of_row_.size()) * block / blocks_);
}

PathEnergy::Term PathEnergy::MakeTerm(const std::shared_ptr<const Feature>& feature) const {
  Term term;
  term.feature = feature;
  if (feature->IsSum()) {
    term.of_a_sum = internal::SumKernelOf(feature);
  } else {
    term.kernel = internal::KernelOf(feature);
  }
  for (int phase = 0; phase < kPhases; ++phase) term.groups[phase].resize(NumGroups(phase));
  const int num_elements = feature->NumElements();
  const int corners = feature->VerticesPerElement();
  std::vector<int> block_of(vertex_of_row_.size());
  for (int block = 0; block < blocks_; ++block) {
    std::fill(block_of.begin() + FirstRow(block), block_of.begin() + FirstRow(block + 1), block);
  }
  // In the order of their rows, for sequential memory access.
  std::vector<std::pair<int, int>> order(num_elements);
  for (int e = 0; e < num_elements; ++e) {
    int low = std::numeric_limits<int>::max();
    for (int k = 0; k < corners; ++k) {
      low = std::min(low, row_of_vertex_[feature->Element(e)[k]]);
    }
    order[e] = {low, e};
  }
  std::sort(order.begin(), order.end());
  for (const auto& [low_row, e] : order) {
    int high_row = low_row;
    for (int k = 0; k < corners; ++k) {
      high_row = std::max(high_row, row_of_vertex_[feature->Element(e)[k]]);
    }
    const int low = block_of[low_row], high = block_of[high_row];
    const GroupPlace place = PlaceOf(low, high);
    internal::ElementGroup& group = term.groups[place.phase][place.group];
    for (int k = 0; k < corners; ++k) {
      group.stencils.push_back(row_of_vertex_[feature->Element(e)[k]]);
    }
    group.weights.push_back(feature->Weight(e));
    group.numbers.insert(group.numbers.end(), feature->Numbers(e),
                         feature->Numbers(e) + feature->NumbersPerElement());
  }
  return term;
}

void PathEnergy::CheckNumber(const std::vector<Shape>& shapes) const {
  if (static_cast<int>(shapes.size()) != NumShapes()) {
    throw MeshError("a path of " + std::to_string(inner_) + " inner shapes needs " +
                    (end_ == End::kFree ? "one more as its beginning" : "two more as ends"));
  }
}

void PathEnergy::Load(const std::vector<Shape>& shapes, double* unknowns) {
  const int num_vertices = static_cast<int>(vertex_of_row_.size());
  CheckNumber(shapes);
  for (const Shape& shape : shapes) {
    if (shape.cols() != num_vertices) throw MeshError("a shape has the wrong number of vertices");
  }
  std::vector<char> moved(blocks_, 0);  // whether an end differs from the last one
  const auto set = [&](double to, double* coordinate, char* differs) {
    if (*coordinate == to) return;
    *coordinate = to;
    *differs = 1;
  };
  ParallelFor(blocks_, [&](int block) {
    for (int r = FirstRow(block); r < FirstRow(block + 1); ++r) {
      const int v = vertex_of_row_[r];
      for (int axis = 0; axis < 3; ++axis) {
        const size_t row = 3 * static_cast<size_t>(r) + axis;
        set(shapes.front()(axis, v), &first_[row], &moved[block]);
        set(shapes.back()(axis, v), &last_[row], &moved[block]);
        double* const out = unknowns + row * stride_;
        for (int t = 0; t < inner_; ++t) out[t] = shapes[t + 1](axis, v);
        std::fill(out + inner_, out + stride_, 0.0);
      }
    }
  });
  // Evaluations move a free end.
  const bool same_ends =
      end_ == End::kFixed && std::find(moved.begin(), moved.end(), 1) == moved.end();
  for (Term& term : terms_) {
    if (!term.kernel.takes_ends) continue;
    for (std::vector<internal::ElementGroup>& groups : term.groups) {
      ParallelFor(static_cast<int>(groups.size()), [&](int g) {
        if (same_ends && !groups[g].ends.empty()) return;
        EvaluateEnds(*term.feature, first_, last_, &groups[g]);
      });
    }
  }
}

void PathEnergy::Store(const double* unknowns, std::vector<Shape>* shapes) const {
  CheckNumber(*shapes);
  ParallelFor(inner_, [&](int t) {
    Shape& shape = (*shapes)[t + 1];
    shape.resize(3, row_of_vertex_.size());
    for (size_t r = 0; r < vertex_of_row_.size(); ++r) {
      for (int axis = 0; axis < 3; ++axis) {
        shape(axis, vertex_of_row_[r]) = unknowns[(3 * r + axis) * stride_ + t];
      }
    }
    metric_->connectivity->CopyToTwins(&shape);
  });
}

double* PathEnergy::Sink(double* gradient) {
  if (gradient != nullptr) return gradient;
  sink_.resize(Size());
  return sink_.data();
}

double PathEnergy::Evaluate(const double* unknowns, double* gradient) {
  const std::vector<double> parts = EvaluateParts(unknowns, Sink(gradient));
  return std::accumulate(parts.begin(), parts.end(), 0.0);
}

std::vector<double> PathEnergy::Parts(const double* unknowns) {
  return EvaluateParts(unknowns, Sink(nullptr));
}

std::vector<double> PathEnergy::EvaluateParts(const double* unknowns, double* gradient) {
  const size_t num_terms = terms_.size();
  const internal::PathRows rows = Rows(unknowns, gradient);
  const bool trapezoid = metric_->options.discretization == Discretization::kTrapezoid;
  const double quartic = trapezoid ? quartic_weight_ : 0;
  std::vector<double> parts(num_terms, 0.0);
  for (int phase = 0; phase < kPhases; ++phase) {
    const int num_groups = NumGroups(phase);
    // All terms of a group one after the other, while its rows are in the cache.
    std::vector<double> partial(num_groups * num_terms, 0.0);
    ParallelFor(num_groups, [&](int g) {
      if (phase == 0) {  // no other group has touched these rows yet
        if (end_ == End::kFree) {
          for (int row = 3 * FirstRow(g); row < 3 * FirstRow(g + 1); ++row) {
            last_[row] = unknowns[static_cast<size_t>(row) * stride_ + inner_ - 1];
          }
        }
        std::fill(gradient + 3 * static_cast<size_t>(FirstRow(g)) * stride_,
                  gradient + 3 * static_cast<size_t>(FirstRow(g + 1)) * stride_, 0.0);
      }
      for (size_t i = 0; i < num_terms; ++i) {
        const internal::ElementGroup& group = terms_[i].groups[phase][g];
        if (terms_[i].feature->IsSum() || group.Count() == 0) continue;
        partial[g * num_terms + i] = terms_[i].kernel.evaluate(rows, group, quartic);
      }
    });
    for (int g = 0; g < num_groups; ++g) {
      for (size_t i = 0; i < num_terms; ++i) parts[i] += partial[g * num_terms + i];
    }
  }
  for (size_t i = 0; i < num_terms; ++i) {
    if (terms_[i].feature->IsSum()) parts[i] = EvaluateSum(terms_[i], unknowns, gradient);
  }
  if (metric_->rigid.Active()) parts.push_back(EvaluateRigid(unknowns, gradient));
  return parts;
}

internal::PathRows PathEnergy::Rows(const double* unknowns, double* gradient) const {
  return {unknowns, gradient, first_.data(), last_.data(), inner_, stride_, end_ == End::kFree};
}

double PathEnergy::EvaluateSum(const Term& term, const double* unknowns, double* gradient) const {
  const internal::PathRows rows = Rows(unknowns, gradient);
  std::vector<double> total(inner_ + 2, 0.0);
  for (const std::vector<internal::ElementGroup>& groups : term.groups) {
    std::vector<std::vector<double>> partial(groups.size());
    ParallelFor(static_cast<int>(groups.size()), [&](int g) {
      partial[g].assign(inner_ + 2, 0.0);
      term.of_a_sum.add_values(rows, groups[g], partial[g].data());
    });
    for (const std::vector<double>& p : partial) {
      for (int t = 0; t < inner_ + 2; ++t) total[t] += p[t];
    }
  }
  const double w = term.feature->Weight(0);
  double energy = 0;
  for (int t = 0; t <= inner_; ++t) energy += 2 * w * std::pow(total[t + 1] - total[t], 2);
  std::vector<double> slopes(inner_ + 2, 0.0);
  for (int t = 1; t <= inner_; ++t) {
    slopes[t] = 4 * w * (2 * total[t] - total[t - 1] - total[t + 1]);
  }
  for (const std::vector<internal::ElementGroup>& groups : term.groups) {
    ParallelFor(static_cast<int>(groups.size()),
                [&](int g) { term.of_a_sum.add_gradients(rows, groups[g], slopes.data()); });
  }
  return energy;
}

double PathEnergy::EvaluateRigid(const double* unknowns, double* gradient) {
  const int num_vertices = static_cast<int>(vertex_of_row_.size());
  const double total_weight = std::accumulate(rigid_weights_.begin(), rigid_weights_.end(), 0.0);
  const auto vertex = [&](int r, int t) {
    Eigen::Vector3d p;
    for (int axis = 0; axis < 3; ++axis) {
      p(axis) = At(unknowns, 3 * static_cast<size_t>(r) + axis, t);
    }
    return p;
  };
  // Segments are processed independently. A shape receives gradients from its two segments, which
  // are stored separately and added in the order of time.
  std::vector<double> energy(inner_ + 1);
  std::vector<Shape> from(inner_ + 1), to(inner_ + 1);
  ParallelFor(inner_ + 1, [&](int t) {
    Eigen::Vector3d mean_motion = Eigen::Vector3d::Zero(), mean_middle = Eigen::Vector3d::Zero();
    for (int r = 0; r < num_vertices; ++r) {
      const Eigen::Vector3d p = vertex(r, t), q = vertex(r, t + 1);
      mean_motion += rigid_weights_[r] / total_weight * (q - p);
      mean_middle += rigid_weights_[r] / total_weight * 0.5 * (p + q);
    }
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (int r = 0; r < num_vertices; ++r) {
      const Eigen::Vector3d p = vertex(r, t), q = vertex(r, t + 1);
      const Eigen::Vector3d m = 0.5 * (p + q) - mean_middle;
      moment += rigid_weights_[r] * m.cross(q - p - mean_motion);
      inertia +=
          rigid_weights_[r] * (m.squaredNorm() * Eigen::Matrix3d::Identity() - m * m.transpose());
    }
    const Eigen::Vector3d c = AngularVelocity(inertia, moment);
    const Eigen::Vector3d c_bar = mean_motion - c.cross(mean_middle);
    from[t].resize(3, num_vertices);
    to[t].resize(3, num_vertices);
    energy[t] = 0;
    for (int r = 0; r < num_vertices; ++r) {
      const Eigen::Vector3d p = vertex(r, t), q = vertex(r, t + 1);
      Eigen::Vector3d residual;
      RigidForm::Residual(p.data(), q.data(), c.data(), c_bar.data(), residual.data());
      energy[t] += 2 * rigid_weights_[r] * residual.squaredNorm();
      // Since (c, c_bar) is optimal, it can be treated as constant in the derivative (envelope
      // theorem).
      const Eigen::Vector3d push = 4 * rigid_weights_[r] * residual;
      const Eigen::Vector3d turn = 0.5 * c.cross(push);
      to[t].col(r) = push + turn;
      from[t].col(r) = turn - push;
    }
  });
  ParallelFor(blocks_, [&](int block) {
    for (int r = FirstRow(block); r < FirstRow(block + 1); ++r) {
      for (int axis = 0; axis < 3; ++axis) {
        double* const g = gradient + (3 * static_cast<size_t>(r) + axis) * stride_ - 1;
        for (int t = 1; t <= inner_; ++t) g[t] += to[t - 1](axis, r) + from[t](axis, r);
      }
    }
  });
  return std::accumulate(energy.begin(), energy.end(), 0.0);
}

double PathEnergy::EstimateBytes(const Metric& metric, int inner) {
  // Of ElementGroup, with some capacity left over.
  constexpr double kCapacity = 1.25;
  double elements = 0;
  for (const auto& feature : metric.features) {
    const double integers = feature->VerticesPerElement();
    const double numbers = 1 + feature->NumbersPerElement() + 2.0 * feature->ValuesPerElement();
    elements += kCapacity * feature->NumElements() * (4 * integers + 8 * numbers);
  }
  const double num_vertices = metric.connectivity->NumVertices();
  const double rigid = metric.rigid.Active() ? 48.0 * (inner + 1) * num_vertices : 0;
  return elements + rigid + 60 * num_vertices;
}

namespace {

// For each two consecutive `shapes`, the least energy of a path of `segments` segments from one to
// the other, feature by feature. Values of a shape are computed once.
std::vector<double> LeastEnergies(const Metric& metric, const std::vector<const Shape*>& shapes,
                                  int segments) {
  constexpr int kElementsPerTask = 1024;
  const size_t num_shapes = shapes.size(), pairs = num_shapes - 1;
  std::vector<double> least(pairs,
                            metric.rigid.Active() ? std::numeric_limits<double>::quiet_NaN() : 0);
  if (metric.rigid.Active()) return least;
  for (const auto& feature : metric.features) {
    const int num_elements = feature->NumElements(), num_values = feature->ValuesPerElement();
    const int tasks = (num_elements + kElementsPerTask - 1) / kElementsPerTask;
    // Of a task, and of a pair; for sums, the value of a shape.
    Eigen::MatrixXd partial = Eigen::MatrixXd::Zero(num_shapes, tasks);
    const auto add = [&](int begin, int end) {
      auto sums = partial.col(begin / kElementsPerTask);
      std::vector<double> values[2];  // of a shape, and of the one before it
      for (std::vector<double>& v : values) v.resize(num_values * (end - begin));
      std::vector<double> x(static_cast<size_t>(feature->InputsPerElement()) * (end - begin));
      for (size_t i = 0; i < num_shapes; ++i) {
        double* const here = values[i % 2].data();
        feature->GatherCoordinates(begin, end, *shapes[i], x.data());
        feature->Evaluate(end - begin, x.data(), here);
        if (feature->IsSum()) {
          sums(i) = std::accumulate(here, here + (end - begin), 0.0);
        } else if (i > 0) {
          sums(i - 1) = 2 * feature->LeastChange(end - begin, values[(i + 1) % 2].data(), here,
                                                 feature->Weights().data() + begin, segments);
        }
      }
    };
    internal::ForRanges(num_elements, add, kElementsPerTask);
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(num_shapes);
    for (int task = 0; task < tasks; ++task) sums += partial.col(task);
    for (size_t i = 0; i < pairs; ++i) {
      least[i] += feature->IsSum() ? 2 * feature->LeastChange(1, &sums(i), &sums(i + 1),
                                                              feature->Weights().data(), segments)
                                   : sums(i);
    }
  }
  return least;
}

}  // namespace

double EnergyLowerBound(const Metric& metric, const Shape& first, const Shape& last, int segments) {
  return LeastEnergies(metric, {&first, &last}, segments)[0];
}

std::vector<double> ChordLengths(const Metric& metric, const std::vector<Shape>& shapes) {
  std::vector<const Shape*> pointers;
  for (const Shape& shape : shapes) pointers.push_back(&shape);
  std::vector<double> lengths = LeastEnergies(metric, pointers, 1);
  for (double& length : lengths) length = std::sqrt(length);
  return lengths;
}

std::vector<double> SquaredLengths(const std::shared_ptr<const Metric>& metric,
                                   const std::vector<Shape>& shapes) {
  std::vector<double> lengths;
  if (shapes.size() < 2) return lengths;
  // For three shapes of which the last two are equal, the first segment has all of the energy.
  PathEnergy energy(metric, 1);
  std::vector<double> unknowns(energy.Size());
  for (size_t i = 0; i + 1 < shapes.size(); ++i) {
    energy.Load({shapes[i], shapes[i + 1], shapes[i + 1]}, unknowns.data());
    lengths.push_back(energy.Evaluate(unknowns.data(), nullptr) / 2);
  }
  return lengths;
}

}  // namespace shapespace
