#include <shapespace/exploration/detail/pair_solver.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <new>
#include <optional>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/task_group.h>
#include <shapespace/exploration/detail/digest.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/path/energy.h>
#include <shapespace/path/internal/array_file.h>

namespace shapespace::internal {
namespace {

constexpr ArrayFileKind kKind = {"SHAPPAIR", 1, ".geodesic"};

// Digest of everything that a geodesic depends on except its two shapes.
std::string DigestOf(const Metric& frozen, const std::vector<Shape>& poses,
                     const GeodesicOptions& options) {
  Hasher hasher;
  hasher.Add(kResultsVersion);
  AddOptions(options, &hasher);
  for (const auto& feature : frozen.features) {
    hasher.Add(feature->Name().data(), feature->Name().size());
    hasher.Add(feature->Element(0), feature->NumElements() * feature->VerticesPerElement());
    hasher.AddAll(feature->Weights());
    hasher.Add(feature->Numbers(0), feature->NumElements() * feature->NumbersPerElement());
    for (const auto& constant : feature->Constants()) hasher.Add(constant.second);
  }
  hasher.AddAll(frozen.connectivity->Triangles());
  hasher.AddAll(frozen.connectivity->Edges());
  for (const Shape& pose : poses) hasher.AddAll(pose);
  return hasher.Digest();
}

std::string DigestOf(const Shape& shape) {
  Hasher hasher;
  hasher.AddAll(shape);
  return hasher.Digest();
}

double Length(const Metric& metric, const std::vector<Shape>& shapes) {
  double sum = 0;
  for (const double chord : ChordLengths(metric, shapes)) sum += chord;
  return std::sqrt(0.5) * sum;
}

std::string Pack(const std::string& digest, const PairResult& result) {
  HeaderJson header = {{"digest", digest}, {"converged", result.converged}};
  ArrayWriter arrays;
  arrays.Add("lengths", Eigen::Vector2d(result.length, result.blend_length));
  arrays.Add("shape", result.shape);
  return PackArrayFile(kKind, std::move(header), arrays);
}

// Of the shape that is requested.
Eigen::Index VerticesOf(const Pair& pair) { return pair.t >= 0 ? pair.from->cols() : 0; }

// Empty if the bytes are not a complete record with this digest and a shape of so many vertices.
std::optional<PairResult> Unpack(const std::string& digest, Eigen::Index vertices,
                                 const std::string& bytes) {
  try {
    size_t begin;
    const HeaderJson header = UnpackHeader(kKind, bytes, &begin);
    if (header.at("digest") != digest) return {};
    const ArrayReader arrays(header.at("arrays"), bytes, begin);
    const auto lengths = arrays.Get<Eigen::Vector2d>("lengths", 2, 1);
    if (lengths.minCoeff() < 0) return {};
    return PairResult{lengths(0), lengths(1), header.at("converged").get<bool>(),
                      arrays.Get<Shape>("shape", 3, vertices)};
  } catch (const std::bad_alloc&) {
    throw;  // the record may be good
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace

PairSolver::PairSolver(const std::shared_ptr<const Connectivity>& connectivity,
                       const std::vector<Shape>& poses, const GeodesicOptions& options,
                       ProcessPool* crew, const std::string& records)
    : interpolator_(connectivity, poses, options),
      crew_(*crew),
      records_(records),
      digest_(DigestOf(*GetMetric(), poses, options)) {}

std::vector<std::string> PairSolver::Digests(const std::vector<Pair>& pairs) const {
  std::map<const Shape*, std::string> of_shape;  // a shape belongs to many pairs
  for (const Pair& pair : pairs) {
    for (const Shape* shape : {pair.from, pair.to}) {
      std::string& digest = of_shape[shape];
      if (digest.empty()) digest = DigestOf(*shape);
    }
  }
  std::vector<std::string> digests;
  for (const Pair& pair : pairs) {
    Hasher hasher;
    hasher.AddAll(digest_);
    hasher.AddAll(of_shape[pair.from]);
    hasher.AddAll(of_shape[pair.to]);
    hasher.Add(pair.t);
    digests.push_back(hasher.Digest());
  }
  return digests;
}

std::vector<PairResult> PairSolver::Solve(const std::vector<Pair>& pairs, const std::string& stage,
                                          Progress* progress) {
  // The first process reads the records, so that all processes have the same.
  const std::vector<std::string> digests = Digests(pairs);
  std::vector<std::string> records;
  std::vector<int> missing;
  for (size_t i = 0; i < pairs.size(); ++i) {
    std::string record;
    if (crew_.Rank() == 0) {
      record = records_.Find(digests[i]).value_or("");
      if (!record.empty() && !Unpack(digests[i], VerticesOf(pairs[i]), record)) {
        ++counts_.damaged;
        record.clear();
      }
    }
    records.push_back(crew_.FromFirst(record));
    if (records[i].empty()) missing.push_back(static_cast<int>(i));
  }
  const int total = static_cast<int>(missing.size());
  counts_.found += static_cast<int>(pairs.size()) - total;
  counts_.solved += total;
  TaskGroup group(progress, stage, total);
  std::vector<std::string> solved;
  group.Guard([&] {
    solved = crew_.ForEach(total, interpolator_.MostAtOnce(), [&](int i) {
      std::string bytes;
      group.Run(i, [&](Progress* one) {
        bytes = Pack(digests[missing[i]], SolveOne(pairs[missing[i]], one));
        records_.Keep(digests[missing[i]], bytes);
      });
      return bytes;
    });
  });
  for (int i = 0; i < total; ++i) records[missing[i]] = std::move(solved[i]);

  std::vector<PairResult> results;
  for (size_t i = 0; i < pairs.size(); ++i) {
    auto result = Unpack(digests[i], VerticesOf(pairs[i]), records[i]);
    if (!result) throw SolverError("the result of another process is damaged");
    if (!result->converged) ++counts_.not_converged;
    results.push_back(*std::move(result));
    records[i].clear();
  }
  return results;
}

PairResult PairSolver::SolveOne(const Pair& pair, Progress* progress) const {
  const Metric& metric = *GetMetric();
  const GeodesicResult found =
      interpolator_.Between(metric.unit * *pair.from, metric.unit * *pair.to, progress);
  if (found.summary.termination == Termination::kCancelled) throw Cancelled();
  PairResult result;
  result.length = Length(metric, found.path.shapes);
  result.blend_length =
      Length(metric, Resample({*pair.from, *pair.to}, {0, 1}, found.path.parameters));
  result.converged = found.path.converged;
  result.shape.resize(3, 0);
  if (pair.t >= 0) {
    const Shape shape = Resample(found.path.shapes, found.path.parameters, {pair.t}).front();
    const Shape blend = (1 - pair.t) * *pair.from + pair.t * *pair.to;
    result.shape = FitRigidMotion(shape, blend, metric.vertex_area)(shape);
    metric.connectivity->CopyToTwins(&result.shape);
  }
  return result;
}

}  // namespace shapespace::internal
