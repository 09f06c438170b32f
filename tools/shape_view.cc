// Writes a page that shows paths, animations, spaces of poses and meshes in a browser.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <list>
#include <ostream>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/base/internal/read_file.h>
#include <shapespace/exploration/space_file.h>
#include <shapespace/exploration/space_page.h>
#include <shapespace/files/read.h>
#include <shapespace/output/page.h>

#include "support/camera_flags.h"
#include "support/console.h"
#include "support/files.h"
#include "support/flag_group.h"
#include "support/open_page.h"
#include "support/outside_files_flag.h"
#include "support/tool.h"
#include "viewer/page.h"

DEFINE_string(output, "", "the page to write: .html; default: the name of the file that it shows");
DEFINE_bool(open, false, "show the page in the browser when it is written");
DEFINE_bool(solver, false,
            "without FILE: a page that computes motions itself, of meshes that are dropped on it");
FLAG_GROUP(view, "Page", "open, output, solver");

namespace shapespace::tools {
namespace {

bool IsMesh(const std::string& extension) {
  return extension == ".obj" || extension == ".ply" || extension == ".off" || extension == ".stl";
}

// Checks by their names that `files` can be shown.
void CheckKinds(const std::vector<std::string>& files) {
  if (files.empty() || files.size() > 2) throw UsageError("name one file, or two to compare");
  for (const std::string& file : files) {
    const std::string extension = internal::FileExtension(file);
    if (extension != ".path" && extension != ".glb" && extension != ".space" &&
        !IsMesh(extension)) {
      throw UsageError(file +
                       ": must be a .path, .glb or .space, or a mesh: .obj, .ply, .off, .stl");
    }
    if (extension == ".space" && files.size() > 1) {
      throw UsageError(file + ": a space is shown alone");
    }
    if (IsMesh(extension) != IsMesh(internal::FileExtension(files[0]))) {
      throw UsageError(file + ": a mesh is shown alone or beside another mesh");
    }
  }
}

// In the present folder if it is not given: walk.path becomes walk.html, and two files
// a_and_b.html.
std::string OutputFromFlag(const std::vector<std::string>& files) {
  if (FLAGS_solver && !IsGiven("output")) return "shapespace.html";
  if (IsGiven("output")) {
    const std::string extension = internal::FileExtension(FLAGS_output);
    if (extension == ".html" || extension == ".htm") return FLAGS_output;
    throw UsageError("--output " + FLAGS_output + ": must end in .html");
  }
  std::string name;
  for (const std::string& file : files) {
    name += (name.empty() ? "" : "_and_") + std::filesystem::u8path(file).stem().u8string();
  }
  return name + ".html";
}

// The name of a file on the page: with its folder only where the other file has the same name.
std::string NameOf(const std::string& file, const std::vector<std::string>& files) {
  const auto name = [](const std::string& of) { return std::filesystem::u8path(of).filename(); };
  const auto same = std::count_if(files.begin(), files.end(), [&](const std::string& other) {
    return name(other) == name(file);
  });
  return same > 1 ? file : name(file).u8string();
}

// Its vertices have the numbers that all tools give them. A mesh that a solver would refuse,
// because it is no manifold, can be shown and picked all the same.
PageMesh ReadPageMesh(const std::string& file, const std::string& name) {
  ReadOptions options;
  options.allow_nonmanifold = true;
  options.loose_components = true;
  const Poses mesh = MakePoses({ReadSoup(file)}, options);
  for (const std::string& warning : mesh.warnings) Err() << "warning: " << warning << '\n';
  return {mesh.connectivity, mesh.shapes[0], mesh.soup.appearance.vertex_colours, name, file};
}

void CheckIsGlb(const std::string& file, const std::string& bytes) {
  if (bytes.compare(0, 4, "glTF") != 0) {
    throw FileError(file + ": is not a binary glTF file: it does not begin with the letters glTF");
  }
  const auto number = [&](size_t at) {  // little-endian
    std::uint32_t value = 0;
    for (size_t k = 4; k > 0; --k)
      value = value << 8 | static_cast<unsigned char>(bytes[at + k - 1]);
    return value;
  };
  if (bytes.size() < 12 || number(4) != 2 || number(8) != bytes.size()) {
    throw FileError(file + ": is truncated, or not of version 2 of glTF; make it again");
  }
}

void TellWritten(const std::string& output) {
  Out() << "wrote " << output << (FLAGS_open ? "" : "; open it in a browser, or give --open")
        << '\n';
  if (FLAGS_open) OpenPage(output);
}

void WriteSolver(const std::string& output) {
  CheckCanBeWritten(output);
  CheckHasSolver();
  internal::WriteFileAtomically(output, [](std::ostream& out) { out << SolverPage(); });
  TellWritten(output);
}

void Run(const std::vector<std::string>& files) {
  if (FLAGS_solver) {
    if (!files.empty()) {
      throw UsageError("--solver: meshes are dropped on the page, and not named here");
    }
    return WriteSolver(OutputFromFlag(files));
  }
  CheckKinds(files);
  const std::string output = OutputFromFlag(files);
  const PageView view = ViewFromFlags();
  CheckNothingIsOverwritten(files, {{"output", {output}}});
  CheckCanBeWritten(output);
  CheckHasViewer();
  std::list<Path> paths;  // scenes contain pointers to them
  std::vector<PageScene> scenes;
  for (const std::string& file : files) {
    const std::string name = NameOf(file, files);
    if (internal::FileExtension(file) == ".path") {
      paths.push_back(ReadPathAndTell(file));
      scenes.push_back(PagePath{&paths.back(), name, file, FLAGS_allow_outside_files});
    } else if (internal::FileExtension(file) == ".space") {
      scenes.push_back(PageOf(ReadSpace(file), name));
    } else if (IsMesh(internal::FileExtension(file))) {
      scenes.push_back(ReadPageMesh(file, name));
    } else {
      scenes.push_back(PageGlb{internal::ReadFile(file), name});
      CheckIsGlb(file, std::get<PageGlb>(scenes.back()).bytes);
    }
  }
  std::vector<std::string> warnings;
  WritePage(output, std::string(ViewerPage()), scenes, view, &warnings);
  for (const std::string& warning : warnings) Warn(output, ": ", warning);
  TellWritten(output);
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  return RunTool(
      argc, argv,
      {"shape-view",
       "a page that shows paths, spaces and meshes in a browser, in one file, without network",
       R"(  shape-view walk.path --open                               writes walk.html and shows it
  shape-view before.path after.path --output compare.html   side by side
  shape-view walk.glb --output walk.html
  shape-view poses.space --output poses.html                shapes at points of a plane
  shape-view --solver                                       a page that computes motions itself
  shape-view cat.obj --up -x                                pick handles and selections
  shape-view cat.obj lion.obj --output markers.html         pick markers on both)",
       {"view", "camera", "outside_files"}},
      Run);
}
