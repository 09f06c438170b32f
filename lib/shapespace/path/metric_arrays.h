#ifndef SHAPESPACE_PATH_METRIC_ARRAYS_H_
#define SHAPESPACE_PATH_METRIC_ARRAYS_H_

#include <memory>
#include <string>
#include <vector>

#include <shapespace/mesh/appearance.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/array_file.h>

// Private: a metric with its connectivity, and an appearance, as parts of files.

namespace shapespace::internal {

/// Adds what a metric is to a file.
void AddMetric(const Metric& metric, HeaderJson* header, ArrayWriter* arrays);

/// Reads it back. \throw FileError, or another exception if the header is at odds with itself.
std::shared_ptr<const Metric> ReadMetric(const HeaderJson& header, const ArrayReader& arrays);

/// Names of any bytes: JSON holds text in UTF-8 only, so that any other stands as a list of bytes.
HeaderJson NamesToJson(const std::vector<std::string>& names);
std::vector<std::string> NamesFromJson(const HeaderJson& json);

/// The same of an appearance. Libraries are named relative to `file`, which is to be written or was
/// read, so that all can be moved together.
void AddAppearance(const Appearance& appearance, const std::string& file, HeaderJson* header,
                   ArrayWriter* arrays);
Appearance ReadAppearance(const HeaderJson& header, const std::string& file,
                          const ArrayReader& arrays);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_PATH_METRIC_ARRAYS_H_
