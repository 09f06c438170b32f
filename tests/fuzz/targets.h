#ifndef SHAPESPACE_TESTS_FUZZ_TARGETS_H_
#define SHAPESPACE_TESTS_FUZZ_TARGETS_H_

#include <string>
#include <vector>

namespace shapespace::fuzz {

/// Something that takes bytes from outside. `run` may throw errors of this library only; anything
/// else that it throws, and a result that contradicts what the library promises, is a finding.
struct Target {
  const char* name;
  void (*run)(const std::string& bytes);
};

/// Readers of all files, in the order of their names in docs/file-formats.md.
std::vector<Target> Readers();

/// Solvers, on small meshes and with options that the bytes describe.
std::vector<Target> Solvers();

/// Runs a target; errors of this library are expected.
/// \throw std::logic_error describing a finding.
void RunOn(const Target& target, const std::string& bytes);

/// \throw std::logic_error naming the finding unless `is_so`.
void Expect(bool is_so, const char* finding);

}  // namespace shapespace::fuzz

#endif  // SHAPESPACE_TESTS_FUZZ_TARGETS_H_
