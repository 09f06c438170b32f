#ifndef SHAPESPACE_TOOLS_SUPPORT_ERROR_MESSAGE_H_
#define SHAPESPACE_TOOLS_SUPPORT_ERROR_MESSAGE_H_

#include <string>

#include <shapespace/base/error.h>

namespace shapespace::tools {

/// What a person is told of an error: `what()`, with options as flags, and of two different meshes
/// the command line that fits one onto the other.
std::string MessageOf(const Error& error);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_ERROR_MESSAGE_H_
