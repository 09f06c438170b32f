#include <shapespace/output/detail/materials.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string_view>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/read_file.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/base/internal/within_folder.h>

namespace shapespace::internal {
namespace {

namespace fs = std::filesystem;

/// Reads one library into a map from names to materials.
class LibraryReader {
 public:
  LibraryReader(const fs::path& file, std::map<std::string, Material>* materials,
                std::vector<std::string>* warnings)
      : file_(file), materials_(materials), warnings_(warnings) {}

  /// \throw FileError if the file cannot be read.
  void Read() {
    const std::string text = ReadFile(file_.u8string());
    Lines lines(text);
    std::string_view line;
    Material* material = nullptr;  // to which the statements belong
    while (lines.Next(&line)) {
      LineWords words(line);
      const std::string_view keyword = words.Next();
      if (keyword == "newmtl") {
        material = &(*materials_)[std::string(words.Rest())];
      } else if (material != nullptr) {
        const char* const problem = ReadStatement(keyword, words, material);
        if (problem == nullptr) continue;
        warnings_->push_back(file_.u8string() + ":" + std::to_string(lines.Number()) + ": " +
                             Quoted(line) + " " + problem);
      }
    }
  }

 private:
  /// Returns the problem with the statement, or null.
  const char* ReadStatement(std::string_view keyword, LineWords words, Material* material) {
    static constexpr char kNotUnderstood[] = "is not understood";
    if (keyword == "Kd") {
      Eigen::Vector3d colour;
      for (double& channel : colour) {
        if (!ReadShare(words.Next(), &channel)) return kNotUnderstood;
      }
      material->colour = colour;
    } else if (keyword == "d") {
      if (!ReadShare(words.Next(), &material->opacity)) return kNotUnderstood;
    } else if (keyword == "Tr") {
      double transparency;
      if (!ReadShare(words.Next(), &transparency)) return kNotUnderstood;
      material->opacity = 1 - transparency;
    } else if (keyword == "map_Kd") {
      std::string name(words.Rest());
      const bool options = name[0] == '-';  // such as a scale; the last word is the file
      if (options) name.erase(0, name.find_last_of(" \t") + 1);
      // Windows path separators.
      std::replace(name.begin(), name.end(), '\\', '/');
      if (name.empty()) return kNotUnderstood;
      material->texture = (file_.parent_path() / fs::u8path(name)).u8string();
      if (options) return "has options, which are not used";
    }
    return nullptr;
  }

  /// A number, clamped to 0 .. 1.
  static bool ReadShare(std::string_view word, double* share) {
    const std::optional<double> number = ParseDouble(word);
    if (!number || !std::isfinite(*number)) return false;
    *share = std::clamp(*number, 0.0, 1.0);
    return true;
  }

  const fs::path file_;
  std::map<std::string, Material>* materials_;
  std::vector<std::string>* warnings_;
};

/// A statement `mtllib` names one file, whose name may contain blanks, or several.
std::vector<fs::path> Files(const fs::path& folder, const std::string& statement) {
  std::error_code ignored;
  std::vector<fs::path> files;
  for (LineWords words(statement); !words.Done();) {
    files.push_back(folder / fs::u8path(words.Next()));
  }
  const fs::path whole = folder / fs::u8path(statement);
  if (files.size() < 2 || fs::exists(whole, ignored)) return {whole};
  return files;
}

}  // namespace

std::vector<std::optional<Material>> ReadMaterials(const Appearance& appearance,
                                                   bool allow_outside_files,
                                                   std::vector<std::string>* warnings) {
  const std::vector<std::string>& names = appearance.materials.names;
  if (names.empty()) return {};
  std::map<std::string, Material> known;
  for (const std::string& library : appearance.material_libraries) {
    for (const fs::path& file : Files(fs::u8path(appearance.folder), library)) {
      if (!allow_outside_files && !IsWithinFolder(appearance.own_folder, file.u8string())) {
        warnings->push_back("material library " + file.u8string() + kOutsideRemedy);
        continue;
      }
      try {
        LibraryReader(file, &known, warnings).Read();
      } catch (const FileError& error) {
        warnings->push_back("material library " + std::string(error.what()));
      }
    }
  }
  std::vector<std::optional<Material>> materials;
  std::string missing;
  for (const std::string& name : names) {
    const auto found = known.find(name);
    materials.push_back(found == known.end() ? std::optional<Material>() : found->second);
    if (found == known.end()) missing += (missing.empty() ? "" : ", ") + Quoted(name);
  }
  if (!missing.empty()) {
    warnings->push_back("no material library describes the materials " + missing +
                        ": they are shown plain");
  }
  return materials;
}

std::optional<TextureImage> ReadTexture(const std::string& file, const Appearance& appearance,
                                        bool allow_outside_files,
                                        std::vector<std::string>* warnings) {
  if (!allow_outside_files && !IsWithinFolder(appearance.own_folder, file)) {
    warnings->push_back("texture " + file + kOutsideRemedy);
    return {};
  }
  TextureImage image;
  try {
    image.bytes = ReadFile(file);
  } catch (const FileError& error) {
    warnings->push_back("texture " + std::string(error.what()) + "; it is left out");
    return {};
  }
  // The signatures of PNG and JPEG.
  if (image.bytes.compare(0, 8, "\x89PNG\r\n\x1a\n") == 0) {
    image.type = "image/png";
  } else if (image.bytes.compare(0, 3, "\xff\xd8\xff") == 0) {
    image.type = "image/jpeg";
  } else {
    warnings->push_back("texture " + file +
                        ": is neither PNG nor JPEG, the formats that are shown; it is left out");
    return {};
  }
  return image;
}

}  // namespace shapespace::internal
