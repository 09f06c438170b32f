#ifndef SHAPESPACE_TOOLS_SUPPORT_NEAREST_WORD_H_
#define SHAPESPACE_TOOLS_SUPPORT_NEAREST_WORD_H_

#include <set>
#include <string>

namespace shapespace::tools {

/// The word of `words` that `typed` becomes by the fewest insertions, deletions and changes of a
/// letter; the empty word if that takes more than a third of its letters.
std::string NearestWord(const std::string& typed, const std::set<std::string>& words);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_NEAREST_WORD_H_
