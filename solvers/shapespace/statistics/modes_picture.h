#ifndef SHAPESPACE_STATISTICS_MODES_PICTURE_H_
#define SHAPESPACE_STATISTICS_MODES_PICTURE_H_

#include <Eigen/Core>

#include <shapespace/output/picture.h>
#include <shapespace/statistics/shape_model.h>

namespace shapespace {

/// Per vertex the distance from the mean of the model, after rigid alignment, as a share of the
/// diagonal of the mean's bounding box. `shape` is in the user's unit.
Eigen::VectorXd DistanceFromMean(const PoseModes& modes, const Shape& shape);

/// The axis, y or z, that points up in the poses, as film strips choose it.
Eigen::Vector3d UpOf(const PoseModes& modes);

/// A row for each of the first `modes` modes: its shapes at -2, -1, 0, 1 and 2 standard deviations,
/// coloured by their distance from the mean; and below, as bars, the modes' shares of the variance.
/// Of `options`, the width of frames, samples, view, up and title are used.
/// \throw InvalidOptions if there are not so many modes, or none, or as `RenderFilmStrip`.
RgbImage RenderModes(const ShapeModel& model, int modes, const FilmStripOptions& options = {},
                     Progress* progress = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_STATISTICS_MODES_PICTURE_H_
