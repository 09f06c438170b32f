#include <shapespace/output/path_output.h>

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <map>
#include <sstream>
#include <utility>

#include <shapespace/analysis/quality.h>
#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/base/error.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/base/parallel.h>
#include <shapespace/files/point_cache.h>
#include <shapespace/files/write.h>
#include <shapespace/output/detail/film_times.h>
#include <shapespace/output/film.h>
#include <shapespace/output/frames.h>
#include <shapespace/output/page.h>
#include <shapespace/output/vertex_colours.h>
#include <shapespace/output/vtk.h>
#include <shapespace/path/path_file.h>

namespace shapespace {
namespace {

ShapeRole RoleOf(const Path& path, int i) {
  if (std::binary_search(path.poses.begin(), path.poses.end(), i)) return ShapeRole::kPose;
  return i < path.NumShapes() - path.extrapolated ? ShapeRole::kInserted : ShapeRole::kExtrapolated;
}

class Writer {
 public:
  Writer(std::string file, const Path& path, const PathOutputOptions& options)
      : file_(std::move(file)), path_(path), options_(options) {}

  PathOutputSummary Write(PathOutput::Kind kind) {
    switch (kind) {
      case PathOutput::Kind::kPath:
        WritePath(file_, path_);
        break;
      case PathOutput::Kind::kFilmStrip:
        WriteFilmStrip();
        break;
      case PathOutput::Kind::kPictures:
        WritePictures();
        break;
      case PathOutput::Kind::kFilm:
        WritePathFilm();
        break;
      case PathOutput::Kind::kGltf:
        WriteGlb();
        break;
      case PathOutput::Kind::kPointCache:
        WritePointCache(file_, path_.Placed(), options_.point_cache_fps);
        break;
      case PathOutput::Kind::kFrames:
        WriteMeshes(false);
        break;
      case PathOutput::Kind::kLastShape:
        WriteMeshes(true);
        break;
      case PathOutput::Kind::kVtk:
        WriteVtkSeries(file_, path_, options_.reference);
        break;
      case PathOutput::Kind::kUsd:
        WriteUsdLayer();
        break;
      case PathOutput::Kind::kPage:
        WritePage(file_, options_.page_template,
                  {PagePath{&path_,
                            std::filesystem::u8path(file_).stem().u8string(),
                            {},
                            options_.gltf.allow_outside_files}},
                  {options_.film_strip.up, options_.film_strip.view}, &summary_.warnings);
        break;
    }
    return std::move(summary_);
  }

 private:
  bool ByDeviation() const { return options_.colours == PathColours::kDeviation; }

  // Empty if vertices are not coloured by parts.
  Eigen::VectorXi Parts() const {
    if (options_.colours != PathColours::kParts) return {};
    return options_.parts.size() > 0 ? options_.parts : FindRigidParts(path_).of_vertex;
  }

  // Options of pictures of `shown`, which may have other shapes of the path.
  FilmStripOptions PictureOptions(const Path& shown) const {
    FilmStripOptions options = options_.film_strip;
    if (ByDeviation()) {
      const Shape& reference = options_.reference.size() > 0 ? options_.reference : path_.shapes[0];
      for (const Shape& shape : shown.shapes) {
        options.values.push_back(EdgeDeviation(*path_.metric, reference, shape));
      }
      options.legend = "edge length, deviation from the first pose";
    } else if (options_.colours == PathColours::kParts) {
      options.groups = Parts();
      options.legend = "near-rigid parts, by size";
    }
    return options;
  }

  void WriteFilmStrip() const {
    FilmStripOptions options = PictureOptions(path_);
    FilmStripOptions own = FilmStripOf(path_);
    if (options.roles.empty()) options.roles = std::move(own.roles);
    if (options.labels.empty()) options.labels = std::move(own.labels);
    WritePng(file_, RenderFilmStrip(*path_.metric->connectivity, path_.Placed(), options));
  }

  void WritePictures() const {
    FilmStripOptions options = PictureOptions(path_);
    options.frame_width = options_.film_width;
    if (options.roles.empty()) options.roles = FilmStripOf(path_).roles;
    const std::vector<RgbImage> pictures =
        RenderFilm(*path_.metric->connectivity, path_.Placed(), options);
    ParallelFor(path_.NumShapes(), [&](int i) { WritePng(FrameName(file_, i), pictures[i]); });
  }

  void WritePathFilm() const {
    path_.Validate();
    if (path_.shapes.empty()) throw MeshError(file_ + ": the path has no shape to show");
    options_.gltf.Validate();
    const internal::FilmTimes times = internal::ChooseFilmTimes(path_, options_.gltf);
    const Path shown = Resample(path_, times.parameters);
    FilmStripOptions options = PictureOptions(shown);
    options.frame_width = options_.film_width;
    options.labels.clear();
    // Shapes of the film have the role of the nearest shape of the path.
    const std::vector<ShapeRole> roles =
        options.roles.empty() ? FilmStripOf(path_).roles : options.roles;
    options.roles.clear();
    for (const double parameter : times.parameters) {
      options.roles.push_back(roles[internal::NearestParameter(path_.parameters, parameter)]);
    }
    Film film;
    film.pictures = RenderFilm(*path_.metric->connectivity, shown.Placed(), options);
    film.order = times.order;
    film.seconds.assign(times.order.size(), times.seconds);
    film.repeats = options_.gltf.playback != GltfPlayback::kOnce;
    WriteFilm(file_, film);
  }

  void WriteGlb() {
    GltfOptions options = options_.gltf;
    if (ByDeviation()) {
      options.colour_by_deviation = true;
      options.reference = options_.reference;
    }
    if (options_.colours == PathColours::kParts) options.groups = Parts();
    summary_.gltf = WriteGltf(file_, path_, options);
    summary_.colour_end = summary_.gltf.colour_end;
    summary_.warnings = summary_.gltf.warnings;
  }

  // Colours of vertices: of each shape, of all alike, or none.
  std::vector<Eigen::MatrixXd> Colours() {
    if (ByDeviation()) {
      ValueColours deviation = ColourByDeviation(path_, options_.reference);
      summary_.colour_end = deviation.scale_end;
      return std::move(deviation.of_shapes);
    }
    if (options_.colours == PathColours::kParts) return {ColourByGroup(Parts())};
    return {};
  }

  void WriteUsdLayer() {
    UsdOptions options = options_.usd;
    options.colours = Colours();
    summary_.warnings = WriteUsd(file_, path_, options);
  }

  void WriteMeshes(bool last_alone) {
    const Soup soup = FrameSoup(*path_.metric->connectivity, path_.appearance);
    std::vector<Eigen::MatrixXd> colours = Colours();
    if (colours.size() == 1) colours.resize(path_.shapes.size(), Eigen::MatrixXd(colours[0]));
    const Soup last = colours.empty() ? soup : Coloured(soup, colours.back());
    summary_.warnings = NotKept(file_, last);
    if (last_alone) {
      WriteMesh(file_, path_.Placed(path_.NumShapes() - 1), last);
    } else {
      WriteFrames(file_, path_.Placed(), soup, colours);
    }
  }

  const std::string file_;
  const Path& path_;
  const PathOutputOptions& options_;
  PathOutputSummary summary_;
};

}  // namespace

PathOutput PathOutput::Of(const std::string& file, bool last_shape_alone) {
  static const std::map<std::string, Kind> kinds = {
      {".path", Kind::kPath}, {".png", Kind::kFilmStrip},  {".gif", Kind::kFilm},
      {".apng", Kind::kFilm}, {".glb", Kind::kGltf},       {".pc2", Kind::kPointCache},
      {".vtp", Kind::kVtk},   {".mdd", Kind::kPointCache}, {".html", Kind::kPage},
      {".usda", Kind::kUsd}};
  const std::string extension = internal::FileExtension(file);
  const auto known = kinds.find(extension);
  const bool is_mesh = IsWritableMesh(file);
  if (extension == ".mp4" || extension == ".mov" || extension == ".webm") {
    throw FileError(file +
                    ": films are written as .gif, as .apng, or as numbered .png, such as "
                    "film/%03d.png, of which video programs make others: ffmpeg -framerate 25 -i "
                    "film/%03d.png " +
                    file);
  }
  if (known == kinds.end() && !is_mesh) {
    throw FileError(file +
                    ": must end in .path, .png, .gif, .apng, .glb, .usda, .html, .pc2, .mdd, .obj, "
                    ".ply, .off, .stl or .vtp");
  }
  if (is_mesh && last_shape_alone && file.find('%') == file.npos) return {file, Kind::kLastShape};
  const bool is_numbered = IsNumbered(file);
  Kind kind = is_mesh ? Kind::kFrames : known->second;
  if (kind == Kind::kFilmStrip && is_numbered) kind = Kind::kPictures;
  if (kind == Kind::kFrames || kind == Kind::kVtk || kind == Kind::kPictures) {
    FrameName(file, 0);
  } else if (is_numbered) {
    throw FileError(file + ": only meshes, .vtp and .png are numbered; one " + extension +
                    " contains the whole path");
  }
  return {file, kind};
}

FilmStripOptions FilmStripOf(const Path& path) {
  FilmStripOptions options;
  for (int i = 0; i < path.NumShapes(); ++i) {
    options.roles.push_back(RoleOf(path, i));
    std::ostringstream label;
    label << i << ": t = " << std::setprecision(3) << path.parameters[i];
    options.labels.push_back(label.str());
  }
  return options;
}

PathOutputSummary WritePathOutput(const PathOutput& output, const Path& path,
                                  const PathOutputOptions& options) {
  return Writer(output.file, path, options).Write(output.kind);
}

}  // namespace shapespace
