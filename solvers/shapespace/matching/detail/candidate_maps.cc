#include <shapespace/matching/detail/candidate_maps.h>

#include <algorithm>
#include <utility>

#include <Eigen/Eigenvalues>

#include <shapespace/base/parallel.h>
#include <shapespace/matching/detail/nearest_columns.h>
#include <shapespace/mesh/surface.h>

namespace shapespace::internal {
namespace {

// Vertices that determine a map, of MatchingBody::spread.
constexpr int kMapSamples = 400;
// Numbers of functions. From 10 on instead of 16, ZoomOut loses what is front and back; beyond 60
// it gains nothing that a fit does not.
const std::vector<int> kCoarse = {16, 22, 28, 34, 40}, kFine = {45, 50, 55, 60};
// Weight of normals beside positions, whose unit is the root of the area: they tell the two sides
// of a leaf apart.
constexpr float kNormalWeight = 0.2F;
// Maps are the same if they send fewer than this share of the samples to places farther apart than
// this. The lower halves of two legs that are exchanged are a twentieth of an animal.
constexpr float kElsewhere = 0.15F, kSameShare = 0.03F;

// Those of the counts that both bodies have; at least one.
std::vector<int> Possible(const std::vector<int>& counts, const MatchingBody& a,
                          const MatchingBody& b) {
  const int most = std::min(a.spectrum.Count(), b.spectrum.Count());
  std::vector<int> possible;
  for (const int count : counts) possible.push_back(std::min(count, most));
  possible.erase(std::unique(possible.begin(), possible.end()), possible.end());
  return possible;
}

std::vector<int> AllCounts(std::vector<int> first, const std::vector<int>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

// The map by nearest descriptors, which are columns.
SpectralMap NearestStart(const Eigen::MatrixXf& a, const Eigen::MatrixXf& b) {
  SpectralMap map;
  map.to_target = NearestColumns(a.leftCols(std::min<Eigen::Index>(kMapSamples, a.cols())), b);
  map.to_template = NearestColumns(b.leftCols(std::min<Eigen::Index>(kMapSamples, b.cols())), a);
  return map;
}

// The 24 rotations that make a cube of a cube.
std::vector<Eigen::Matrix3f> TurnsOfACube() {
  std::vector<Eigen::Matrix3f> turns;
  for (int x = 0; x < 6; ++x) {
    for (int y = 0; y < 6; ++y) {
      if (x / 2 == y / 2) continue;
      const auto axis = [](int i) -> Eigen::Vector3f {
        return (i % 2 == 0 ? 1.0F : -1.0F) * Eigen::Vector3f::Unit(i / 2);
      };
      Eigen::Matrix3f turn;
      turn << axis(x), axis(y), axis(x).cross(axis(y));
      turns.push_back(turn);
    }
  }
  return turns;
}

// Positions and normals of the spread vertices relative to the body's principal axes.
Eigen::MatrixXf AlongAxes(const MatchingBody& body) {
  const Shape& shape = body.surface.shape;
  const Eigen::VectorXd& areas = body.laplacian.areas;
  const Shape centred = shape.colwise() - Eigen::Vector3d(shape * areas / areas.sum());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(centred * areas.asDiagonal() *
                                                            centred.transpose());
  Eigen::Matrix3d frame = axes.eigenvectors().transpose();
  frame.row(2) *= frame.determinant();
  const Shape normals = VertexNormals(*body.surface.connectivity, shape);
  Eigen::MatrixXf along(6, body.spread.size());
  for (size_t i = 0; i < body.spread.size(); ++i) {
    along.col(i).head(3) = (frame * centred.col(body.spread[i])).cast<float>();
    along.col(i).tail(3) = kNormalWeight * (frame * normals.col(body.spread[i])).cast<float>();
  }
  return along;
}

// Distances of images of samples, which are on `body`, from its even samples, a column for each.
Eigen::MatrixXf ImageDistances(const MatchingBody& body, const std::vector<int>& images) {
  Eigen::MatrixXf distances(body.even.distances.cols(), images.size());
  for (size_t i = 0; i < images.size(); ++i) {
    distances.col(i) = body.even.distances.row(body.spread[images[i]]).transpose();
  }
  return distances;
}
void ZoomOutAll(const SpectralPoints& on_template, const SpectralPoints& on_target,
                const std::vector<int>& counts, std::vector<CandidateMap>* maps) {
  ParallelFor(static_cast<int>(maps->size()), [&](int i) {
    for (const int count : counts) ZoomOut(on_template, on_target, count, &(*maps)[i].map);
  });
}

}  // namespace

std::pair<Eigen::MatrixXf, Eigen::MatrixXf> DescribeBoth(const Landmarks& template_landmarks,
                                                         int template_extremities,
                                                         const Landmarks& target_landmarks,
                                                         int target_extremities,
                                                         const Assignment& assignment) {
  std::vector<int> first, second;
  for (const auto& [a, b] : assignment.pairs) {
    first.push_back(a);
    second.push_back(b);
  }
  const int known = static_cast<int>(template_landmarks.Vertices().size()) - template_extremities;
  for (int k = 0; k < known; ++k) {
    first.push_back(template_extremities + k);
    second.push_back(target_extremities + k);
  }
  return {template_landmarks.Describe(first), target_landmarks.Describe(second)};
}

void RemoveRepeated(const MatchingBody& body, std::vector<int> SpectralMap::*direction,
                    std::vector<CandidateMap>* maps) {
  std::vector<Eigen::MatrixXf> images;
  std::vector<CandidateMap> different;
  for (CandidateMap& candidate : *maps) {
    Eigen::MatrixXf own = ImageDistances(body, candidate.map.*direction);
    const bool repeated = std::any_of(images.begin(), images.end(), [&](const auto& earlier) {
      const auto elsewhere =
          ((earlier - own).cwiseAbs().colwise().maxCoeff().array() > kElsewhere).count();
      return static_cast<float>(elsewhere) < kSameShare * static_cast<float>(own.cols());
    });
    if (repeated) continue;
    images.push_back(std::move(own));
    different.push_back(std::move(candidate));
  }
  *maps = std::move(different);
}

std::vector<CandidateMap> StartAtLandmarks(const MatchingBody& on_template,
                                           const MatchingBody& on_target,
                                           const Landmarks& template_landmarks,
                                           const Landmarks& target_landmarks,
                                           const std::vector<Assignment>& assignments) {
  std::vector<CandidateMap> maps(assignments.size());
  ParallelFor(static_cast<int>(maps.size()), [&](int i) {
    maps[i].assignment = assignments[i];
    const auto [a, b] = DescribeBoth(
        template_landmarks, static_cast<int>(on_template.all_extremities.size()), target_landmarks,
        static_cast<int>(on_target.all_extremities.size()), assignments[i]);
    maps[i].map = NearestStart(a, b);
  });
  return maps;
}

std::vector<CandidateMap> StartAtAxes(const MatchingBody& on_template,
                                      const MatchingBody& on_target) {
  const Eigen::MatrixXf first = AlongAxes(on_template), second = AlongAxes(on_target);
  const std::vector<Eigen::Matrix3f> turns = TurnsOfACube();
  std::vector<CandidateMap> maps(turns.size());
  ParallelFor(static_cast<int>(maps.size()), [&](int i) {
    Eigen::MatrixXf turned(6, first.cols());
    turned.topRows(3) = turns[i] * first.topRows(3);
    turned.bottomRows(3) = turns[i] * first.bottomRows(3);
    maps[i].map = NearestStart(turned, second);
  });
  return maps;
}

std::vector<CandidateMap> MakeMaps(const MatchingBody& on_template, const MatchingBody& on_target,
                                   std::vector<CandidateMap> maps, Progress* progress) {
  const std::vector<int> coarse = Possible(kCoarse, on_template, on_target);
  const std::vector<int> fine = Possible(kFine, on_template, on_target);
  const SpectralPoints first(on_template.spectrum, on_template.spread, kMapSamples,
                             AllCounts(coarse, fine));
  const SpectralPoints second(on_target.spectrum, on_target.spread, kMapSamples,
                              AllCounts(coarse, fine));
  ReportProgress(progress, "maps", 0, static_cast<int>(maps.size()));
  ZoomOutAll(first, second, coarse, &maps);
  RemoveRepeated(on_target, &SpectralMap::to_target, &maps);
  ReportProgress(progress, "finer maps", 0, static_cast<int>(maps.size()));
  ZoomOutAll(first, second, fine, &maps);
  RemoveRepeated(on_target, &SpectralMap::to_target, &maps);
  return maps;
}

}  // namespace shapespace::internal
