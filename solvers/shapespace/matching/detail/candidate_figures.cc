#include <shapespace/matching/detail/candidate_figures.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <shapespace/base/internal/sort_unique.h>
#include <shapespace/base/parallel.h>
#include <shapespace/matching/detail/compare_bodies.h>
#include <shapespace/matching/detail/nearest_columns.h>
#include <shapespace/matching/detail/turns.h>

namespace shapespace::internal {
namespace {

// Samples from which distances are compared, and those to which.
constexpr size_t kFrom = 60, kTo = 300;
// Eigenfunctions after the constant one by which orientation is judged.
constexpr int kOriented = 8;

float Correlation(const Eigen::ArrayXf& x, const Eigen::ArrayXf& y) {
  const Eigen::ArrayXf a = x - x.mean(), b = y - y.mean();
  const float squares = a.square().sum() * b.square().sum();
  return squares > 0 ? (a * b).sum() / std::sqrt(squares) : 0;
}

// The correlation of the curvature at some vertices with that at their images.
float CurvatureAt(const Eigen::VectorXf& from, const std::vector<int>& vertices,
                  const Eigen::VectorXf& to, const std::vector<int>& images) {
  Eigen::ArrayXf here(vertices.size()), there(vertices.size());
  for (size_t i = 0; i < vertices.size(); ++i) {
    here(i) = from(vertices[i]);
    there(i) = to(images[vertices[i]]);
  }
  return Correlation(here, there);
}

std::vector<int> AllOf(const std::vector<int>& images) {
  std::vector<int> all(images.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

// Some rows of a matrix.
Eigen::MatrixXf Rows(const Eigen::MatrixXf& matrix, const std::vector<int>& rows) {
  Eigen::MatrixXf chosen(rows.size(), matrix.cols());
  for (size_t i = 0; i < rows.size(); ++i) chosen.row(i) = matrix.row(rows[i]);
  return chosen;
}

std::vector<int> FirstOf(const std::vector<int>& items, size_t count) {
  return {items.begin(),
          items.begin() + static_cast<std::ptrdiff_t>(std::min(count, items.size()))};
}

// The first vertices to which any of the maps sends samples, in ascending order.
std::vector<int> AllImages(const std::vector<SpectralMap>& maps,
                           std::vector<int> SpectralMap::*direction) {
  std::vector<int> images;
  for (const SpectralMap& map : maps) {
    const std::vector<int> own = FirstOf(map.*direction, kFrom);
    images.insert(images.end(), own.begin(), own.end());
  }
  SortUnique(&images);
  return images;
}

// For each map, the mean relative change of the distances `before` when samples are sent to the
// body `to`.
std::vector<double> Changes(const Eigen::MatrixXf& before, const MatchingBody& to,
                            const std::vector<SpectralMap>& maps,
                            std::vector<int> SpectralMap::*direction) {
  const std::vector<int> images = AllImages(maps, direction);
  // A row for each vertex of to.spread, a column for each image.
  Eigen::MatrixXf after(to.spread.size(), images.size());
  ParallelFor(static_cast<int>(images.size()), [&](int k) {
    const Eigen::VectorXf distances = to.graph.From(to.spread[images[k]]);
    for (size_t i = 0; i < to.spread.size(); ++i) after(i, k) = distances(to.spread[i]);
  });
  std::vector<double> changes;
  for (const SpectralMap& map : maps) {
    const auto scale = static_cast<float>(map.scale);
    double sum = 0;
    for (Eigen::Index i = 0; i < before.rows(); ++i) {
      const auto column =
          std::lower_bound(images.begin(), images.end(), (map.*direction)[i]) - images.begin();
      for (Eigen::Index k = 0; k < before.cols(); ++k) {
        sum += RelativeChange(scale * before(i, k), after((map.*direction)[k], column));
      }
    }
    changes.push_back(sum / static_cast<double>(before.size()));
  }
  return changes;
}

Eigen::VectorXf CurvatureDensity(const MatchingBody& body) {
  return body.laplacian.areas.cwiseInverse().cwiseProduct(MeanCurvature(body)).cast<float>();
}

}  // namespace

CandidateFigures::Side::Side(const MatchingBody& own)
    : body(own),
      between(Rows(own.graph.FromEach(FirstOf(own.spread, kFrom)), FirstOf(own.spread, kTo))
                  .transpose()),
      curvature(own.Smooth(CurvatureDensity(own), own.spread)),
      functions(own.spectrum.functions.cast<float>()),
      at_spread(Rows(functions, own.spread).transpose()) {
  const int oriented = std::min(kOriented, own.spectrum.Count() - 1);
  turns = Rows(GradientTurns(*own.surface.connectivity, own.laplacian.areas,
                             functions.middleCols(1, oriented), AllPairs(oriented)),
               own.spread);
}

double CandidateFigures::Side::Correlate(const Eigen::MatrixXf& coefficients,
                                         const std::vector<int>& images, const Side& other) const {
  const Eigen::Index count = coefficients.rows();
  const int oriented = std::min(kOriented, static_cast<int>(coefficients.cols()) - 1);
  const Eigen::MatrixXf pulled = functions.leftCols(count) * coefficients.middleCols(1, oriented);
  const Eigen::MatrixXf own =
      GradientTurns(*body.surface.connectivity, body.laplacian.areas, pulled, AllPairs(oriented));
  double product = 0, here = 0, there = 0;
  for (size_t i = 0; i < images.size(); ++i) {
    const auto turn = own.row(body.spread[i]), image = other.turns.row(images[i]);
    product += turn.dot(image);
    here += turn.squaredNorm();
    there += image.squaredNorm();
  }
  return here > 0 && there > 0 ? product / std::sqrt(here * there) : 0;
}

CandidateFigures::CandidateFigures(const MatchingBody& on_template, const MatchingBody& on_target,
                                   Directions directions)
    : template_(on_template), target_(on_target), directions_(directions) {
  for (size_t i = 0; i < on_target.spread.size(); ++i) {
    if (directions == Directions::kBoth || on_target.IsInner(on_target.spread[i])) {
      inner_.push_back(static_cast<int>(i));
    }
  }
}

SpectralMap CandidateFigures::WithAllImages(const SpectralMap& map) const {
  const AlignedPoints points = Align(template_.at_spread, target_.at_spread, map);
  SpectralMap whole = map;
  if (directions_ == Directions::kBoth) {
    whole.to_target = NearestColumns(points.on_template, points.on_target);
  }
  whole.to_template = NearestColumns(points.on_target, points.on_template);
  return whole;
}

double CandidateFigures::Orientation(const SpectralMap& map) const {
  const double back = target_.Correlate(map.from_template, map.to_template, template_);
  if (directions_ == Directions::kToTemplate) return back;
  return 0.5 * (template_.Correlate(map.from_target, map.to_target, target_) + back);
}

double CandidateFigures::Curvature(const SpectralMap& map) const {
  const float back = CurvatureAt(target_.curvature, inner_, template_.curvature, map.to_template);
  if (directions_ == Directions::kToTemplate) return back;
  return 0.5 *
         (CurvatureAt(template_.curvature, AllOf(map.to_target), target_.curvature, map.to_target) +
          back);
}

std::vector<double> CandidateFigures::Isometry(const std::vector<SpectralMap>& maps) const {
  std::vector<double> back =
      Changes(target_.between, template_.body, maps, &SpectralMap::to_template);
  if (directions_ == Directions::kToTemplate) return back;
  std::vector<double> mean =
      Changes(template_.between, target_.body, maps, &SpectralMap::to_target);
  for (size_t i = 0; i < maps.size(); ++i) mean[i] = 0.5 * (mean[i] + back[i]);
  return mean;
}

}  // namespace shapespace::internal
