// The sums over arrays that the optimisers are made of.
#include <shapespace/minimise/detail/chunks.h>

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace shapespace::internal {
namespace {

// Lengths below a register of any width, about the 32 sums of Dot, and with remainders of both.
const std::vector<size_t> kCounts = {0, 1, 2, 3, 5, 8, 31, 32, 33, 63, 64, 100, 1001};

// Numbers of both signs with all bits of a float's fraction, so that sums of products round.
template <typename Scalar>
std::vector<Scalar> Numbers(size_t count, double phase) {
  std::vector<Scalar> numbers(count);
  for (size_t i = 0; i < count; ++i) {
    numbers[i] = static_cast<Scalar>(std::sin(phase + 1.7 * static_cast<double>(i)));
  }
  return numbers;
}

template <typename A>
void ExpectDotOf() {
  for (size_t count : kCounts) {
    const std::vector<A> a = Numbers<A>(count, 0.3);
    const std::vector<double> b = Numbers<double>(count, 1.1);
    double sum = 0, of_sizes = 0;
    for (size_t i = 0; i < count; ++i) {
      sum += a[i] * b[i];
      of_sizes += std::abs(a[i] * b[i]);
    }
    EXPECT_NEAR(Dot(a.data(), b.data(), count), sum, 1e-15 * of_sizes * std::sqrt(count)) << count;
  }
}

TEST(Chunks, DotIsTheSumOfProductsToRounding) {
  ExpectDotOf<double>();
  ExpectDotOf<float>();
}

// The product may be rounded before the sum or not, depending on the processor.
template <typename B, typename Result>
void ExpectCombined(double rounding) {
  constexpr double kFactor = -0.7;
  for (size_t count : kCounts) {
    const std::vector<double> a = Numbers<double>(count, 0.3);
    const std::vector<B> b = Numbers<B>(count, 1.1);
    std::vector<Result> result(count + 1, 9);
    Combine(a.data(), kFactor, b.data(), result.data(), count);
    for (size_t i = 0; i < count; ++i) {
      EXPECT_NEAR(result[i], a[i] + kFactor * b[i], rounding) << i << " of " << count;
    }
    EXPECT_EQ(result[count], 9) << "behind the end of " << count;
  }
}

TEST(Chunks, CombineAddsAMultipleInEveryPrecision) {
  ExpectCombined<double, double>(4e-16);
  ExpectCombined<double, float>(2e-7);
  ExpectCombined<float, double>(4e-16);
}

TEST(Chunks, AddChangesItsTarget) {
  for (size_t count : kCounts) {
    const std::vector<float> from = Numbers<float>(count, 0.3);
    std::vector<double> to = Numbers<double>(count, 1.1);
    const std::vector<double> before = to;
    Add(0.5, from.data(), to.data(), count);
    for (size_t i = 0; i < count; ++i) EXPECT_NEAR(to[i], before[i] + 0.5 * from[i], 4e-16);
  }
}

}  // namespace
}  // namespace shapespace::internal
