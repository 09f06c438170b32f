#ifndef SHAPESPACE_BASE_INTERNAL_WITHIN_FOLDER_H_
#define SHAPESPACE_BASE_INTERNAL_WITHIN_FOLDER_H_

#include <string>

// Files that are named in other files.

namespace shapespace::internal {

/// Whether `file` lies in `folder` or below it once all links are followed; it need not exist. An
/// empty folder is the current one. False where the file system does not let this be found out.
bool IsWithinFolder(const std::string& folder, const std::string& file);

/// Ends messages about a file that does not: what the user can do.
inline constexpr char kOutsideRemedy[] =
    " lies outside of the folder from which it may be read; copy it into that folder, or set "
    "allow_outside_files if you trust the file that names it";

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_WITHIN_FOLDER_H_
