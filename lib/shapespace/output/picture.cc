#include <shapespace/output/picture.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/check_range.h>
#include <shapespace/base/parallel.h>
#include <shapespace/output/detail/frame.h>
#include <shapespace/output/detail/key_shapes.h>
#include <shapespace/output/detail/ruler.h>
#include <shapespace/output/detail/stage.h>
#include <shapespace/output/internal/text.h>
#include <shapespace/output/internal/view.h>

namespace shapespace {
namespace {

// A strip wider than this many frame widths is arranged in rows.
constexpr int kWidestStrip = 6;

// Larger pictures are not practical, and exceed the range of the PNG writer.
constexpr double kMaxPixels = 1e8;

// Of all pictures of a film, which are in memory together: about 1 GB.
constexpr double kMaxFilmPixels = 3e8;

void Paste(const RgbImage& part, int left, int top, RgbImage* image) {
  for (int row = 0; row < part.height; ++row) {
    std::copy_n(&part.pixels[3 * static_cast<size_t>(row) * part.width], 3 * part.width,
                &image->pixels[3 * (static_cast<size_t>(top + row) * image->width + left)]);
  }
}

// Indices of the shapes that are drawn.
std::vector<int> ChooseShapes(const std::vector<Shape>& shapes, const FilmStripOptions& options) {
  std::vector<int> poses;
  for (size_t i = 0; i < options.roles.size(); ++i) {
    if (options.roles[i] == ShapeRole::kPose) poses.push_back(static_cast<int>(i));
  }
  return internal::KeyShapes(static_cast<int>(shapes.size()), poses, options.max_frames);
}

// Their labels; none if all are empty.
std::vector<std::string> LabelsOf(const std::vector<int>& chosen, const FilmStripOptions& options) {
  std::vector<std::string> labels;
  if (options.labels.empty()) return labels;
  bool is_any = false;
  for (const int i : chosen) {
    labels.push_back(options.labels[i]);
    is_any = is_any || !labels.back().empty();
  }
  if (!is_any) labels.clear();
  return labels;
}

RgbImage Blank(int width, int height) {
  RgbImage image{width, height,
                 std::vector<unsigned char>(3 * static_cast<size_t>(width) * height)};
  const internal::Colour colour = internal::Background();
  for (size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = internal::ToByte(colour[i % 3]);
  return image;
}

// Where everything is in a picture of some cells of a stage.
class Sheet {
 public:
  // `count` cells in rows of `columns`, each with room for a label if `has_labels`.
  Sheet(const internal::Stage& stage, int count, int columns, bool has_labels,
        const FilmStripOptions& options)
      : stage_(stage),
        columns_(columns),
        text_size_(internal::TextSize(options.frame_width)),
        title_(options.title),
        note_(stage.ruler() ? internal::DescribeRuler(*stage.ruler()) : "") {
    const int line_height = internal::LineHeight(text_size_) + Margin();
    title_height_ = title_.empty() ? 0 : line_height + Margin() / 2;
    cell_height_ = stage.FirstCamera().height + (has_labels ? line_height : 0);
    cells_bottom_ = title_height_ + (count + columns - 1) / columns * cell_height_;
    strip_height_ = cells_bottom_ + (note_.empty() ? 0 : line_height);
    width_ = std::max(columns * CellWidth(), stage.legend().width);
    for (const std::string& text : {title_, note_}) {
      width_ = std::max(width_, internal::TextWidth(text, text_size_) + 2 * Margin());
    }
  }

  double NumPixels() const {
    return static_cast<double>(width_) * (strip_height_ + stage_.legend().height);
  }

  // With all but the cells.
  RgbImage Empty() const {
    RgbImage image = Blank(width_, strip_height_ + stage_.legend().height);
    internal::DrawText(&image, Margin(), Margin() / 2, title_, text_size_);
    internal::DrawText(&image, Margin(), cells_bottom_, note_, text_size_);
    Paste(stage_.legend(), 0, strip_height_, &image);
    return image;
  }

  // Draws cell `i` of the stage as cell `place` of the sheet, over what is empty.
  void DrawCell(int i, int place, const std::string& label, RgbImage* image) const {
    const int left = place % columns_ * CellWidth();
    const int top = title_height_ + place / columns_ * cell_height_;
    stage_.Draw(i, left, top, image);
    if (label.empty()) return;
    const std::string text = internal::Shortened(label, CellWidth() - Margin(), text_size_);
    internal::DrawText(image, left + (CellWidth() - internal::TextWidth(text, text_size_)) / 2,
                       top + stage_.FirstCamera().height, text, text_size_);
  }

 private:
  int CellWidth() const { return stage_.FirstCamera().width; }
  int Margin() const { return text_size_ / 2; }

  const internal::Stage& stage_;
  const int columns_, text_size_;
  const std::string title_, note_;
  int title_height_, cell_height_, cells_bottom_, strip_height_, width_;
};

void CheckPixels(double pixels, double most, int frames, const FilmStripOptions& options) {
  if (pixels <= most) return;
  throw InvalidOptions(
      "frame_width", std::to_string(frames) + " frames of " + std::to_string(options.frame_width) +
                         " pixels are more than " + std::to_string(std::lround(most / 1e6)) +
                         " million pixels; lower it, or the number of frames");
}

}  // namespace

void FilmStripOptions::Validate() const {
  internal::CheckRange("frame_width", frame_width, 16, 2048);
  internal::CheckRange("max_frames", max_frames, 2, 1000);
  internal::CheckRange("columns", columns, 0, 1000);
  internal::CheckRange("samples", samples, 1, 16);
  if (!view.allFinite()) throw InvalidOptions("view", "not finite");
  if (!up.allFinite()) throw InvalidOptions("up", "not finite");
  if (!view.isZero(0) && !up.isZero(0) && internal::Parallel(view, up)) {
    throw InvalidOptions("up", "parallel to view; give another, or none");
  }
  internal::CheckText("legend", legend);
  internal::CheckText("title", title);
  if (ground_line && !std::isfinite(*ground_line))
    throw InvalidOptions("ground_line", "not finite");
}

RgbImage RenderFilmStrip(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                         const FilmStripOptions& options) {
  internal::CheckPicture(connectivity, shapes, options);
  const std::vector<int> chosen = ChooseShapes(shapes, options);
  const int frames = static_cast<int>(chosen.size());
  const int text_size = internal::TextSize(options.frame_width);
  const std::vector<std::string> labels = LabelsOf(chosen, options);
  int label_width = 0;
  for (const std::string& label : labels) {
    label_width = std::max(label_width, internal::TextWidth(label, text_size) + text_size / 2);
  }
  const internal::Stage stage(connectivity, shapes, chosen,
                              std::min(label_width, options.frame_width),
                              options.ground_line.has_value(), options);
  const int widest = kWidestStrip * options.frame_width;
  const int rows = (frames * stage.FirstCamera().width + widest - 1) / widest;
  const int columns =
      options.columns > 0 ? std::min(options.columns, frames) : (frames + rows - 1) / rows;
  const Sheet sheet(stage, frames, columns, !labels.empty(), options);
  CheckPixels(sheet.NumPixels(), kMaxPixels, frames, options);
  RgbImage image = sheet.Empty();
  ParallelFor(frames,
              [&](int i) { sheet.DrawCell(i, i, labels.empty() ? "" : labels[i], &image); });
  return image;
}

std::vector<RgbImage> RenderFilm(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                                 const FilmStripOptions& options) {
  internal::CheckPicture(connectivity, shapes, options);
  std::vector<int> all(shapes.size());
  std::iota(all.begin(), all.end(), 0);
  const internal::Stage stage(connectivity, shapes, all, 0, true, options);
  const int frames = stage.NumCells();
  const bool has_labels = !LabelsOf(all, options).empty();
  const Sheet sheet(stage, 1, 1, has_labels, options);
  CheckPixels(frames * sheet.NumPixels(), kMaxFilmPixels, frames, options);
  std::vector<RgbImage> pictures(shapes.size(), sheet.Empty());
  ParallelFor(frames, [&](int i) {
    sheet.DrawCell(i, 0, has_labels ? options.labels[i] : "", &pictures[i]);
  });
  return pictures;
}

Eigen::Vector3d FilmStripView(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                              const FilmStripOptions& options) {
  internal::CheckPicture(connectivity, shapes, options);
  return internal::StageAxes(connectivity, shapes, ChooseShapes(shapes, options), options).col(2);
}

}  // namespace shapespace
