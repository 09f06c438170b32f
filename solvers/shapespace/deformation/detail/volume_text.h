#ifndef SHAPESPACE_DEFORMATION_DETAIL_VOLUME_TEXT_H_
#define SHAPESPACE_DEFORMATION_DETAIL_VOLUME_TEXT_H_

#include <cmath>
#include <string>

#include <shapespace/analysis/shape_error.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace::internal {

inline std::string VolumeText(const ShapeError& error) {
  return std::isfinite(error.volume) ? Format("volume %+.3g%%", 100 * error.volume)
                                     : "volume n/a (the mesh encloses none)";
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_DEFORMATION_DETAIL_VOLUME_TEXT_H_
