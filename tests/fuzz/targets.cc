#include "fuzz/targets.h"

#include <stdexcept>

#include <shapespace/base/error.h>

namespace shapespace::fuzz {

void RunOn(const Target& target, const std::string& bytes) {
  try {
    target.run(bytes);
  } catch (const Error& error) {
    Expect(!std::string(error.what()).empty(), "an error without a message");
  }
}

void Expect(bool is_so, const char* finding) {
  if (!is_so) throw std::logic_error(finding);
}

}  // namespace shapespace::fuzz
