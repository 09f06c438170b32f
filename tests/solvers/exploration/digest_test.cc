#include <functional>
#include <limits>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>
#include <shapespace/exploration/detail/digest.h>
#include <shapespace/geodesic/internal/option_fields.h>

namespace shapespace {
namespace {

using internal::ForOptions;
using internal::Hasher;
using internal::Of;

std::string DigestOfOptions(const GeodesicOptions& options) {
  Hasher hasher;
  AddOptions(options, &hasher);
  return hasher.Digest();
}

// Another value of an option.
template <typename Number>
std::enable_if_t<std::is_arithmetic_v<Number>> Change(Number* value) {
  *value = std::is_same_v<Number, bool> ? !*value : *value * 3 + 1;
}
template <typename Word>
std::enable_if_t<std::is_enum_v<Word>> Change(Word* value) {
  const auto words = WordsOf(Of<Word>());
  *value = words[0].second == *value ? words[1].second : words[0].second;
}
void Change(Eigen::VectorXd* values) { values->setOnes(3); }
void Change(std::vector<FeatureTerm>* terms) { terms->push_back({"own", 2}); }
void Change(std::vector<Shape>* shapes) { shapes->push_back(Shape::Ones(3, 4)); }
void Change(std::optional<Obstacle>* obstacle) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 4, 1, 1);
  *obstacle = Obstacle{bar.connectivity, bar.pose(0)};
}

// The options whose change leaves the digest as it is, and those that are checked.
struct Found {
  std::set<std::string> without_effect, all;
};

template <typename Options>
void ChangeEach(const std::function<Options&(GeodesicOptions*)>& part, Found* found) {
  ForOptions(Of<Options>(), [&](const char* name, auto field, const char*) {
    GeodesicOptions options;
    auto& value = std::invoke(field, part(&options));
    found->all.insert(name);
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, MetricOptions>) {
      ChangeEach<MetricOptions>([](GeodesicOptions* of) -> MetricOptions& { return of->metric; },
                                found);
    } else {
      const std::string before = DigestOfOptions(options);
      Change(&value);
      if (DigestOfOptions(options) == before) found->without_effect.insert(name);
    }
  });
}

TEST(Digest, OfOptionsChangesWithEachThatChangesAResult) {
  Found found;
  ChangeEach<GeodesicOptions>([](GeodesicOptions* of) -> GeodesicOptions& { return *of; }, &found);
  EXPECT_EQ(found.without_effect, (std::set<std::string>{"assess", "memory_limit"}));
  EXPECT_EQ(found.all.count("obstacle"), 1u);
  EXPECT_EQ(found.all.count("bending_stiffness"), 1u);
}

// Neighbouring values may not be taken for each other.
TEST(Digest, TellsWhichOptionHasAValue) {
  GeodesicOptions one, other;
  one.metric.stretching_stiffness = other.metric.bending_stiffness = Eigen::VectorXd::Ones(4);
  EXPECT_NE(DigestOfOptions(one), DigestOfOptions(other));
  one = other = {};
  one.via = {Shape::Ones(3, 4), Shape::Ones(3, 2)};
  other.via = {Shape::Ones(3, 2), Shape::Ones(3, 4)};
  EXPECT_NE(DigestOfOptions(one), DigestOfOptions(other));
}

}  // namespace
}  // namespace shapespace
