#ifndef SHAPESPACE_OUTPUT_DETAIL_STAGE_H_
#define SHAPESPACE_OUTPUT_DETAIL_STAGE_H_

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/output/detail/frame.h>
#include <shapespace/output/detail/ray_scene.h>
#include <shapespace/output/detail/ruler.h>
#include <shapespace/output/picture.h>

namespace shapespace::internal {

/// Checks what a stage is made of.
/// \throw InvalidOptions, MeshError as RenderFilmStrip.
void CheckPicture(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                  const FilmStripOptions& options);

/// The cells in which some shapes are drawn: all of one size, with one scale, view and light.
struct View {
  std::vector<Camera> cameras;  ///< of each cell; they differ in `centre` alone
  std::optional<Ruler> ruler;   ///< the ground that they see
};

/// Shapes that CheckPicture accepts, ready to be drawn in cells.
class Stage {
 public:
  /// Of `shapes`, those numbered in `chosen` are drawn, in this order. Cells are at least
  /// `least_width` pixels wide. If `in_place`, they show the same part of the world, otherwise each
  /// shape is in the middle of its cell. `connectivity` and `options` must outlive the stage.
  /// \throw InvalidOptions if the shapes would be too small to be seen, or for a view that is not
  ///        horizontal with a ground line; Error if Embree fails.
  Stage(const Connectivity& connectivity, const std::vector<Shape>& shapes, std::vector<int> chosen,
        int least_width, bool in_place, const FilmStripOptions& options);

  int NumCells() const { return static_cast<int>(chosen_.size()); }
  const Camera& FirstCamera() const { return view_.cameras.front(); }
  const std::optional<Ruler>& ruler() const { return view_.ruler; }

  /// What the colours of values or groups mean; of width 0 if there are none.
  const RgbImage& legend() const { return legend_; }

  /// Draws cell i, of the size of the first camera's frame, with its upper left pixel at (left,
  /// top). Safe to be called from several threads for different parts of an image.
  void Draw(int i, int left, int top, RgbImage* image) const;

 private:
  void PrepareValues();

  const FilmStripOptions& options_;
  const std::vector<int> chosen_;
  std::vector<Shape> drawn_;  // in the unit ball
  std::optional<RayTracer> tracer_;
  View view_;
  std::vector<Eigen::VectorXd> values_;  // of the cells, in units of the scale's end
  Eigen::VectorXi marks_;
  RgbImage legend_;
};

/// The axes of the camera of such a stage.
Axes StageAxes(const Connectivity& connectivity, const std::vector<Shape>& shapes,
               const std::vector<int>& chosen, const FilmStripOptions& options);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_STAGE_H_
