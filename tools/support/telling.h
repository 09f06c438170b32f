#ifndef SHAPESPACE_TOOLS_SUPPORT_TELLING_H_
#define SHAPESPACE_TOOLS_SUPPORT_TELLING_H_

#include <string>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace shapespace::tools {

using Json = nlohmann::ordered_json;

/// Text that is printed as results are, and kept for a report.
class Telling {
 public:
  /// Prints a part, as std::printf does, to `Out`.
  void Say(const char* format, ...) __attribute__((format(printf, 2, 3)));

  const std::string& Text() const { return text_; }

 private:
  std::string text_;
};

/// A vector in a report.
inline Json ListOf(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_TELLING_H_
