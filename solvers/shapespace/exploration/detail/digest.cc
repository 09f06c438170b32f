#include <shapespace/exploration/detail/digest.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <optional>
#include <string_view>
#include <type_traits>
#include <vector>

#include <shapespace/geodesic/internal/option_fields.h>

namespace shapespace::internal {
namespace {

// The memory that a solve may take, and what is measured of the path that it has found.
constexpr std::string_view kWithoutEffect[] = {"memory_limit", "assess"};

// Values of options. One of another type has to be added here: it does not compile without.
class OptionHasher {
 public:
  explicit OptionHasher(Hasher* hasher) : hasher_(*hasher) {}

  template <typename Options>
  void AddFields(const Options& options) const {
    ForOptions(Of<Options>(), [&](const char* name, auto field, const char*) {
      if (std::count(std::begin(kWithoutEffect), std::end(kWithoutEffect), name) > 0) return;
      Add(std::string(name));
      Add(std::invoke(field, options));
    });
  }

 private:
  template <typename Number>
  std::enable_if_t<std::is_arithmetic_v<Number> || std::is_enum_v<Number>> Add(Number value) const {
    hasher_.Add(static_cast<double>(value));
  }
  void Add(const std::string& text) const { hasher_.AddAll(text); }
  template <int kRows>
  void Add(const Eigen::Matrix<double, kRows, Eigen::Dynamic>& matrix) const {
    hasher_.AddAll(matrix);
  }
  void Add(const Eigen::VectorXd& vector) const { hasher_.AddAll(vector); }
  void Add(const MetricOptions& metric) const { AddFields(metric); }
  void Add(const FeatureTerm& term) const {
    Add(term.name);
    Add(term.coefficient);
  }
  void Add(const Obstacle& obstacle) const {
    hasher_.AddAll(obstacle.connectivity->Triangles());
    Add(obstacle.shape);
  }
  template <typename Value>
  void Add(const std::optional<Value>& value) const {
    Add(value.has_value());
    if (value) Add(*value);
  }
  template <typename Value>
  void Add(const std::vector<Value>& values) const {
    Add(values.size());
    for (const Value& value : values) Add(value);
  }

  Hasher& hasher_;
};

}  // namespace

std::string Hasher::Digest() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(&state_);
  char text[33];
  std::snprintf(text, sizeof text, "%016llx%016llx",
                static_cast<unsigned long long>(hash.high64),  // NOLINT(google-runtime-int)
                static_cast<unsigned long long>(hash.low64));  // NOLINT(google-runtime-int)
  return text;
}

void AddOptions(const GeodesicOptions& options, Hasher* hasher) {
  OptionHasher(hasher).AddFields(options);
}

}  // namespace shapespace::internal
