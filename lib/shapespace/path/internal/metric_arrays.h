#ifndef SHAPESPACE_PATH_INTERNAL_METRIC_ARRAYS_H_
#define SHAPESPACE_PATH_INTERNAL_METRIC_ARRAYS_H_

#include <memory>
#include <string>
#include <vector>

#include <shapespace/mesh/appearance.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/internal/array_file.h>

// A metric, a connectivity and an appearance as components of files.

namespace shapespace::internal {

/// Adds a connectivity to a file.
void AddConnectivity(const Connectivity& connectivity, HeaderJson* header, ArrayWriter* arrays);

/// Reads it back. The caller has checked that the file is large enough for so many vertices.
/// \throw FileError, MeshError, or another exception if the header is inconsistent.
std::shared_ptr<const Connectivity> ReadConnectivity(int num_vertices, const ArrayReader& arrays);

/// Adds a metric with its connectivity to a file.
void AddMetric(const Metric& metric, HeaderJson* header, ArrayWriter* arrays);

/// Reads it back.
/// \throw FileError, or another exception if the header is inconsistent.
std::shared_ptr<const Metric> ReadMetric(const HeaderJson& header, const ArrayReader& arrays);

/// Adds rigid motions to a file, as two arrays.
void AddMotions(const std::vector<RigidMotion>& motions, ArrayWriter* arrays);

/// Reads them back. \throw FileError if there are not so many.
std::vector<RigidMotion> ReadMotions(const ArrayReader& arrays, Eigen::Index count);

/// Names may contain any bytes, but JSON only text in UTF-8; other names become a list of bytes.
HeaderJson NamesToJson(const std::vector<std::string>& names);
std::vector<std::string> NamesFromJson(const HeaderJson& json);

/// The same for an appearance. Paths of libraries are relative to `file`, the file that is written
/// or read, so that all can be moved together.
void AddAppearance(const Appearance& appearance, const std::string& file, HeaderJson* header,
                   ArrayWriter* arrays);
Appearance ReadAppearance(const HeaderJson& header, const std::string& file,
                          const ArrayReader& arrays);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_PATH_INTERNAL_METRIC_ARRAYS_H_
