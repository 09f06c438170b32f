#include <shapespace/statistics/modes_page.h>

#include <filesystem>

#include <shapespace/base/error.h>
#include <shapespace/statistics/modes_picture.h>

namespace shapespace {
namespace {

constexpr double kPlaces[] = {-3, -1.5, 1.5, 3};
constexpr double kPairPlace = 1.5;
constexpr int kSamples = 4;

// Of the keys of a page (`PageModes`).
Shape ShapeOfKeys(const PageModes& page, const Eigen::VectorXd& coordinates) {
  const int count = page.NumModes();
  Shape shape = page.keys[0];
  size_t key = 1;
  for (int k = 0; k < count; ++k) {
    for (size_t j = 0; j < page.places.size(); ++j, ++key) {
      double weight = coordinates(k) / page.places[j];
      for (size_t i = 0; i < page.places.size(); ++i) {
        if (i != j) {
          weight *= (coordinates(k) - page.places[i]) / (page.places[j] - page.places[i]);
        }
      }
      shape += weight * (page.keys[key] - page.keys[0]);
    }
  }
  for (int k = 0; k < count; ++k) {
    for (int l = k + 1; l < count; ++l, ++key) {
      shape += coordinates(k) * coordinates(l) / (page.pair_place * page.pair_place) *
               (page.keys[key] - page.keys[0]);
    }
  }
  return shape;
}

// The part of the preview that two modes have only together.
Shape MixedTerm(const ShapeModel& model, int k, int l) {
  Shape term = Shape::Zero(3, model.Modes().mean.cols());
  for (const int a : {-1, 1}) {
    for (const int b : {-1, 1}) {
      Eigen::VectorXd coordinates = Eigen::VectorXd::Zero(l + 1);
      coordinates(k) = a * kPairPlace;
      coordinates(l) = b * kPairPlace;
      term += a * b / 4.0 * model.Preview(coordinates);
    }
  }
  return term;
}

// The mean distance of the page's shapes from exact ones, as a share of the diagonal.
double MeanError(const ShapeModel& model, const PageModes& page, Progress* progress) {
  const Metric& metric = *model.Modes().metric;
  const Shape& mean = page.keys[0];
  const double diagonal = (mean.rowwise().maxCoeff() - mean.rowwise().minCoeff()).norm();
  double sum = 0;
  for (int seed = 1; seed <= kSamples; ++seed) {
    const Eigen::VectorXd coordinates = model.Sample(seed).cwiseMax(-2).cwiseMin(2);
    const Shape exact = model.At(coordinates, progress).shape;
    const Shape shown = ShapeOfKeys(page, coordinates);
    const Shape moved = FitRigidMotion(shown, exact, metric.vertex_area)(shown);
    sum += (moved - exact).colwise().norm().dot(metric.vertex_area) / metric.vertex_area.sum();
  }
  return sum / kSamples / diagonal;
}

}  // namespace

PageModes PageOf(const ShapeModel& model, const std::string& file, const Regression* regression,
                 Progress* progress) {
  const PoseModes& modes = model.Modes();
  if (modes.NumModes() == 0) throw InvalidOptions("modes", "there are none to show");
  PageModes page;
  page.connectivity = modes.metric->connectivity;
  page.places.assign(std::begin(kPlaces), std::end(kPlaces));
  page.pair_place = kPairPlace;
  page.keys.push_back(modes.place(modes.metric->unit * modes.mean));
  for (int k = 0; k < modes.NumModes(); ++k) {
    for (const double place : kPlaces) {
      Eigen::VectorXd coordinates = Eigen::VectorXd::Zero(k + 1);
      coordinates(k) = place;
      page.keys.push_back(model.At(coordinates, progress).shape);
    }
    page.shares.push_back(modes.variances(k) / modes.total_variance);
  }
  for (int k = 0; k < modes.NumModes(); ++k) {
    for (int l = k + 1; l < modes.NumModes(); ++l) {
      page.keys.push_back(page.keys[0] + MixedTerm(model, k, l));
    }
  }
  page.up = UpOf(modes);
  page.error = MeanError(model, page, progress);
  page.names = modes.names;
  page.coordinates = modes.Coordinates();
  if (regression != nullptr) {
    for (size_t s = 0; s < regression->scalars.size(); ++s) {
      page.scalars.push_back(
          {regression->scalars[s], regression->least(s), regression->most(s), regression->mean(s)});
    }
    page.intercept = regression->intercept;
    page.slopes = regression->slopes;
  }
  const std::string name = std::filesystem::u8path(file).filename().u8string();
  page.name = name.empty() ? "modes" : name;
  page.file = file.empty() ? "MODES_FILE" : file;
  page.vertex_colours = modes.appearance.vertex_colours;
  return page;
}

}  // namespace shapespace
