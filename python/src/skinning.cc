#include <shapespace/skinning/skinning.h>

#include <filesystem>
#include <utility>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/output/frames.h>
#include <shapespace/output/skinned_gltf.h>

#include "arrays.h"
#include "bind.h"
#include "options.h"
#include "pickling.h"
#include "progress.h"
#include "unlocked.h"

namespace shapespace::python {
namespace {

using Matrix4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

std::vector<Shape> AllSkinned(const SkinnedPath& path) {
  std::vector<Shape> shapes;
  for (int i = 0; i < path.NumShapes(); ++i) shapes.push_back(path.Skinned(i));
  return shapes;
}

py::array_t<double> Transforms(const SkinnedPath& path) {
  py::array_t<double> all(std::vector<py::ssize_t>{path.NumShapes(), path.NumJoints(), 4, 4});
  double* next = all.mutable_data();
  for (size_t i = 0; i < path.motions.size(); ++i, next += 16) {
    Eigen::Map<Matrix4> matrix(next);
    matrix.setIdentity();
    matrix.topRows<3>() = path.motions[i].Matrix(path.joints[i % path.joints.size()]);
  }
  return all;
}

std::vector<std::string> Names(const SkinnedPath& path) {
  std::vector<std::string> names;
  for (const Joint& joint : path.joints) names.push_back(joint.name);
  return names;
}

std::vector<int> Parents(const SkinnedPath& path) {
  std::vector<int> parents;
  for (const Joint& joint : path.joints) parents.push_back(joint.parent);
  return parents;
}

Eigen::Matrix3Xd Pivots(const SkinnedPath& path) {
  Eigen::Matrix3Xd pivots(3, path.NumJoints());
  for (int b = 0; b < path.NumJoints(); ++b) pivots.col(b) = path.joints[b].pivot;
  return pivots;
}

// The weight of every joint for every vertex, joints x vertices.
Eigen::MatrixXd DenseWeights(const SkinnedPath& path) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(path.NumJoints(), path.weights.cols());
  for (Eigen::Index v = 0; v < path.weights.cols(); ++v) {
    for (Eigen::Index k = 0; k < path.weights.rows(); ++k) {
      dense(path.bones(k, v), v) += path.weights(k, v);
    }
  }
  return dense;
}

void WriteSkinning(const SkinningResult& skinning, const std::filesystem::path& file,
                   const py::dict& given) {
  if (internal::FileExtension(file) != ".glb") {
    throw FileError(file.string() + ": bones are written as .glb only");
  }
  SkinnedGltfOptions options;
  const char* own = "key_error";
  if (given.contains(own)) {
    Value<double>::Set(&options.key_error, given.attr("pop")(own), own);
  }
  Set(given, &options.gltf, {own});
  SkinnedGltfSummary summary;
  {
    const Unlocked unlocked;
    summary = WriteSkinnedGltf(file, skinning.path, options);
  }
  Warn(summary.warnings);
}

// Numbers of a joint: axes, pivot; of its motion: rotation, scale, place.
constexpr int kJointNumbers = 12, kMotionNumbers = 15;

Eigen::MatrixXd JointNumbers(const SkinnedPath& path) {
  Eigen::MatrixXd numbers(kJointNumbers, path.NumJoints());
  for (int b = 0; b < path.NumJoints(); ++b) {
    numbers.col(b) << path.joints[b].axes.reshaped(), path.joints[b].pivot;
  }
  return numbers;
}

Eigen::MatrixXd MotionNumbers(const SkinnedPath& path) {
  Eigen::MatrixXd numbers(kMotionNumbers, path.motions.size());
  for (size_t i = 0; i < path.motions.size(); ++i) {
    const JointMotion& motion = path.motions[i];
    numbers.col(i) << motion.rotation.reshaped(), motion.scale, motion.place;
  }
  return numbers;
}

py::tuple PackSkinning(const SkinningResult& skinning) {
  const SkinnedPath& path = skinning.path;
  Poses mesh;
  mesh.connectivity = path.connectivity;
  mesh.shapes = {path.rest};
  mesh.soup = FrameSoup(*path.connectivity, path.appearance);
  return py::make_tuple(Pack(mesh), path.parameters, Names(path), Parents(path),
                        FromMatrix(JointNumbers(path)), FromMatrix(MotionNumbers(path)),
                        FromMatrix(path.bones), FromMatrix(path.weights), path.provenance,
                        skinning.summary, FromMatrix(skinning.summary.vertex_errors),
                        FromMatrix(skinning.summary.shape_errors));
}

SkinningResult UnpackSkinning(const py::tuple& state) {
  const auto mesh = Unpack<Poses>(state[0]);
  SkinningResult skinning;
  SkinnedPath& path = skinning.path;
  path.connectivity = mesh.connectivity;
  path.rest = mesh.shapes.at(0);
  path.appearance = mesh.soup.appearance;
  path.parameters = py::cast<std::vector<double>>(state[1]);
  const auto names = py::cast<std::vector<std::string>>(state[2]);
  const auto parents = py::cast<std::vector<int>>(state[3]);
  const Eigen::MatrixXd joints = ToMatrix(state[4], "joints").transpose();
  for (size_t b = 0; b < names.size(); ++b) {
    Joint joint = {names[b], parents.at(b), joints.col(b).tail<3>(), {}};
    joint.axes = joints.col(b).head<9>().reshaped(3, 3);
    path.joints.push_back(joint);
  }
  const Eigen::MatrixXd motions = ToMatrix(state[5], "motions").transpose();
  for (Eigen::Index i = 0; i < motions.cols(); ++i) {
    JointMotion motion;
    motion.rotation = motions.col(i).head<9>().reshaped(3, 3);
    motion.scale = motions.col(i).segment<3>(9);
    motion.place = motions.col(i).tail<3>();
    path.motions.push_back(motion);
  }
  path.bones = ToMatrix(state[6], "bones").transpose().cast<int>();
  path.weights = ToMatrix(state[7], "weights").transpose();
  path.provenance = py::cast<std::string>(state[8]);
  skinning.summary = py::cast<SkinningSummary>(state[9]);
  skinning.summary.vertex_errors = ToVector(state[10], "vertex_errors");
  skinning.summary.shape_errors = ToVector(state[11], "shape_errors");
  return skinning;
}

void BindSkeleton(py::class_<SkinningResult>* skinning) {
  (*skinning)
      .def_property_readonly(
          "names", [](const SkinningResult& self) { return Names(self.path); },
          "Of the joints, as the file has them.")
      .def_property_readonly(
          "parents",
          [](const SkinningResult& self) {
            const std::vector<int> parents = Parents(self.path);
            return py::array_t<int>(static_cast<py::ssize_t>(parents.size()), parents.data());
          },
          "Of each joint its parent, which comes before it; -1 for the root, which is the first.")
      .def_property_readonly(
          "pivots", [](const SkinningResult& self) { return FromMatrix(Pivots(self.path)); },
          "Where each joint is in the rest pose, joints x 3.")
      .def_property_readonly(
          "transforms", [](const SkinningResult& self) { return Transforms(self.path); },
          "What every shape's bones do to the rest pose, k x joints x 4 x 4: in shape i, bone b "
          "moves the point x to (transforms[i, b] @ [*x, 1])[:3].")
      .def_property_readonly(
          "bones", [](const SkinningResult& self) { return FromMatrix(self.path.bones); },
          "The bones that move each vertex, n x weights_per_vertex.")
      .def_property_readonly(
          "weights", [](const SkinningResult& self) { return FromMatrix(self.path.weights); },
          "Their weights, n x weights_per_vertex, in descending order; of each vertex the sum is "
          "1. What a vertex does not need is bone 0 with weight 0.")
      .def(
          "weight_matrix",
          [](const SkinningResult& self) { return FromMatrix(DenseWeights(self.path)); },
          "The same as one matrix, n x joints.");
}

void BindMotion(py::class_<SkinningResult>* skinning) {
  (*skinning)
      .def("__len__", [](const SkinningResult& self) { return self.path.NumShapes(); })
      .def("__getitem__",
           [](const SkinningResult& self, py::ssize_t i) {
             return FromShape(self.path.Skinned(PositionIn(i, self.path.NumShapes(), "shape")));
           })
      .def_property_readonly(
          "vertices", [](const SkinningResult& self) { return FromShapes(AllSkinned(self.path)); },
          "All shapes as the bones make them, k x n x 3.")
      .def_property_readonly(
          "rest", [](const SkinningResult& self) { return FromShape(self.path.rest); },
          "The rest pose, n x 3.")
      .def_property_readonly(
          "faces",
          [](const SkinningResult& self) {
            return FromMatrix(self.path.connectivity->FileTriangles());
          },
          "The triangles, m x 3.")
      .def_property_readonly(
          "parameters",
          [](const SkinningResult& self) {
            return py::array_t<double>(static_cast<py::ssize_t>(self.path.parameters.size()),
                                       self.path.parameters.data());
          },
          "The time of every shape.")
      .def_property_readonly(
          "vertex_errors",
          [](const SkinningResult& self) { return FromMatrix(self.summary.vertex_errors); },
          "How far each vertex is from its places: root mean square over all shapes, n.")
      .def_property_readonly(
          "shape_errors",
          [](const SkinningResult& self) { return FromMatrix(self.summary.shape_errors); },
          "How far the vertices of each shape are from their places: root mean square, k.")
      .def_readonly("summary", &SkinningResult::summary);
}

}  // namespace

void BindSkinning(py::module_* module) {
  py::class_<SkinningResult> skinning(*module, "Skinning",
                                      R"(A motion as bones and weights make it: what `skin` returns.

A sequence of shapes, n x 3 each, in the frame and unit of the path. In each, a vertex is at the mean
of the places to which its bones move its rest position, weighted by its weights.
)");
  BindSkeleton(&skinning);
  BindMotion(&skinning);
  skinning
      .def(
          "write",
          [](const SkinningResult& self, const std::filesystem::path& file,
             const py::kwargs& options) { WriteSkinning(self, file, options); },
          py::arg("file"),
          R"(Writes a .glb with a skeleton, which engines, browsers and Blender play.

Parameters
----------
file : str or path-like
    It appears whole or not at all.
**options
    Of `GltfOptions`, and `key_error` (0.0001): keys of joints are left out where that moves no point
    of the body by more than this share of half the diagonal of the rest pose.
)")
      .def("_repr_html_",
           [](const SkinningResult& self) {
             return py::cast(Draw(self.path.connectivity, AllSkinned(self.path), {}))
                 .attr("_repr_html_")();
           })
      .def("__repr__",
           [](const SkinningResult& self) {
             return "<shapespace.Skinning: " + self.summary.BriefReport() + ">";
           })
      .def(py::pickle(&PackSkinning, &UnpackSkinning));
  module->def("skin", [](const Path& path, const py::dict& given, const py::object& progress) {
    SkinningOptions options;
    Set(given, &options);
    options.Validate();
    SkinningResult result =
        WithoutLock(progress, [=](Progress* told) { return Skin(path, options, told); });
    result.path.provenance = "shapespace " SHAPESPACE_VERSION " for Python: skin";
    return result;
  });
}

}  // namespace shapespace::python
