#include <shapespace/matching/detail/nearest_columns.h>

#include <algorithm>
#include <limits>

#include <shapespace/base/internal/clones.h>
#include <shapespace/base/parallel.h>

namespace shapespace::internal {
namespace {

// Points and queries that are compared together: their products fill the registers. Vectors are as
// long as those of AVX2; g++ keeps longer ones, without AVX-512, in memory.
constexpr int kLanes = 8, kVectors = 2, kPoints = kLanes * kVectors, kQueries = 6;
using FloatVector = float __attribute__((vector_size(kLanes * sizeof(float))));
// The same in memory, without alignment beyond that of a number.
using StoredVector =
    float __attribute__((vector_size(kLanes * sizeof(float)), aligned(4), may_alias));
using IntVector = int __attribute__((vector_size(kLanes * sizeof(int))));

// For kQueries queries, the point with the greatest product with it less half of its own square.
// `blocks` has for each kPoints points these halves, and then kPoints numbers per dimension;
// `queries` has kQueries numbers per dimension. nearest[q] becomes the point's index.
SHAPESPACE_CLONES
void NearestOfBlocks(const float* blocks, int num_blocks, int dimensions, const float* queries,
                     int* nearest) {
  FloatVector best[kQueries];
  IntVector at[kQueries], here;
  for (int q = 0; q < kQueries; ++q) {
    best[q] = FloatVector{} - std::numeric_limits<float>::max();
    at[q] = IntVector{};
  }
  for (int i = 0; i < kLanes; ++i) here[i] = i;
  const auto* numbers = reinterpret_cast<const StoredVector*>(blocks);
  for (int block = 0; block < num_blocks; ++block) {
    FloatVector products[kVectors][kQueries];
    for (int k = 0; k < kVectors; ++k, ++numbers) {
      for (int q = 0; q < kQueries; ++q) products[k][q] = -numbers[0];
    }
    const float* query = queries;
    for (int d = 0; d < dimensions; ++d, query += kQueries, numbers += kVectors) {
      const FloatVector first = numbers[0], second = numbers[1];
      for (int q = 0; q < kQueries; ++q) {
        products[0][q] += query[q] * first;
        products[1][q] += query[q] * second;
      }
    }
    for (int k = 0; k < kVectors; ++k, here += kLanes) {
      for (int q = 0; q < kQueries; ++q) {
        const auto better = products[k][q] > best[q];
        best[q] = better ? products[k][q] : best[q];
        at[q] = better ? here : at[q];
      }
    }
  }
  for (int q = 0; q < kQueries; ++q) {
    int lane = 0;
    for (int i = 1; i < kLanes; ++i) {
      const bool tie = best[q][i] == best[q][lane] && at[q][i] < at[q][lane];
      if (best[q][i] > best[q][lane] || tie) lane = i;
    }
    nearest[q] = at[q][lane];
  }
}

}  // namespace

std::vector<int> NearestColumns(const Eigen::Ref<const Eigen::MatrixXf>& queries,
                                const Eigen::Ref<const Eigen::MatrixXf>& points) {
  const auto dimensions = static_cast<int>(points.rows());
  const auto num_points = static_cast<int>(points.cols());
  const auto num_queries = static_cast<int>(queries.cols());
  const int num_blocks = (num_points + kPoints - 1) / kPoints;
  // What fills up the last block is nearest to nothing.
  Eigen::MatrixXf blocks =
      Eigen::MatrixXf::Zero(kPoints, static_cast<Eigen::Index>(num_blocks) * (dimensions + 1));
  for (int b = 0; b < num_blocks; ++b) {
    const int begin = b * kPoints, count = std::min(kPoints, num_points - begin);
    auto block = blocks.middleCols(static_cast<Eigen::Index>(b) * (dimensions + 1), dimensions + 1);
    block.col(0).setConstant(std::numeric_limits<float>::max());
    const auto own = points.middleCols(begin, count);
    block.col(0).head(count) = 0.5F * own.colwise().squaredNorm().transpose();
    block.topRightCorner(count, dimensions) = own.transpose();
  }
  std::vector<int> nearest((num_queries + kQueries - 1) / kQueries * kQueries);
  ParallelFor(static_cast<int>(nearest.size()) / kQueries, [&](int g) {
    const int begin = g * kQueries, count = std::min(kQueries, num_queries - begin);
    Eigen::MatrixXf group = Eigen::MatrixXf::Zero(kQueries, dimensions);
    group.topRows(count) = queries.middleCols(begin, count).transpose();
    NearestOfBlocks(blocks.data(), num_blocks, dimensions, group.data(), &nearest[begin]);
  });
  nearest.resize(num_queries);
  return nearest;
}

}  // namespace shapespace::internal
