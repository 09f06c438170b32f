// The functions that worker.js calls. Each takes and returns plain objects and arrays of
// JavaScript, and returns {error: ...} for what the library throws, which worker.js passes on.

#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <emscripten/bind.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/read_file.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/deformation/internal/option_fields.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/internal/option_fields.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/geodesic/internal/option_fields.h>
#include <shapespace/output/internal/option_fields.h>
#include <shapespace/output/path_output.h>
#include <shapespace/path/path_file.h>
#include <shapespace/statistics/average.h>
#include <shapespace/statistics/internal/option_fields.h>
#include <shapespace/transfer/internal/option_fields.h>
#include <shapespace/transfer/transfer.h>

#include "arrays.h"
#include "options.h"

namespace shapespace::javascript {
namespace {

// More than the address space of 4 GiB is never to be had.
constexpr double kMemoryLimit = 2e9;

constexpr const char* kPathFile = "/path.path";

template <typename Options>
Options WithLimit() {
  Options options;
  options.memory_limit = kMemoryLimit;
  return options;
}

// Progress as events of JavaScript: {stage, done, total, share}.
class Events : public Progress {
 public:
  explicit Events(val on_progress) : on_progress_(std::move(on_progress)) {}

  bool Report(const std::string& stage, int done, int total) override {
    val event = val::object();
    event.set("stage", stage);
    event.set("done", done);
    event.set("total", total);
    event.set("share", share_);
    on_progress_(event);
    return true;
  }
  void ReportShare(double share) override { share_ = share; }

 private:
  const val on_progress_;
  double share_ = 0;
};

// A sentence of the library with options as they are written in JavaScript.
std::string WithNamesOfOptions(std::string sentence) {
  for (const std::string name :
       {"allow_mirrored", "allow_mismatch", "allow_nonmanifold", "memory_limit"}) {
    const size_t at = sentence.find(name);
    if (at != std::string::npos) sentence.replace(at, name.size(), CamelCase(name));
  }
  return sentence;
}

val ErrorOf(const std::string& kind, const Error& error) {
  val result = val::object();
  result.set("kind", kind);
  result.set("message", WithNamesOfOptions(WithoutFolder(error.what())));
  result.set("option", CamelCase(error.option()));
  return result;
}

// What `body` returns, or {error} if it throws.
val Guarded(const std::function<val()>& body) {
  val error = val::undefined();
  try {
    return body();
  } catch (const InvalidOptions& e) {
    std::vector<std::string> fields;
    for (const std::string& field : e.fields()) fields.push_back(CamelCase(field));
    error = ErrorOf("OptionsError", InvalidOptions(fields, e.problem()));
    error.set("fields", FromStrings(fields));
  } catch (const FileError& e) {
    error = ErrorOf("FileError", e);
  } catch (const MismatchError& e) {
    error = ErrorOf("MismatchError", e);
  } catch (const MeshError& e) {
    error = ErrorOf("MeshError", e);
  } catch (const Error& e) {
    error = ErrorOf("SolverError", e);
  } catch (const std::bad_alloc&) {
    error = ErrorOf("SolverError", Error("memory has ended: use a coarser mesh, or fewer shapes"));
  } catch (const std::exception& e) {
    error = ErrorOf("SolverError", Error(e.what()));
  }
  val result = val::object();
  result.set("error", error);
  return result;
}

// {..., summary, report}: `summary` as an object.
template <typename Summary>
val WithSummary(val result, const Summary& summary) {
  result.set("summary", val::global("JSON").call<val>("parse", summary.ToJson()));
  result.set("report", summary.FullReport());
  return result;
}

// A path with the file that holds all of it.
val WithFile(const Path& path) {
  val result = FromPath(path);
  WritePath(kPathFile, path);
  result.set("file", FromBytes(internal::ReadFile(kPathFile)));
  std::filesystem::remove(kPathFile);
  return result;
}

Path ToPath(const val& file) {
  std::ofstream(kPathFile, std::ios::binary) << ToBytes(file, "path");
  Path path = ReadPath(kPathFile);
  std::filesystem::remove(kPathFile);
  return path;
}

// Of the options of a solve, those of its meshes are in {mesh: {...}}, which is taken out.
Poses TakePoses(const val& poses, val* options) {
  ReadOptions reading;
  *options = val::global("Object").call<val>("assign", val::object(), *options);
  Set((*options)["mesh"], &reading);
  options->delete_(std::string("mesh"));
  return ToPoses(poses, reading);
}

val ReadMeshes(const val& given, val options) {
  const Poses poses = TakePoses(given, &options);
  val result = val::object(), shapes = val::array();
  for (const Shape& shape : poses.shapes) shapes.call<void>("push", FromShape(shape));
  result.set("indices", IndicesOf(*poses.connectivity));
  result.set("shapes", shapes);
  result.set("names", FromStrings(poses.names));
  result.set("notes", FromStrings(poses.notes));
  result.set("warnings", FromStrings(poses.warnings));
  return result;
}

val InterpolatePoses(const val& given, val options, const val& on_progress, const val& on_preview) {
  const Poses poses = TakePoses(given, &options);
  GeodesicOptions geodesic = WithLimit<GeodesicOptions>();
  Set(options, &geodesic);
  if (!on_preview.isNull()) {
    geodesic.preview = [&](const Path& so_far) { on_preview(FromPath(so_far)); };
  }
  Events progress(on_progress);
  const GeodesicResult result = Interpolate(poses, geodesic, &progress);
  return WithSummary(WithFile(result.path), result.summary);
}

val ExtrapolatePath(const val& file, int steps, const val& options, const val& on_progress) {
  ExponentialOptions exponential;
  Set(options, &exponential);
  Events progress(on_progress);
  const ExponentialResult result = Extrapolate(ToPath(file), steps, exponential, &progress);
  return WithSummary(WithFile(result.path), result.summary);
}

val TransferPath(const val& file, const val& target, const val& options, const val& on_progress) {
  TransferOptions transfer = WithLimit<TransferOptions>();
  Set(options, &transfer);
  Events progress(on_progress);
  const TransferResult result =
      Transfer(ToPath(file), ToShape(target, "target"), transfer, &progress);
  return WithSummary(WithFile(result.path), result.summary);
}

val AveragePoses(const val& given, val options, const val& on_progress) {
  const Poses poses = TakePoses(given, &options);
  AverageOptions average;
  Set(options, &average);
  Events progress(on_progress);
  const AverageResult result = Average(poses, average, &progress);
  val mean = val::object();
  mean.set("positions", FromShape(result.shape));
  mean.set("indices", IndicesOf(*poses.connectivity));
  return WithSummary(mean, result.summary);
}

// Outputs of a path, as the tools write them: {files: [{name, data}], warnings}.
val WriteFiles(const val& file, const std::string& name, const val& options) {
  namespace fs = std::filesystem;
  const fs::path folder = "/written";
  fs::remove_all(folder);
  fs::create_directory(folder);
  PathOutputOptions output;
  Set(options, &output.gltf);
  const PathOutputSummary summary =
      WritePathOutput(PathOutput::Of((folder / name).string(), true), ToPath(file), output);
  std::set<fs::path> written;  // in the order of their names
  for (const auto& entry : fs::directory_iterator(folder)) written.insert(entry.path());
  val files = val::array(), result = val::object();
  for (const fs::path& one : written) {
    val content = val::object();
    content.set("name", one.filename().string());
    content.set("data", FromBytes(internal::ReadFile(one.string())));
    files.call<void>("push", content);
  }
  fs::remove_all(folder);
  result.set("files", files);
  result.set("warnings", FromStrings(summary.warnings));
  return result;
}

// A mesh that is deformed again and again.
class LiveDeformer {
 public:
  LiveDeformer(const val& mesh, val options) {
    val meshes = val::array();
    meshes.call<void>("push", mesh);
    const Poses poses = TakePoses(meshes, &options);
    DeformationOptions deformation = WithLimit<DeformationOptions>();
    deformation.metric = MetricOptions::Deformation(*poses.connectivity, poses.shapes.front());
    Set(options, &deformation);
    deformer_.emplace(poses.connectivity, poses.shapes.front(), deformation);
  }

  // handles: [{vertices, positions?, hard?, weight?, name?}]; without positions they stay.
  val Update(const val& given, const val& on_progress) {
    std::vector<DeformationHandle> handles;
    const int count = given["length"].as<int>();
    for (int i = 0; i < count; ++i) handles.push_back(ToHandle(given[i], i));
    Events progress(on_progress);
    const DeformationResult result = deformer_->Deform(handles, &progress);
    return WithSummary(FromPath(result.path), result.summary);
  }

 private:
  static DeformationHandle ToHandle(const val& given, int index) {
    const std::string name = "handles[" + std::to_string(index) + "]";
    DeformationHandle handle;
    Value<bool>::Set(Or(given["hard"], handle.hard), name + ".hard", &handle.hard);
    Value<double>::Set(Or(given["weight"], handle.weight), name + ".weight", &handle.weight);
    handle.name = given["name"].isString() ? given["name"].as<std::string>() : name;
    handle.vertices = ToIntegers(given["vertices"], name + ".vertices");
    if (!given["positions"].isUndefined()) {
      handle.positions = ToShape(given["positions"], name + ".positions");
    }
    return handle;
  }

  template <typename T>
  static val Or(const val& given, const T& otherwise) {
    return given.isUndefined() ? val(otherwise) : given;
  }

  std::optional<Deformer> deformer_;
};

// What JavaScript calls. A deformation is {handle: LiveDeformer}, or {error}.
val MakeDeformer(val mesh, val options) {
  return Guarded([&] {
    val result = val::object();
    result.set("deformer", std::make_shared<LiveDeformer>(mesh, options));
    return result;
  });
}

}  // namespace

EMSCRIPTEN_BINDINGS(shapespace) {
  using emscripten::function;
  function(
      "read",
      +[](val poses, val options) { return Guarded([&] { return ReadMeshes(poses, options); }); });
  function(
      "interpolate", +[](val poses, val options, val on_progress, val on_preview) {
        return Guarded([&] { return InterpolatePoses(poses, options, on_progress, on_preview); });
      });
  function(
      "extrapolate", +[](val path, int steps, val options, val on_progress) {
        return Guarded([&] { return ExtrapolatePath(path, steps, options, on_progress); });
      });
  function(
      "transfer", +[](val path, val target, val options, val on_progress) {
        return Guarded([&] { return TransferPath(path, target, options, on_progress); });
      });
  function(
      "average", +[](val poses, val options, val on_progress) {
        return Guarded([&] { return AveragePoses(poses, options, on_progress); });
      });
  function(
      "write", +[](val path, std::string name, val options) {
        return Guarded([&] { return WriteFiles(path, name, options); });
      });
  function("makeDeformer", &MakeDeformer);
  emscripten::class_<LiveDeformer>("LiveDeformer")
      .smart_ptr<std::shared_ptr<LiveDeformer>>("LiveDeformerPointer")
      .function(
          "update", +[](LiveDeformer& self, val handles, val on_progress) {
            return Guarded([&] { return self.Update(handles, on_progress); });
          });
}

}  // namespace shapespace::javascript
