#ifndef SHAPESPACE_MESH_DIFFERENT_MESHES_H_
#define SHAPESPACE_MESH_DIFFERENT_MESHES_H_

#include <string>

#include <Eigen/Core>

#include <shapespace/base/error.h>

namespace shapespace {
namespace internal {

/// What helps where poses of one mesh are needed and two meshes are given: the end of a message.
/// `correspond` is what fits the first onto the second, as the reader calls it: Correspond.
inline std::string FitOntoOther(const std::string& first, const std::string& second,
                                const std::string& correspond) {
  return "If they never were one mesh, fit " + first + " onto " + second + " with " + correspond;
}

/// What is said of a pose of another mesh, if its number of vertices shows that it is one.
inline std::string OfOtherMesh(const std::string& pose, Eigen::Index vertices, int wanted,
                               const std::string& correspond = "Correspond") {
  return pose + " has " + std::to_string(vertices) + " vertices instead of " +
         std::to_string(wanted) + ". " + FitOntoOther("the mesh", "it", correspond);
}

}  // namespace internal

/// Poses of one mesh are needed, and these are two meshes of different connectivity. `Correspond`
/// fits the first onto the second, which gives two poses of the first.
class DifferentMeshes : public MismatchError {
 public:
  /// The meshes by their names in messages, which are their files if they have any.
  DifferentMeshes(const std::string& problem, const std::string& first, const std::string& second)
      : MismatchError(Message(problem, first, second, "Correspond")),
        problem_(problem),
        first_(first),
        second_(second) {}

  const std::string& first() const { return first_; }
  const std::string& second() const { return second_; }

  /// `what()` for a reader who calls `Correspond` by another name, such as a command line.
  std::string MessageWith(const std::string& correspond) const {
    return Message(problem_, first_, second_, correspond);
  }

 private:
  static std::string Message(const std::string& problem, const std::string& first,
                             const std::string& second, const std::string& correspond) {
    return problem + "\n" + internal::FitOntoOther(first, second, correspond);
  }

  std::string problem_, first_, second_;
};

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_DIFFERENT_MESHES_H_
