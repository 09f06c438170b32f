#include <shapespace/correspondence/landmark_file.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/csv.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/base/internal/json.h>
#include <shapespace/base/internal/read_file.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/mesh/surface.h>

// Slicer's formats:
// https://slicer.readthedocs.io/en/latest/developer_guide/modules/markups.html

namespace shapespace {
namespace {

constexpr const char* kAxes[] = {"x", "y", "z"};

/// The signs of the axes that lead from the coordinate system of this name to LPS; none if it is
/// another name. Old files of Slicer have numbers instead of names.
std::optional<Eigen::Vector3d> ToLps(std::string_view system) {
  if (system == "LPS" || system == "1") return Eigen::Vector3d(1, 1, 1);
  if (system == "RAS" || system == "0") return Eigen::Vector3d(-1, -1, 1);
  return std::nullopt;
}

// ---- .fcsv

class FcsvReader {
 public:
  FcsvReader(const std::string& file, const std::string& text) : file_(file), lines_(text) {}

  std::vector<Landmark> Read() {
    std::vector<Landmark> landmarks;
    std::string_view line;
    while (lines_.Next(&line)) {
      // A byte order mark before the first line is blanked.
      const std::string_view text = internal::WithoutBlanks(line);
      if (text.substr(0, 1) == "#") {
        ReadHeader(text.substr(1));
      } else if (!text.empty()) {
        landmarks.push_back(ReadLandmark(line, landmarks.size() + 1));
      }
    }
    return landmarks;
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    internal::FailAt(file_, lines_.Number(), what);
  }

  /// "CoordinateSystem = LPS" or "columns = id,x,y,z,...".
  void ReadHeader(std::string_view line) {
    const size_t equals = line.find('=');
    if (equals == std::string_view::npos) return;
    const std::string_view key = internal::WithoutBlanks(line.substr(0, equals));
    const std::string_view value = internal::WithoutBlanks(line.substr(equals + 1));
    if (key == "CoordinateSystem") {
      signs_ = ToLps(value);
      if (!signs_) {
        Fail("the coordinate system " + internal::Quoted(value) +
             " is not one of LPS and RAS; save the points in one of these");
      }
    } else if (key == "columns") {
      const std::vector<std::string> names = internal::CsvCells(value, file_, lines_.Number());
      const auto column = [&](const char* name) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) Fail(std::string("there is no column ") + name);
        return static_cast<size_t>(found - names.begin());
      };
      for (int axis = 0; axis < 3; ++axis) columns_[axis] = column(kAxes[axis]);
      columns_[3] = column("label");
    }
  }

  Landmark ReadLandmark(std::string_view line, size_t number) const {
    if (!signs_) {
      Fail(
          "no line '# CoordinateSystem = LPS', or RAS, is above the points; add the one in which "
          "they are");
    }
    const std::vector<std::string> cells = internal::CsvCells(line, file_, lines_.Number());
    const internal::ElementName element{"landmark", number};
    Landmark landmark;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string cell = columns_[axis] < cells.size() ? cells[columns_[axis]] : "";
      landmark.position[axis] = (*signs_)[axis] * internal::FiniteNumber(cell, kAxes[axis], file_,
                                                                         lines_.Number(), element);
    }
    if (columns_[3] < cells.size()) landmark.label = cells[columns_[3]];
    return landmark;
  }

  const std::string& file_;
  internal::Lines lines_;
  std::optional<Eigen::Vector3d> signs_;
  size_t columns_[4] = {1, 2, 3, 11};  // of x, y, z and the label
};

// ---- .mrk.json

std::vector<Landmark> LandmarksFromJson(const internal::Json& json) {
  using internal::Field;
  if (!json.is_object()) internal::FailIn("", "is not a file of markups; save points in Slicer");
  const internal::Json& lists =
      internal::ListFrom(internal::Required(json, "", "markups"), "markups");
  if (lists.size() > 1) {
    internal::FailIn("markups", std::to_string(lists.size()) +
                                    " lists of points are in the file; save one list in a file");
  }
  const internal::Json& list = lists[0];
  if (!list.is_object()) internal::FailIn("markups", "its entry must be an object, { }");
  const std::string field = "markups.coordinateSystem";
  const std::string system =
      internal::TextFrom(internal::Required(list, "markups", "coordinateSystem"), field);
  const std::optional<Eigen::Vector3d> signs = ToLps(system);
  if (!signs) {
    internal::FailIn(field, internal::Quoted(system) +
                                " is not one of LPS and RAS; save the points "
                                "in one of these");
  }
  std::vector<Landmark> landmarks;
  const internal::Json& points = internal::Required(list, "markups", "controlPoints");
  if (!points.is_array()) internal::FailIn("markups.controlPoints", "must be a list, [ ]");
  for (size_t i = 0; i < points.size(); ++i) {
    const std::string name = "markups.controlPoints (point " + std::to_string(i + 1) + ")";
    const internal::Json& point = points[i];
    if (!point.is_object()) internal::FailIn(name, "must be an object, { }");
    const auto status = point.find("positionStatus");
    if (status != point.end() && *status != "defined") continue;
    Landmark landmark;
    landmark.position = signs->cwiseProduct(
        internal::VectorFrom(internal::Required(point, name, "position"), Field(name, "position")));
    if (point.contains("label")) {
      landmark.label = internal::TextFrom(point["label"], Field(name, "label"));
    }
    landmarks.push_back(std::move(landmark));
  }
  return landmarks;
}

// ---- text

std::vector<Landmark> LandmarksFromText(const std::string& file, const std::string& text) {
  std::vector<Landmark> landmarks;
  internal::Lines lines(text);
  std::string_view line;
  while (lines.Next(&line)) {
    internal::LineWords words(internal::WithoutComment(line));
    if (words.Done()) continue;
    const internal::ElementName element{"landmark", landmarks.size() + 1};
    Landmark landmark;
    for (int axis = 0; axis < 3; ++axis) {
      landmark.position[axis] =
          internal::FiniteNumber(words.Next(), kAxes[axis], file, lines.Number(), element);
    }
    if (!words.Done()) {
      internal::FailAt(file, lines.Number(),
                       element.Text() + ": " + internal::Quoted(words.Next()) +
                           " is too much; a line holds x, y and z");
    }
    landmarks.push_back(std::move(landmark));
  }
  return landmarks;
}

// ---- markers

/// A landmark in messages, counted from 1.
std::string NameOf(const std::vector<Landmark>& landmarks, size_t i) {
  const std::string number = "landmark " + std::to_string(i + 1);
  return landmarks[i].label.empty() ? number : number + " " + internal::Quoted(landmarks[i].label);
}

/// The vertices of the landmarks with these indices.
std::vector<int> VerticesAt(const std::vector<Landmark>& landmarks,
                            const std::vector<size_t>& indices, const std::string& file,
                            const Poses& mesh) {
  const Shape& shape = mesh.shapes.at(0);
  if (mesh.connectivity->NumTriangles() == 0) {
    throw MeshError(mesh.names[0] + ": has no polygons, on which landmarks could lie");
  }
  const double size = (shape.rowwise().maxCoeff() - shape.rowwise().minCoeff()).norm();
  const MeshSurface surface(mesh.connectivity, shape);
  std::vector<int> vertices;
  std::map<int, size_t> first_at;
  for (const size_t i : indices) {
    const ClosestPoint closest = surface.Nearest(landmarks[i].position);
    if (closest.triangle < 0 || !(closest.distance <= kFarthestLandmark * size)) {
      std::ostringstream message;
      message << file << ": " << NameOf(landmarks, i) << " is ";
      if (closest.triangle >= 0) message << closest.distance << " away";
      message << (closest.triangle < 0 ? "far away" : "") << " from the surface of "
              << mesh.names[0] << ", which is " << size
              << " across; do its coordinates belong to this mesh and its unit?";
      if (IsSlicerLandmarks(file)) {
        message << " The mesh is taken to be in LPS; if it was saved in RAS, exchange LPS and RAS "
                   "in the file's coordinate system";
      }
      throw FileError(message.str());
    }
    int nearest = -1;
    for (const int corner : mesh.connectivity->Triangles().col(closest.triangle)) {
      const auto off = [&](int v) { return (shape.col(v) - landmarks[i].position).squaredNorm(); };
      if (nearest < 0 || off(corner) < off(nearest)) nearest = corner;
    }
    const auto [found, is_new] = first_at.try_emplace(nearest, i);
    if (!is_new) {
      throw FileError(file + ": " + NameOf(landmarks, found->second) + " and " +
                      NameOf(landmarks, i) + " are nearest to the same vertex " +
                      std::to_string(nearest + 1) + " of " + mesh.names[0] +
                      "; leave one of them out");
    }
    vertices.push_back(nearest);
  }
  return vertices;
}

std::map<std::string, size_t> IndexOfLabels(const std::vector<Landmark>& landmarks,
                                            const std::string& file) {
  std::map<std::string, size_t> index;
  for (size_t i = 0; i < landmarks.size(); ++i) {
    if (!index.try_emplace(landmarks[i].label, i).second) {
      throw FileError(file + ": two landmarks have the label " +
                      internal::Quoted(landmarks[i].label) + "; rename one of them");
    }
  }
  return index;
}

bool AllHaveLabels(const std::vector<Landmark>& landmarks) {
  return std::none_of(landmarks.begin(), landmarks.end(),
                      [](const Landmark& landmark) { return landmark.label.empty(); });
}

bool ShareALabel(const std::vector<Landmark>& first, const std::vector<Landmark>& second) {
  std::set<std::string> labels;
  for (const Landmark& landmark : first) labels.insert(landmark.label);
  return std::any_of(second.begin(), second.end(),
                     [&](const Landmark& landmark) { return labels.count(landmark.label) > 0; });
}

}  // namespace

bool IsSlicerLandmarks(const std::string& file) {
  const std::string extension = internal::FileExtension(file);
  return extension == ".fcsv" || extension == ".json";
}

std::vector<Landmark> ReadLandmarks(const std::string& file) {
  std::string text = internal::ReadFile(file);
  internal::BlankByteOrderMark(&text);
  std::vector<Landmark> landmarks;
  if (internal::FileExtension(file) == ".fcsv") {
    landmarks = FcsvReader(file, text).Read();
  } else if (IsSlicerLandmarks(file)) {
    try {
      landmarks = LandmarksFromJson(internal::ParseJson(text));
    } catch (const InvalidOptions& error) {
      throw FileError(file + ": " + error.what());
    }
  } else {
    landmarks = LandmarksFromText(file, text);
  }
  if (landmarks.empty()) throw FileError(file + ": there is no landmark in it");
  return landmarks;
}

MatchedLandmarks MatchLandmarks(const std::string& template_file, const std::string& target_file,
                                const Poses& template_mesh, const Poses& target) {
  const std::vector<Landmark> first = ReadLandmarks(template_file);
  const std::vector<Landmark> second = ReadLandmarks(target_file);
  MatchedLandmarks matched;
  std::vector<size_t> of_template, of_target;  // the landmarks of each pair
  const bool have_labels = AllHaveLabels(first) && AllHaveLabels(second);
  if (have_labels && ShareALabel(first, second)) {
    const std::map<std::string, size_t> in_first = IndexOfLabels(first, template_file);
    const std::map<std::string, size_t> in_second = IndexOfLabels(second, target_file);
    const auto warn = [&](const std::string& file, const std::string& landmark,
                          const std::string& other) {
      matched.warnings.push_back(file + ": " + landmark + " was ignored, because " + other +
                                 " has none of this label");
    };
    for (size_t i = 0; i < first.size(); ++i) {
      const auto found = in_second.find(first[i].label);
      if (found != in_second.end()) {
        of_template.push_back(i);
        of_target.push_back(found->second);
      } else {
        warn(template_file, NameOf(first, i), target_file);
      }
    }
    for (size_t i = 0; i < second.size(); ++i) {
      if (in_first.count(second[i].label) == 0) warn(target_file, NameOf(second, i), template_file);
    }
  } else {
    if (first.size() != second.size()) {
      throw FileError(target_file + ": has " + std::to_string(second.size()) + " landmarks, " +
                      template_file + " has " + std::to_string(first.size()) +
                      "; give both the same number in the same order, or the same labels");
    }
    if (have_labels) {
      matched.warnings.push_back("no label of " + template_file + " is in " + target_file +
                                 "; landmarks were matched by their order");
    }
    of_template.resize(first.size());
    std::iota(of_template.begin(), of_template.end(), size_t{0});
    of_target = of_template;
  }
  const std::vector<int> from = VerticesAt(first, of_template, template_file, template_mesh);
  const std::vector<int> to = VerticesAt(second, of_target, target_file, target);
  for (size_t k = 0; k < from.size(); ++k) matched.markers.push_back({from[k], to[k]});
  return matched;
}

}  // namespace shapespace
