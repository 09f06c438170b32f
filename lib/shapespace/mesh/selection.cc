#include <shapespace/mesh/selection.h>

#include <algorithm>
#include <cstdint>
#include <sstream>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/quoted.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/mesh/internal/selection_json.h>

namespace shapespace {
namespace {

using internal::FailIn;
using internal::Field;
using internal::FieldOfAny;

using Flags = std::vector<bool>;  // of each vertex, whether it is selected

void CheckNumbers(const Eigen::Ref<const Eigen::VectorXd>& numbers, const std::string& field) {
  if ((numbers.array().abs() <= kLargestCoordinate).all()) return;  // false for nan
  std::ostringstream message;
  message << "must be from " << -kLargestCoordinate << " to " << kLargestCoordinate;
  FailIn(field, message.str());
}

void ValidateNested(const Selection& selection, const std::string& field) {
  if (selection.vertices.empty() && !selection.ball && !selection.box && !selection.halfspace &&
      !selection.group && selection.any.empty()) {
    FailIn(field, "is empty; give one of vertices, ball, box, halfspace, group, any");
  }
  for (const auto& [first, last] : selection.vertices) {
    const auto from = std::int64_t{first} + 1, to = std::int64_t{last} + 1;
    const std::string own = Field(field, "vertices");
    if (from < 1) {
      FailIn(own,
             std::to_string(from) + " is not a vertex number; the first vertex has the number 1");
    }
    if (to < from) {
      FailIn(own, "the range [" + std::to_string(from) + ", " + std::to_string(to) +
                      "] ends before it begins; swap its numbers");
    }
  }
  if (selection.ball) {
    const std::string own = Field(field, "ball");
    CheckNumbers(selection.ball->centre, Field(own, "centre"));
    CheckNumbers(Eigen::Matrix<double, 1, 1>(selection.ball->radius), Field(own, "radius"));
    if (selection.ball->radius < 0) FailIn(Field(own, "radius"), "must be zero or more");
  }
  if (selection.box) {
    const std::string own = Field(field, "box");
    CheckNumbers(selection.box->low, Field(own, "low"));
    CheckNumbers(selection.box->high, Field(own, "high"));
    for (int axis = 0; axis < 3; ++axis) {
      if (selection.box->low(axis) <= selection.box->high(axis)) continue;
      FailIn(own, std::string("its low ") + "xyz"[axis] + " is above its high one; swap them");
    }
  }
  if (selection.halfspace) {
    const std::string own = Field(field, "halfspace");
    CheckNumbers(selection.halfspace->point, Field(own, "point"));
    CheckNumbers(selection.halfspace->normal, Field(own, "normal"));
    if (selection.halfspace->normal.isZero(0)) {
      FailIn(Field(own, "normal"), "must not be zero, because it defines the side");
    }
  }
  for (size_t i = 0; i < selection.any.size(); ++i) {
    ValidateNested(selection.any[i], FieldOfAny(field, i));
  }
}

bool HasWord(const std::string& names, const std::string& name) {
  for (internal::LineWords words(names); !words.Done();) {
    if (words.Next() == name) return true;
  }
  return false;
}

// Evaluates selections in one shape of one mesh.
class Selector {
 public:
  Selector(const Shape& shape, const Connectivity& connectivity, const Appearance& appearance)
      : shape_(shape),
        connectivity_(connectivity),
        appearance_(appearance),
        low_(shape.rowwise().minCoeff()),
        high_(shape.rowwise().maxCoeff()),
        slack_(1e-9 * (high_ - low_).norm()) {}

  Flags Run(const Selection& selection, const std::string& field) const {
    Flags selected(shape_.cols(), true);
    // Removes the vertices for which `holds` is false.
    const auto restrict_to = [&](const auto& holds) {
      for (int v = 0; v < shape_.cols(); ++v) selected[v] = selected[v] && holds(v);
    };
    if (!selection.vertices.empty()) {
      const Flags listed = OfRanges(selection, Field(field, "vertices"));
      restrict_to([&](int v) { return listed[v]; });
    }
    if (selection.ball) {
      restrict_to([&](int v) {
        return (shape_.col(v) - selection.ball->centre).norm() <= selection.ball->radius + slack_;
      });
    }
    if (selection.box) {
      restrict_to([&](int v) {
        return (shape_.col(v).array() >= selection.box->low.array() - slack_).all() &&
               (shape_.col(v).array() <= selection.box->high.array() + slack_).all();
      });
    }
    if (selection.halfspace) {
      const Eigen::Vector3d normal = selection.halfspace->normal.stableNormalized();
      restrict_to(
          [&](int v) { return normal.dot(shape_.col(v) - selection.halfspace->point) >= -slack_; });
    }
    if (selection.group) {
      const Flags grouped = OfGroup(*selection.group, Field(field, "group"));
      restrict_to([&](int v) { return grouped[v]; });
    }
    if (!selection.any.empty()) {
      Flags united(shape_.cols(), false);
      for (size_t i = 0; i < selection.any.size(); ++i) {
        const Flags one = Run(selection.any[i], FieldOfAny(field, i));
        for (size_t v = 0; v < one.size(); ++v) united[v] = united[v] || one[v];
      }
      restrict_to([&](int v) { return united[v]; });
    }
    if (std::find(selected.begin(), selected.end(), true) == selected.end()) {
      FailIn(field, NothingIn(selection));
    }
    return selected;
  }

 private:
  Flags OfRanges(const Selection& selection, const std::string& field) const {
    Flags listed(shape_.cols(), false);
    for (const auto& [first, last] : selection.vertices) {
      if (last >= shape_.cols()) {
        FailIn(field, std::to_string(std::int64_t{last} + 1) +
                          " is not a vertex of this mesh, which has " +
                          std::to_string(shape_.cols()));
      }
      std::fill(listed.begin() + first, listed.begin() + last + 1, true);
    }
    return listed;
  }

  Flags OfGroup(const std::string& name, const std::string& field) const {
    Flags grouped(shape_.cols(), false);
    bool is_there = false;
    std::string others;
    for (const PolygonNames* kind : {&appearance_.groups, &appearance_.objects}) {
      for (const std::string& other : kind->names) {
        others += (others.empty() ? "" : ", ") + internal::Quoted(other);
      }
      for (size_t polygon = 0; polygon < kind->of_polygon.size(); ++polygon) {
        const int index = kind->of_polygon[polygon];
        if (index < 0 || (kind->names[index] != name && !HasWord(kind->names[index], name))) {
          continue;
        }
        is_there = true;
        for (int c = connectivity_.PolygonBegin()[polygon];
             c < connectivity_.PolygonBegin()[polygon + 1]; ++c) {
          grouped[connectivity_.Corners()[c]] = true;
        }
      }
    }
    if (is_there) return grouped;
    constexpr size_t kLongest = 400;
    if (others.size() > kLongest) others = others.substr(0, kLongest) + " ...";
    FailIn(field, "no polygon has the group or object " + internal::Quoted(name) +
                      (others.empty() ? "; this mesh has none at all (OBJ files have them: g and o)"
                                      : "; this mesh has " + others));
  }

  std::string NothingIn(const Selection& selection) const {
    constexpr size_t kLongest = 200;
    std::string text = ToText(selection);
    if (text.size() > kLongest) text = text.substr(0, kLongest) + " ...";
    const Eigen::IOFormat row(Eigen::StreamPrecision, Eigen::DontAlignCols, ", ", ", ", "", "", "[",
                              "]");
    std::ostringstream message;
    message << "no vertex is in " << text << "; the shape lies between "
            << low_.transpose().format(row) << " and " << high_.transpose().format(row);
    const int said = !selection.vertices.empty() + selection.ball.has_value() +
                     selection.box.has_value() + selection.halfspace.has_value() +
                     selection.group.has_value() + !selection.any.empty();
    if (said > 1) message << ". Vertices must fit all keys; for any of them write {\"any\": [...]}";
    return message.str();
  }

  const Shape& shape_;
  const Connectivity& connectivity_;
  const Appearance& appearance_;
  const Eigen::Vector3d low_, high_;
  const double slack_;  // boundaries are widened by this, because coordinates are rounded
};

}  // namespace

void Selection::Validate() const { ValidateNested(*this, ""); }

std::vector<int> SelectVertices(const Selection& selection, const Shape& shape,
                                const Connectivity& connectivity, const Appearance& appearance) {
  selection.Validate();
  if (shape.cols() != connectivity.NumVertices()) {
    throw MeshError("a shape of " + std::to_string(shape.cols()) +
                    " vertices does not belong to a mesh that has " +
                    std::to_string(connectivity.NumVertices()));
  }
  appearance.Validate(connectivity.NumVertices(), connectivity.NumPolygons(),
                      static_cast<int>(connectivity.Corners().size()));
  const Flags selected = Selector(shape, connectivity, appearance).Run(selection, "");
  std::vector<int> vertices;
  for (size_t v = 0; v < selected.size(); ++v) {
    if (selected[v]) vertices.push_back(static_cast<int>(v));
  }
  return vertices;
}

}  // namespace shapespace
