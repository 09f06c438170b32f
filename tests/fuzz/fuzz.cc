// The entry points of libFuzzer, for the target that is named by the environment variable TARGET.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include <glog/logging.h>

#include <shapespace/base/parallel.h>

#include "fuzz/targets.h"

namespace {

shapespace::fuzz::Target target;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  shapespace::SetThreads(1);
  FLAGS_minloglevel = google::GLOG_FATAL;
  const char* name = std::getenv("TARGET");
  std::vector<shapespace::fuzz::Target> all = shapespace::fuzz::Readers();
  for (const auto& solver : shapespace::fuzz::Solvers()) all.push_back(solver);
  for (const auto& one : all) {
    if (name != nullptr && std::string(name) == one.name) {
      target = one;
      return 0;
    }
  }
  std::fprintf(stderr, "set TARGET to one of:");
  for (const auto& one : all) std::fprintf(stderr, " %s", one.name);
  std::fprintf(stderr, "\n");
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    shapespace::fuzz::RunOn(target, std::string(reinterpret_cast<const char*>(data), size));
  } catch (const std::exception& finding) {
    std::fprintf(stderr, "finding: %s\n", finding.what());
    std::abort();
  }
  return 0;
}
