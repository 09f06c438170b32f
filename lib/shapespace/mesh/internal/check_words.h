#ifndef SHAPESPACE_MESH_INTERNAL_CHECK_WORDS_H_
#define SHAPESPACE_MESH_INTERNAL_CHECK_WORDS_H_

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <shapespace/mesh/check.h>
#include <shapespace/mesh/seams.h>

// Names of files, lines and elements in findings. Elements are counted from 1.

namespace shapespace::internal {

inline std::string FileName(const Soup& soup) {
  return (soup.file.empty() ? "mesh" : soup.file) + (soup.name.empty() ? "" : ":" + soup.name);
}

inline std::string Name(const char* what, int i, const std::vector<int>& lines) {
  const std::string name = std::string(what) + " " + std::to_string(i + 1);
  const bool has_line = i < static_cast<int>(lines.size());
  return has_line ? name + " (line " + std::to_string(lines[i]) + ")" : name;
}

inline std::string VertexName(const Soup& soup, int v) {
  return Name("vertex", v, soup.vertex_line);
}
inline std::string PolygonName(const Soup& soup, int p) {
  return Name("polygon", p, soup.polygon_line);
}
inline std::string SegmentName(const Soup& soup, int s) {
  return Name("segment", s, soup.segment_line);
}

/// Three significant digits.
inline std::string Number(double value) {
  std::ostringstream stream;
  stream.precision(3);
  stream << value;
  return stream.str();
}

/// Counts elements and stores the names of the first three.
class Named {
 public:
  /// `name()` returns the element's name; it is called only if the name is stored.
  template <typename MakeName>
  void Add(const MakeName& name) {
    constexpr int kMaxNamed = 3;
    if (++count_ > kMaxNamed) return;
    named_ = count_;
    names_ += (names_.empty() ? "" : ", ") + name();
  }

  int Count() const { return count_; }

  std::string Names() const {
    return names_ + (count_ > named_ ? " and " + std::to_string(count_ - named_) + " more" : "");
  }

  /// "file: what (count): names; remedy" as a finding, if anything was counted.
  void Tell(const Soup& soup, Severity severity, const char* kind, const std::string& what,
            const std::string& remedy, std::vector<Finding>* findings) const {
    if (count_ == 0) return;
    findings->push_back({severity, kind,
                         FileName(soup) + ": " + what + " (" + std::to_string(count_) +
                             "): " + Names() + "; " + remedy,
                         severity == Severity::kNonManifold ? "allow_nonmanifold" : ""});
  }

 private:
  int count_ = 0, named_ = 0;
  std::string names_;
};

/// What a note says of vertices that were joined.
inline std::string WordsOfJoined(const Seams& seams) {
  return std::to_string(seams.joined) + (seams.joined == 1 ? " pair" : " pairs") +
         " of vertices at the same place are joined, along seams where the surface goes on";
}

/// What a warning says of borders that were not.
inline std::string WordsOfUnclear(const Seams& seams) {
  return "borders lie on each other at " + std::to_string(seams.unclear) +
         (seams.unclear == 1 ? " edge" : " edges") +
         " and are left open, because more than two meet there or their polygons are wound alike; "
         "join the vertices, or recompute the orientation of the polygons, if the surface should "
         "go on there";
}

inline void SortBySeverity(std::vector<Finding>* findings) {
  std::stable_sort(findings->begin(), findings->end(),
                   [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_INTERNAL_CHECK_WORDS_H_
