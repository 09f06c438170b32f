#ifndef SHAPESPACE_FILES_DISPLAY_NAMES_H_
#define SHAPESPACE_FILES_DISPLAY_NAMES_H_

#include <string>
#include <vector>

namespace shapespace {

/// A short name of a pose: a file's name loses folder and extension, another remains.
/// `Poses::names` has both.
std::string DisplayName(const std::string& name);

/// Short and distinct names of poses, for what is shown or passed on to others: as above,
/// and a repeated name gets a number from 2 on: "sit", "sit 2".
std::vector<std::string> DisplayNames(const std::vector<std::string>& names);

}  // namespace shapespace

#endif  // SHAPESPACE_FILES_DISPLAY_NAMES_H_
