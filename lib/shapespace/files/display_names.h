#ifndef SHAPESPACE_FILES_DISPLAY_NAMES_H_
#define SHAPESPACE_FILES_DISPLAY_NAMES_H_

#include <string>
#include <vector>

namespace shapespace {

/// Short and distinct names of poses, for what is shown or passed on to others. Files' names
/// (`Poses::names` has both) lose folder and extension, other names remain; a repeated name gets a
/// number from 2 on: "sit", "sit 2".
std::vector<std::string> DisplayNames(const std::vector<std::string>& names);

}  // namespace shapespace

#endif  // SHAPESPACE_FILES_DISPLAY_NAMES_H_
