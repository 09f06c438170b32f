// Fits a template onto another body and maps the two surfaces onto each other.

#include <filesystem>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/correspondence/correspondence.h>
#include <shapespace/correspondence/correspondence_page.h>
#include <shapespace/correspondence/correspondence_picture.h>
#include <shapespace/files/write.h>
#include <shapespace/output/frames.h>

#include "support/correspondence_flags.h"
#include "support/flag_group.h"
#include "support/frames.h"
#include "support/lists.h"
#include "support/report.h"
#include "support/solve_progress.h"
#include "support/stdin_mesh.h"
#include "support/summary.h"
#include "support/tool.h"
#include "viewer/page.h"

DEFINE_string(output, "fitted.obj,map.txt,check.png",
              "files to write, separated by commas: .obj, .ply, .off or .stl (the fitted "
              "template), .txt (the map in both directions), .png (a picture for judging it), "
              ".html (a page for that, on which markers are mended); - writes the fitted template "
              "to stdout, as PLY");
DEFINE_bool(allow_nonmanifold, false,
            "accept meshes with non-manifold edges or vertices, or inconsistent winding");
DEFINE_bool(open_seams, false,
            "leave a surface open where its borders lie on each other; by default their vertices "
            "are joined, because most files store vertices several times where texture "
            "coordinates, normals or materials change");
FLAG_GROUP(correspond, "Files", "output");

namespace shapespace::tools {
namespace {

std::vector<std::string> Outputs() {
  std::vector<std::string> outputs;
  for (const std::string& output : Split(FLAGS_output)) {
    if (output.empty()) continue;
    const std::string extension = internal::FileExtension(output);
    if (!IsMeshOrStdout(output) && extension != ".txt" && extension != ".png" &&
        extension != ".html") {
      throw UsageError("--output " + output +
                       ": must end in .obj, .ply, .off, .stl, .txt, .png or .html, or be -");
    }
    if (extension == ".html") CheckHasViewer();
    CheckCanBeWritten(output);
    outputs.push_back(output);
  }
  if (outputs.empty()) throw UsageError("--output: names no file");
  return outputs;
}

Poses ReadMesh(const std::string& file) {
  ReadOptions options;
  options.allow_nonmanifold = FLAGS_allow_nonmanifold;
  options.loose_components = true;  // nothing moves
  options.open_seams = FLAGS_open_seams;
  Poses mesh = MakePoses({ReadSoupOrStdin(file)}, options);
  for (const std::string& warning : mesh.warnings) Warn(warning);
  for (const std::string& note : mesh.notes) Note(note);
  for (const std::string& dropped : mesh.soup.dropped) Note(dropped);
  return mesh;
}

// What a page calls a file.
std::string NameOnPage(const std::string& file) {
  return file == "-" ? "stdin" : std::filesystem::u8path(file).filename().u8string();
}

void Run(const std::vector<std::string>& files) {
  if (files.size() != 2) throw UsageError("name two meshes: the template and the target");
  std::vector<std::string> inputs;
  if (!FLAGS_markers.empty()) inputs = MarkerFilesFromFlag();
  inputs.insert(inputs.end(), files.begin(), files.end());
  const CorrespondenceOptions options = CorrespondenceFromFlags();
  const std::vector<std::string> outputs = Outputs();
  CheckNothingIsOverwritten(inputs, {{"output", outputs}, MarkersOutFromFlag(), ReportFromFlag()});
  const Poses first = ReadMesh(files[0]), second = ReadMesh(files[1]);
  std::vector<CorrespondenceMarker> markers;
  if (!FLAGS_markers.empty()) markers = ReadMarkersAndTell(first, second);
  const CorrespondenceResult result =
      Correspond(first.connectivity, first.shapes[0], second.connectivity, second.shapes[0],
                 markers, options, SolveProgress(outputs).get());
  if (!result.summary.candidates.empty()) markers = result.markers;
  PrintSummary(result.summary.BriefReport(), result.summary.warnings, result.summary.Converged());
  for (const std::string& output : outputs) {
    const std::string extension = internal::FileExtension(output);
    if (extension == ".txt") {
      WriteSurfaceMap(output, result.map);
    } else if (extension == ".png") {
      WritePng(output,
               RenderCorrespondence(*first.connectivity, first.shapes[0], *second.connectivity,
                                    second.shapes[0], markers, result));
    } else if (extension == ".html") {
      auto [source, target] =
          PageOf(first.connectivity, first.shapes[0], NameOnPage(files[0]), second.connectivity,
                 second.shapes[0], NameOnPage(files[1]), result);
      source.file = files[0];
      target.file = files[1];
      WritePage(output, std::string(ViewerPage()), {source, target});
    } else {
      WriteMeshAndTell(output, result.fitted,
                       FrameSoup(*first.connectivity, first.soup.appearance));
      continue;
    }
    Out() << "wrote " << output << '\n';
  }
  WriteMarkersAndTell(result);
  WriteReport(result.summary.FullReport(), result.summary.ToJson());
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  return RunTool(
      argc, argv,
      {"shape-correspond",
       "a template fitted onto another body of any connectivity, and the map between them",
       R"(  shape-correspond cat.obj lion.obj --output fitted.obj,map.txt,check.png
  shape-correspond cat.obj lion.obj --output check.html      both bodies, colours and markers
  shape-correspond cat.obj lion.obj --markers cat_lion.txt --output fitted.obj,check.png

Without markers maps are found from both surfaces, and the one that deforms the template least is
taken; the report says how sure that is. Each line of a file of markers names a vertex of the
template and the corresponding one of the target: one or two settle what is left and right, twenty,
at the ends of limbs and at joints, guide the fit alone. Two files of landmarks, as 3D Slicer saves
them, serve as well: --markers cat.fcsv,lion.fcsv. The fitted template has the template's faces, so
every other tool accepts it together with the template's poses. Check the picture or the page before
you rely on the map; the page has the markers, of which it saves those that are mended.

A fit that does not converge is reported; its outputs are written, and the exit code is 0, or 1
with --strict.)",
       {"correspond", "correspondence", "memory", "report", "summary", "outside_files"}},
      Run);
}
