#include "support/telling.h"

#include <cstdarg>
#include <cstdio>

#include "support/console.h"

namespace shapespace::tools {

void Telling::Say(const char* format, ...) {
  va_list values;
  va_start(values, format);
  va_list again;
  va_copy(again, values);
  std::string part(std::vsnprintf(nullptr, 0, format, values) + 1, '\0');
  std::vsnprintf(part.data(), part.size(), format, again);
  va_end(again);
  va_end(values);
  part.pop_back();  // the zero at the end
  text_ += part;
  Out() << part;
}

}  // namespace shapespace::tools
