#include <shapespace/correspondence/surface_map.h>

#include <cmath>
#include <optional>
#include <ostream>
#include <string_view>
#include <vector>

#include <Eigen/Dense>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/number_chars.h>
#include <shapespace/base/internal/read_file.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/base/parallel.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/transfer/internal/frames.h>

namespace shapespace {
namespace {

constexpr char kToTarget[] = "to_target", kToTemplate[] = "to_template";

// Per vertex, the rotation nearest to the mean deformation gradient of the triangles around it.
std::vector<Eigen::Matrix3d> Turns(const Connectivity& connectivity, const Shape& rest,
                                   const Shape& moved) {
  std::vector<Eigen::Matrix3d> sums(rest.cols(), Eigen::Matrix3d::Zero());
  for (int f = 0; f < connectivity.NumTriangles(); ++f) {
    const Eigen::Vector3i triangle = connectivity.Triangles().col(f);
    const Eigen::Matrix3d covariance =
        internal::Frame(rest, triangle) * internal::Frame(moved, triangle).transpose();
    for (const int v : triangle) sums[v] += covariance;
  }
  return sums;
}

void WritePoints(std::ostream& out, const char* name, const SurfacePoints& points,
                 const Eigen::VectorXd& last) {
  char text[32];
  const auto write = [&](double value) {
    const auto end = internal::ToChars(text, text + sizeof text, value);
    out << ' ' << std::string_view(text, static_cast<size_t>(end - text));
  };
  out << name << ' ' << points.NumVertices() << '\n';
  for (int v = 0; v < points.NumVertices(); ++v) {
    out << points.triangle(v) + 1;
    for (int k = 0; k < 3; ++k) write(points.barycentric(k, v));
    write(last(v));
    out << '\n';
  }
}

// Reads the next line that is neither empty nor a comment.
class MapReader {
 public:
  explicit MapReader(const std::string& file)
      : file_(file), text_(internal::ReadFile(file)), lines_(text_) {}

  void ReadPoints(const std::string& name, int num_triangles, SurfacePoints* points,
                  Eigen::VectorXd* last) {
    internal::LineWords header = NextLine(name);
    const std::string_view word = header.Next();
    if (word != name) Fail("expected '" + name + "' and the number of its lines");
    const std::optional<std::int64_t> count = internal::ParseInteger(header.Next());
    // A line has at least eight characters; this limits the memory that a file can request.
    if (!count || *count < 1 || *count > static_cast<std::int64_t>(lines_.BytesLeft() / 8 + 1)) {
      Fail("'" + name + "' must be followed by the number of its lines");
    }
    const auto size = static_cast<int>(*count);
    points->triangle.resize(size);
    points->barycentric.resize(3, size);
    last->resize(size);
    for (int v = 0; v < size; ++v) {
      internal::LineWords words = NextLine(name);
      const std::optional<std::int64_t> triangle = internal::ParseInteger(words.Next());
      if (!triangle || *triangle < 1 || *triangle > num_triangles) {
        Fail("a line begins with a triangle from 1 to " + std::to_string(num_triangles) +
             (triangle == 0 ? "; the first triangle has the number 1, not 0" : ""));
      }
      points->triangle(v) = static_cast<int>(*triangle) - 1;
      for (int k = 0; k < 3; ++k) points->barycentric(k, v) = Number(&words);
      const auto barycentric = points->barycentric.col(v);
      constexpr double kRounding = 1e-6;
      if (barycentric.minCoeff() < -kRounding || std::abs(barycentric.sum() - 1) > kRounding) {
        Fail("the three barycentric coordinates must not be negative, and add up to 1");
      }
      (*last)(v) = Number(&words);
      if (!words.Done()) Fail("there are additional words on this line");
    }
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    internal::FailAt(file_, lines_.Number(), what);
  }

  double Number(internal::LineWords* words) const {
    const std::string_view word = words->Next();
    const std::optional<double> number = internal::ParseDouble(word);
    if (word.empty()) Fail("a number is missing");
    if (!number) Fail(internal::NotANumber(word));
    if (!std::isfinite(*number)) Fail(internal::Quoted(word) + " is not a finite number");
    return *number;
  }

  internal::LineWords NextLine(const std::string& name) {
    std::string_view line;
    while (lines_.Next(&line)) {
      internal::LineWords words(internal::WithoutComment(line));
      if (!words.Done()) return words;
    }
    Fail("the file ends before all of '" + name + "' was read; was it cut off?");
  }

  const std::string file_, text_;
  internal::Lines lines_;
};

}  // namespace

Eigen::MatrixXd PullBack(const SurfacePoints& points, const Eigen::Matrix3Xi& triangles,
                         const Eigen::MatrixXd& function) {
  if (triangles.cols() > 0 && triangles.maxCoeff() >= function.cols()) {
    throw MeshError("the function has " + std::to_string(function.cols()) +
                    " columns; it needs one for each vertex");
  }
  if (points.NumVertices() > 0 && points.triangle.maxCoeff() >= triangles.cols()) {
    throw MeshError("the points lie on triangle " + std::to_string(points.triangle.maxCoeff() + 1) +
                    " of a mesh that has " + std::to_string(triangles.cols()) +
                    "; was it made for the other direction?");
  }
  Eigen::MatrixXd pulled = Eigen::MatrixXd::Zero(function.rows(), points.NumVertices());
  for (int v = 0; v < points.NumVertices(); ++v) {
    for (int k = 0; k < 3; ++k) {
      pulled.col(v) += points.barycentric(k, v) * function.col(triangles(k, points.triangle(v)));
    }
  }
  return pulled;
}

Shape CarryAlong(const SurfacePoints& points, const Connectivity& connectivity, const Shape& rest,
                 const Shape& moved, const Shape& own) {
  if (rest.cols() != connectivity.NumVertices() || moved.cols() != rest.cols() ||
      own.cols() != points.NumVertices()) {
    throw MeshError("the shapes have other numbers of vertices than the map");
  }
  const std::vector<Eigen::Matrix3d> turns = Turns(connectivity, rest, moved);
  const Shape from = PullBack(points, connectivity.Triangles(), rest);
  const Shape to = PullBack(points, connectivity.Triangles(), moved);
  Shape carried(3, own.cols());
  ParallelFor(points.NumVertices(), [&](int v) {
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (int k = 0; k < 3; ++k) {
      covariance +=
          points.barycentric(k, v) * turns[connectivity.Triangles()(k, points.triangle(v))];
    }
    carried.col(v) = to.col(v) + ProcrustesRotation(covariance) * (own.col(v) - from.col(v));
  });
  return carried;
}

void WriteSurfaceMap(const std::string& file, const SurfaceMap& map) {
  internal::WriteFileAtomically(file, [&](std::ostream& out) {
    out << R"(# shapespace map. Each line is a vertex of this mesh, and the point of the other mesh to
# which it is mapped: a triangle, counted from 1, three barycentric coordinates in it, and
# an error as a share of the square root of the area. For vertices of the template the
# error is the distance after mapping there and back; for those of the target it is the
# distance from the fitted template.
)";
    WritePoints(out, kToTarget, map.to_target, map.round_trip);
    WritePoints(out, kToTemplate, map.to_template, map.gap);
  });
}

SurfaceMap ReadSurfaceMap(const std::string& file, int template_triangles, int target_triangles) {
  MapReader reader(file);
  SurfaceMap map;
  reader.ReadPoints(kToTarget, target_triangles, &map.to_target, &map.round_trip);
  reader.ReadPoints(kToTemplate, template_triangles, &map.to_template, &map.gap);
  return map;
}

}  // namespace shapespace
