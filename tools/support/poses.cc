#include "support/poses.h"

#include <iostream>

#include <gflags/gflags.h>

DEFINE_string(stiffeners, "",
              "text file of further edges to hold: two vertex numbers a line, from 1");
DEFINE_bool(allow_nonmanifold, false,
            "take meshes with non-manifold edges or vertices, or inconsistent winding");

namespace shapespace::tools {

Poses ReadPosesFromFlags(const std::vector<std::string>& files) {
  ReadOptions options;
  options.stiffeners = FLAGS_stiffeners;
  options.allow_nonmanifold = FLAGS_allow_nonmanifold;
  Poses poses = ReadPoses(files, options);
  for (const std::string& warning : poses.warnings) std::cerr << "warning: " << warning << '\n';
  for (const std::string& dropped : poses.soup.dropped) {
    std::cerr << "note: " << dropped << '\n';
  }
  return poses;
}

}  // namespace shapespace::tools
