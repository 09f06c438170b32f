#include <filesystem>
#include <ostream>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/exploration/space_page.h>
#include <shapespace/output/page.h>

#include "bind.h"
#include "options.h"
#include "progress.h"

namespace shapespace::python {
namespace {

py::array_t<unsigned char> Pixels(const RgbImage& image) {
  py::array_t<unsigned char> pixels(std::vector<py::ssize_t>{image.height, image.width, 3});
  std::copy(image.pixels.begin(), image.pixels.end(), pixels.mutable_data());
  return pixels;
}

void BindImage(py::module_* module) {
  py::class_<RgbImage>(
      *module, "Image",
      "A picture, such as a film strip; notebooks show it. `numpy.asarray` gives its "
      "pixels.")
      .def(py::pickle([](const RgbImage& image) { return Pixels(image); },
                      [](const py::array_t<unsigned char>& pixels) {
                        RgbImage image;
                        image.height = static_cast<int>(pixels.shape(0));
                        image.width = static_cast<int>(pixels.shape(1));
                        image.pixels.assign(pixels.data(), pixels.data() + pixels.size());
                        return image;
                      }))
      .def_property_readonly("pixels", &Pixels, "The pixels, height x width x 3 bytes, sRGB.")
      .def(
          "__array__",
          [](const RgbImage& image, const py::object& dtype, const py::object& /*copy*/) {
            return py::object(dtype.is_none() ? py::object(Pixels(image))
                                              : Pixels(image).attr("astype")(dtype));
          },
          py::arg("dtype") = py::none(), py::arg("copy") = py::none())
      .def(
          "png", [](const RgbImage& image) { return py::bytes(EncodePng(image)); },
          "The bytes of a PNG file.")
      .def("_repr_png_", [](const RgbImage& image) { return py::bytes(EncodePng(image)); })
      .def("_repr_html_",
           [](const RgbImage& image) {
             const auto text = py::module_::import("base64")
                                   .attr("b64encode")(py::bytes(EncodePng(image)))
                                   .attr("decode")("ascii");
             return "<img style=\"max-width: 100%\" src=\"data:image/png;base64," +
                    py::cast<std::string>(text) + "\"/>";
           })
      .def(
          "write",
          [](const RgbImage& image, const std::filesystem::path& file) {
            if (internal::FileExtension(file) != ".png") {
              throw FileError(file.string() + ": a picture is written as .png only");
            }
            WritePng(file, image);
          },
          py::arg("file"), "Writes a PNG file.")
      .def("__repr__", [](const RgbImage& image) {
        return "<shapespace.Image: " + std::to_string(image.width) + " x " +
               std::to_string(image.height) + " pixels>";
      });
}

}  // namespace

RgbImage Draw(const std::shared_ptr<const Connectivity>& connectivity,
              const std::vector<Shape>& shapes, const FilmStripOptions& options) {
  return WithoutLock(py::none(),
                     [=](Progress*) { return RenderFilmStrip(*connectivity, shapes, options); });
}

std::string PageTemplate() {
  return py::cast<std::string>(py::module_::import("shapespace._page").attr("template")());
}

void BindPictures(py::module_* module) {
  BindImage(module);
  module->def("write_text", [](const std::filesystem::path& file, const std::string& text) {
    internal::WriteFileAtomically(file, [&](std::ostream& out) { out << text; });
  });
  // Scenes are paths, two at the most, or a space; and the name of each.
  module->def("make_page", [](const py::list& things, const std::vector<std::string>& names) {
    std::vector<PageScene> scenes;
    for (size_t i = 0; i < names.size(); ++i) {
      if (py::isinstance<PoseSpace>(things[i])) {
        scenes.emplace_back(PageOf(py::cast<const PoseSpace&>(things[i]), names[i]));
      } else {
        scenes.emplace_back(PagePath{&py::cast<const Path&>(things[i]), names[i]});
      }
    }
    return MakePage(PageTemplate(), scenes);
  });
  module->def("film_strip", [](const Poses& poses, const py::dict& given) {
    FilmStripOptions options;
    Set(given, &options);
    return Draw(poses.connectivity, poses.shapes, options);
  });
}

}  // namespace shapespace::python
