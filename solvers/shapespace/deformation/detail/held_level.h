#ifndef SHAPESPACE_DEFORMATION_DETAIL_HELD_LEVEL_H_
#define SHAPESPACE_DEFORMATION_DETAIL_HELD_LEVEL_H_

#include <memory>
#include <vector>

#include <shapespace/deformation/detail/constrained_path.h>
#include <shapespace/deformation/detail/handle_targets.h>
#include <shapespace/metric/metric.h>

namespace shapespace::internal {

/// One level of the hierarchy of a mesh that is deformed by handles. `places` are always the
/// targets of all held vertices, 3 x HandleTargets::Held(), of which the level contains some.
class HeldLevel {
 public:
  /// `rest` is the mesh on this level, which has `vertices` (ascending) of it, each of a connected
  /// `component` (-1: of none). `strength` as in HandleTargets::Restrict.
  HeldLevel(const std::shared_ptr<const Metric>& metric, Shape rest,
            const std::vector<int>& vertices, std::vector<int> component,
            const HandleTargets& targets, double strength);

  ConstrainedPath& Path() { return path_; }
  const ConstrainedPath& Path() const { return path_; }
  const Shape& Rest() const { return path_.Rest(); }
  int NumVertices() const { return static_cast<int>(component_.size()); }

  /// Moves each connected component rigidly so that its held vertices fit their targets.
  void MoveComponents(const Shape& handle_positions, Shape* shape) const;
  /// Moves the held vertices of all shapes but the first to their targets `places`, one matrix per
  /// shape, and all other vertices with them.
  void MoveHandlesTo(const std::vector<Shape>& handle_positions, std::vector<Shape>* shapes) const;
  /// A shape with the vertices of hard handles at their targets, and all other vertices moved with
  /// them, but for those of soft handles.
  Shape WithHardHandlesAt(const Shape& handle_positions, const Shape& shape) const;
  /// Sets the prescribed vertices, of the `last` shape or of any shape, to their targets.
  void Place(const Shape& handle_positions, bool last, Shape* shape) const;
  /// The targets by vertex; 0 for vertices that are not held.
  Shape Target(const Shape& handle_positions) const;

 private:
  struct Held {
    int column;              // of `places`
    int vertex;              // of the level
    bool prescribed, given;  // as in HandleTargets
  };

  std::vector<int> component_;
  ConstrainedPath path_;
  std::vector<Held> held_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_DEFORMATION_DETAIL_HELD_LEVEL_H_
