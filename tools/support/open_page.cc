#include "support/open_page.h"

#include <filesystem>

#include <shapespace/base/internal/system.h>

#include "support/tool.h"

namespace shapespace::tools {

void OpenPage(const std::string& file) {
  namespace fs = std::filesystem;
  const bool opened = internal::ShowInBrowser(fs::absolute(fs::u8path(file)).u8string());
  if (!opened) Note(file, ": the system shows it in no browser; open it in yours");
}

}  // namespace shapespace::tools
