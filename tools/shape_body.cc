// Poses of bodies made in code.

#include <filesystem>
#include <iostream>
#include <sstream>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/body.h>
#include <shapespace/output/frames.h>

#include "support/tool.h"

DEFINE_int32(triangles, 0, "about how many triangles; 0 takes the body's own number");
DEFINE_string(at, "", "parameter values, separated by commas; without: both ends of the range");
DEFINE_string(output, "body%d.obj", "one file a value, numbered from 0: .obj or .ply");

namespace shapespace::tools {
namespace {

std::vector<double> ValuesFromFlags(const Body& body) {
  if (FLAGS_at.empty()) return {body.begin, body.end};
  std::vector<double> values;
  std::stringstream list(FLAGS_at);
  for (std::string text; std::getline(list, text, ',');) {
    size_t used = 0;
    try {
      values.push_back(std::stod(text, &used));
    } catch (const std::exception&) {
    }
    if (used == 0 || used != text.size()) throw UsageError("--at " + text + ": not a number");
  }
  return values;
}

void CheckOutput() {
  const std::string extension = std::filesystem::path(FLAGS_output).extension().string();
  if (extension != ".obj" && extension != ".ply") {
    throw UsageError("--output " + FLAGS_output + ": must end in .obj or .ply");
  }
  try {
    FrameName(FLAGS_output, 0);
  } catch (const FileError& error) {
    throw UsageError("--output " + std::string(error.what()));
  }
}

void Run(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    for (const BodyInfo& info : ListBodies()) {
      std::cout << info.name << ": " << info.description << '\n';
    }
    return;
  }
  if (arguments.size() > 1) throw UsageError("name one body");
  CheckOutput();
  Body body;
  std::vector<Shape> shapes;
  try {
    body = MakeBody(arguments[0], FLAGS_triangles);
    for (double value : ValuesFromFlags(body)) shapes.push_back(body.pose(value));
  } catch (const InvalidOptions& error) {  // its fields are not named as our flags are
    throw UsageError(error.what());
  }
  WriteFrames(FLAGS_output, shapes, PlainAppearance(*body.connectivity));
  std::cout << body.name << ": " << body.connectivity->NumVertices() << " vertices, "
            << body.connectivity->NumTriangles() << " triangles; " << body.parameter << " from "
            << body.begin << " to " << body.end << '\n';
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  return RunTool(
      argc, argv,
      {"shape-body",
       "poses of bodies made in code, to try things on",
       "  shape-body                                      lists the bodies\n"
       "  shape-body tube --at 0,90 --output tube%d.obj   writes tube0.obj and tube1.obj",
       {"shape_body.cc"}},
      Run);
}
