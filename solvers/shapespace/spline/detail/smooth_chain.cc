#include <shapespace/spline/detail/smooth_chain.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/LU>

#include <shapespace/base/internal/ranges.h>
#include <shapespace/contact/internal/avoid_contact.h>
#include <shapespace/contact/obstacle.h>
#include <shapespace/mesh/internal/triangle_deformation.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/sparse/internal/gradient_integrator.h>
#include <shapespace/spline/detail/corrections.h>

namespace shapespace::internal {
namespace {

// Sides of triangles whose area is less than this share of their longest side's square, in any
// shape, follow their ends instead of a rotation and a stretch.
constexpr double kThin = 1e-6;

// How far a quantity goes in an interval, and how fast at its ends, from its `segments` steps.
class VertexCurve {
 public:
  explicit VertexCurve(int segments) : segments_(segments) {}

  void Add(const Eigen::Vector3d& step) {
    way_ += step;
    if (count_ == 0) first_ = 1.5 * step;
    if (count_ == 1) first_ -= 0.5 * step;
    if (count_ == segments_ - 2) last_ = -0.5 * step;
    if (count_ == segments_ - 1) last_ += 1.5 * step;
    ++count_;
  }

  void Write(Eigen::Index column, Interval* interval) const {
    interval->way.col(column) = way_;
    interval->first_velocity.col(column) = segments_ * first_;
    interval->last_velocity.col(column) = segments_ * last_;
  }

 private:
  const int segments_;
  int count_ = 0;
  Eigen::Vector3d way_ = Eigen::Vector3d::Zero(), first_ = way_, last_ = way_;
};

// The quantities that are corrected, a column each: rotations of triangles, logarithms of their
// stretches, positions of vertices, and the rigid motion's rotation and translation.
class Smoother {
 public:
  Smoother(const SplineOptions& options, const std::vector<double>& times, const Path& path)
      : path_(path),
        triangles_(path.metric->connectivity->Triangles()),
        num_triangles_(static_cast<int>(triangles_.cols())),
        num_vertices_(path.metric->connectivity->NumVertices()),
        mean_edges_(MakeMeanEdges(options.ends == SplineEnds::kPeriodic)),
        reference_(num_triangles_, Eigen::Matrix2d::Zero()),
        integrator_(*path.metric->connectivity, WeightsOfSides()),
        corrections_(MakeCorrections(options, times)) {}

  // Shape `k` of the path, at `s` of an interval, corrected.
  Shape ShapeAt(int k, int interval, double s, RigidMotion* motion) const {
    const Shape& chain = path_.shapes[k];
    const Eigen::Matrix3Xd change = corrections_.At(interval, s);
    const Shape places = chain + change.middleCols(FirstPlace(), num_vertices_);
    const auto gradient = [&](int f) { return Turn(chain, f, change); };
    const auto sides = [&](int f) -> Eigen::Matrix3d {
      return gradient(f) * TriangleSides(IsThin(f) ? places : chain, triangles_.col(f));
    };
    Shape shape = integrator_.Integrate(chain, places, sides, gradient);
    shape.colwise() -= Centroid(shape, path_.metric->vertex_area);
    motion->rotation = path_.motions[k].rotation * Exp(Eigen::Vector3d(change.col(FirstMotion())));
    motion->translation = path_.motions[k].translation + change.col(FirstMotion() + 1);
    return shape;
  }

 private:
  Eigen::Index FirstPlace() const { return 2 * num_triangles_; }
  Eigen::Index FirstMotion() const { return FirstPlace() + num_vertices_; }
  Eigen::Index NumColumns() const { return FirstMotion() + 2; }

  TriangleFrame FrameOf(const Shape& shape, int f) const {
    return {shape.col(triangles_(0, f)), shape.col(triangles_(1, f)), shape.col(triangles_(2, f))};
  }
  TriangleDeformation PoseOf(const Shape& shape, int f) const {
    return {FrameOf(shape, f), reference_[f]};
  }
  // Thin triangles have no reference.
  bool IsThin(int f) const { return reference_[f](0, 0) == 0; }

  // What turns and stretches the chain's triangle into the spline's; nothing does if it is thin.
  Eigen::Matrix3d Turn(const Shape& chain, int f, const Eigen::Matrix3Xd& change) const {
    if (IsThin(f)) return Eigen::Matrix3d::Identity();
    const TriangleDeformation pose = PoseOf(chain, f);
    const SymmetricMatrix2 log = Log(pose.stretch);
    const SymmetricMatrix2 more = SymmetricMatrix2::FromVector(change.col(num_triangles_ + f));
    const SymmetricMatrix2 stretch =
        Exp(SymmetricMatrix2{log.xx + more.xx, log.xy + more.xy, log.yy + more.yy});
    Eigen::Matrix3d stretches = Eigen::Matrix3d::Identity();
    stretches.topLeftCorner<2, 2>() = stretch.Matrix() * pose.stretch.Matrix().inverse();
    const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
    return rotation * Exp(Eigen::Vector3d(change.col(f))) * stretches * rotation.transpose();
  }

  // The edges of each triangle of which the inner products are the mean of those in all poses. A
  // periodic chain ends in its first pose, which counts once. With one of the poses instead, the
  // motion would depend on which of them is first.
  std::vector<Eigen::Matrix2d> MakeMeanEdges(bool is_periodic) const {
    std::vector<Eigen::Matrix2d> mean(num_triangles_);
    const size_t poses = path_.poses.size() - (is_periodic ? 1 : 0);
    ForIndices(num_triangles_, [&](int f) {
      Eigen::Matrix2d products = Eigen::Matrix2d::Zero();
      for (size_t i = 0; i < poses; ++i) {
        const Eigen::Matrix2d edges = FrameOf(path_.shapes[path_.poses[i]], f).edges;
        products += edges.transpose() * edges / static_cast<double>(poses);
      }
      const double first = std::sqrt(products(0, 0));
      const double along = first > 0 ? products(0, 1) / first : 0;
      mean[f] << first, along, 0, std::sqrt(std::max(0.0, products(1, 1) - along * along));
    });
    return mean;
  }

  Eigen::Matrix3Xd WeightsOfSides() const {
    Eigen::Matrix3Xd weights(3, num_triangles_);
    for (int f = 0; f < num_triangles_; ++f) {
      const Eigen::Matrix2d& edges = mean_edges_[f];
      const double area = 0.5 * edges.determinant();
      const Eigen::Vector2d sides[] = {edges.col(0), edges.col(1) - edges.col(0), edges.col(1)};
      for (int k = 0; k < 3; ++k) weights(k, f) = area > 0 ? area / sides[k].squaredNorm() : 0;
    }
    return weights;
  }

  void SetReference(int f) {
    for (const Shape& shape : path_.shapes) {
      const Eigen::Matrix2d edges = FrameOf(shape, f).edges;
      const double longest = std::max(edges.col(0).squaredNorm(), edges.col(1).squaredNorm());
      if (!(edges.determinant() > kThin * longest)) return;
    }
    reference_[f] = mean_edges_[f].inverse();
  }

  Corrections MakeCorrections(const SplineOptions& options, const std::vector<double>& times) {
    std::vector<Interval> intervals(times.size() - 1);
    for (size_t i = 0; i < intervals.size(); ++i) {
      intervals[i].length = times[i + 1] - times[i];
      intervals[i].way.setZero(3, NumColumns());
      intervals[i].first_velocity = intervals[i].last_velocity = intervals[i].way;
    }
    ForIndices(num_triangles_, [&](int f) {
      SetReference(f);
      if (!IsThin(f)) FollowTriangle(f, &intervals);
    });
    ForIndices(num_vertices_, [&](int v) {
      Follow(FirstPlace() + v, &intervals, [&](int k) -> Eigen::Vector3d {
        return path_.shapes[k + 1].col(v) - path_.shapes[k].col(v);
      });
    });
    Follow(FirstMotion(), &intervals, [&](int k) {
      return Log(Eigen::Quaterniond(
          Eigen::Matrix3d(path_.motions[k].rotation.transpose() * path_.motions[k + 1].rotation)));
    });
    Follow(FirstMotion() + 1, &intervals, [&](int k) -> Eigen::Vector3d {
      return path_.motions[k + 1].translation - path_.motions[k].translation;
    });
    Eigen::Matrix3Xd first = Eigen::Matrix3Xd::Zero(3, NumColumns()), last = first;
    if (options.ends == SplineEnds::kClamped) {
      const double length =
          options.times.empty() ? times.size() - 1.0 : options.times.back() - options.times.front();
      first = length * ColumnVelocities(0, options.first_velocity);
      last = length * ColumnVelocities(path_.NumShapes() - 1, options.last_velocity);
    }
    return {std::move(intervals), options.ends, options.hold_limit, first, last};
  }

  // Follows the quantity of a column, whose step from shape k to the next is step(k).
  template <typename Step>
  void Follow(Eigen::Index column, std::vector<Interval>* intervals, const Step& step) const {
    for (size_t i = 0; i < intervals->size(); ++i) {
      VertexCurve curve(path_.poses[i + 1] - path_.poses[i]);
      for (int k = path_.poses[i]; k < path_.poses[i + 1]; ++k) curve.Add(step(k));
      curve.Write(column, &(*intervals)[i]);
    }
  }

  void FollowTriangle(int f, std::vector<Interval>* intervals) const {
    TriangleDeformation pose = PoseOf(path_.shapes.front(), f);
    for (size_t i = 0; i < intervals->size(); ++i) {
      const int segments = path_.poses[i + 1] - path_.poses[i];
      VertexCurve turn(segments), stretch(segments);
      for (int k = path_.poses[i]; k < path_.poses[i + 1]; ++k) {
        const TriangleDeformation next = PoseOf(path_.shapes[k + 1], f);
        turn.Add(Log(pose.rotation.conjugate() * next.rotation));
        stretch.Add(Log(next.stretch).Vector() - Log(pose.stretch).Vector());
        pose = next;
      }
      turn.Write(f, &(*intervals)[i]);
      stretch.Write(num_triangles_ + f, &(*intervals)[i]);
    }
  }

  // The velocities of all columns that belong to a velocity of the vertices at shape k, in the
  // user's frame and unit, by central differences.
  Eigen::Matrix3Xd ColumnVelocities(int k, const Tangent& velocity) const {
    const Eigen::Vector3d translation = Centroid(velocity, path_.metric->vertex_area);
    const Tangent own = path_.motions[k].rotation.transpose() *
                        (velocity.colwise() - translation).eval() / path_.metric->unit;
    Eigen::Matrix3Xd columns = Eigen::Matrix3Xd::Zero(3, NumColumns());
    columns.middleCols(FirstPlace(), num_vertices_) = own;
    columns.col(FirstMotion() + 1) = translation;
    const double largest = own.cwiseAbs().maxCoeff();
    if (largest == 0) return columns;
    const double step = 1e-5 / largest;
    const Shape before = path_.shapes[k] - step * own, after = path_.shapes[k] + step * own;
    for (int f = 0; f < num_triangles_; ++f) {
      if (IsThin(f)) continue;
      const TriangleDeformation a = PoseOf(before, f), b = PoseOf(after, f);
      columns.col(f) = Log(a.rotation.conjugate() * b.rotation) / (2 * step);
      columns.col(num_triangles_ + f) =
          (Log(b.stretch).Vector() - Log(a.stretch).Vector()) / (2 * step);
    }
    return columns;
  }

  const Path& path_;
  const Eigen::Matrix3Xi& triangles_;
  const int num_triangles_, num_vertices_;
  const std::vector<Eigen::Matrix2d> mean_edges_;
  std::vector<Eigen::Matrix2d> reference_;  // their inverses
  const SurfaceIntegrator integrator_;
  const Corrections corrections_;
};

// The contact between each two poses of a chain, whose shapes are `shapes`.
class ChainContact {
 public:
  ChainContact(const Path& chain, const std::vector<Shape>& shapes, const Obstacle* obstacle)
      : poses_(chain.poses) {
    for (size_t i = 0; i + 1 < poses_.size(); ++i) {
      models_.emplace_back(chain.metric,
                           std::vector<Shape>{shapes[poses_[i]], shapes[poses_[i + 1]]},
                           ContactModel::Intersections::kExempt, obstacle);
    }
  }

  int NumIntervals() const { return static_cast<int>(models_.size()); }

  // The number of segments of an interval during which something touches.
  int Touching(const std::vector<Shape>& shapes, int interval) const {
    return static_cast<int>(SegmentsWithContact(models_[interval], Part(shapes, interval)).size());
  }

  // In the user's unit; NaN if no parts come near each other.
  double Distance(const std::vector<Shape>& shapes) const {
    double least = std::numeric_limits<double>::quiet_NaN();
    for (int i = 0; i < NumIntervals(); ++i) {
      least = std::fmin(least, LeastDistance(models_[i], Part(shapes, i)));
    }
    return least;
  }

  // Replaces the smoothed shapes of an interval in which the chain has no contact.
  void Relax(const std::vector<Shape>& chain, int interval, const MinimiseOptions& options,
             std::vector<Shape>* smoothed) const {
    std::vector<Shape> shapes = Part(chain, interval);
    KeepIncrements(models_[interval], Part(*smoothed, interval), options, &shapes);
    std::move(shapes.begin() + 1, shapes.end() - 1, smoothed->begin() + poses_[interval] + 1);
  }

 private:
  std::vector<Shape> Part(const std::vector<Shape>& shapes, int interval) const {
    return {shapes.begin() + poses_[interval], shapes.begin() + poses_[interval + 1] + 1};
  }

  const std::vector<int> poses_;
  std::vector<ContactModel> models_;
};

// The inner shapes of a chain, smoothed, with the motions that place them.
struct Smoothed {
  std::vector<Shape> shapes;
  std::vector<RigidMotion> motions;
};

// Turns of the shapes of a chain that ends where it begins. Each shape is aligned with the one
// before, so that the last one is the first one turned; with these turns they are the same, and the
// velocity can be continuous there. They have a constant speed, wherever the chain begins.
std::vector<Eigen::Matrix3d> ClosingTurns(const Path& chain) {
  const Eigen::AngleAxisd amiss(
      Eigen::Matrix3d(chain.motions.front().rotation.transpose() * chain.motions.back().rotation));
  std::vector<Eigen::Matrix3d> turns;
  for (const double time : chain.parameters) {
    turns.emplace_back(Eigen::AngleAxisd(time * amiss.angle(), amiss.axis()));
  }
  return turns;
}

// Turns shapes and leaves them in their places.
void TurnShapes(const std::vector<Eigen::Matrix3d>& turns, std::vector<Shape>* shapes,
                std::vector<RigidMotion>* motions) {
  for (size_t k = 0; k < turns.size(); ++k) {
    (*shapes)[k] = turns[k] * (*shapes)[k];
    (*motions)[k].rotation *= turns[k].transpose();
  }
}

Smoothed Smooth(const Smoother& smoother, const Path& chain, Progress* progress) {
  Smoothed smoothed = {chain.shapes, chain.motions};
  for (size_t i = 0; i + 1 < chain.poses.size(); ++i) {
    const int begin = chain.poses[i], end = chain.poses[i + 1];
    for (int k = begin + 1; k < end; ++k) {
      ReportProgress(progress, "smoothing", k, chain.NumShapes());
      const double s = static_cast<double>(k - begin) / (end - begin);
      smoothed.shapes[k] = smoother.ShapeAt(k, static_cast<int>(i), s, &smoothed.motions[k]);
    }
  }
  return smoothed;
}

// Where shapes and an obstacle are compared: where the shapes are placed, in the metric's unit and
// from where the first one is; without an obstacle, the frame of the path.
class ComparisonFrame {
 public:
  ComparisonFrame(const Path& chain, const std::optional<Obstacle>& obstacle)
      : unit_(chain.metric->unit), weights_(chain.metric->vertex_area), obstacle_(obstacle) {
    if (!obstacle_) return;
    origin_ = chain.motions.front().translation;
    obstacle_ = InFrame(*obstacle_, origin_, unit_);
  }

  const Obstacle* GetObstacle() const { return obstacle_ ? &*obstacle_ : nullptr; }

  std::vector<Shape> Place(const std::vector<Shape>& shapes,
                           const std::vector<RigidMotion>& motions) const {
    std::vector<Shape> placed = shapes;
    for (size_t k = 0; obstacle_ && k < placed.size(); ++k) {
      placed[k] = (motions[k](unit_ * shapes[k]).colwise() - origin_) / unit_;
    }
    return placed;
  }

  // Replaces a shape, and its motion if there is an obstacle, by those of a placed one.
  void TakeBack(const Shape& placed, Shape* shape, RigidMotion* motion) const {
    const RigidMotion back = FitRigidMotion(placed, *shape, weights_);
    *shape = back(placed);
    if (!obstacle_) return;
    motion->rotation = back.rotation.transpose();
    motion->translation = origin_ - unit_ * (motion->rotation * back.translation);
  }

 private:
  const double unit_;
  const Eigen::VectorXd& weights_;
  std::optional<Obstacle> obstacle_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
};

// Leads a smoothed chain round its contacts, from the chain without contact.
SmoothContact SmoothPastContact(const SplineOptions& options, const Path& chain, Progress* progress,
                                Smoothed* smoothed) {
  const ComparisonFrame scene(chain, options.geodesic.obstacle);
  const std::vector<Shape> cornered = scene.Place(chain.shapes, chain.motions);
  std::vector<Shape> shapes = scene.Place(smoothed->shapes, smoothed->motions);
  const ChainContact contact(chain, cornered, scene.GetObstacle());
  SmoothContact result;
  result.uncertified_segments = 0;
  MinimiseOptions minimise;
  minimise.tolerance = options.geodesic.tolerance;
  minimise.max_iterations = options.geodesic.max_iterations;
  minimise.keep_going = [&](int, double) {
    ReportProgress(progress, "smoothing past contacts", 0, 0);
    return true;
  };
  for (int i = 0; i < contact.NumIntervals(); ++i) {
    int touching = contact.Touching(shapes, i);
    // Where the chain has contact itself, so has the smooth path.
    if (touching > 0 && contact.Touching(cornered, i) == 0) {
      contact.Relax(cornered, i, minimise, &shapes);
      for (int k = chain.poses[i] + 1; k < chain.poses[i + 1]; ++k) {
        scene.TakeBack(shapes[k], &smoothed->shapes[k], &smoothed->motions[k]);
      }
      touching = contact.Touching(shapes, i);
    }
    result.uncertified_segments += touching;
  }
  result.contact_distance = contact.Distance(shapes);
  return result;
}

}  // namespace

SmoothContact SmoothChain(const SplineOptions& options, const std::vector<double>& times,
                          Progress* progress, Path* path) {
  Smoothed smoothed;
  if (options.ends == SplineEnds::kPeriodic) {
    std::vector<Eigen::Matrix3d> turns = ClosingTurns(*path);
    Path turned = *path;
    TurnShapes(turns, &turned.shapes, &turned.motions);
    smoothed = Smooth(Smoother(options, times, turned), turned, progress);
    for (Eigen::Matrix3d& turn : turns) turn.transposeInPlace();
    TurnShapes(turns, &smoothed.shapes, &smoothed.motions);
    for (const int pose : path->poses) {  // without the rounding of both turns
      smoothed.shapes[pose] = path->shapes[pose];
      smoothed.motions[pose] = path->motions[pose];
    }
  } else {
    smoothed = Smooth(Smoother(options, times, *path), *path, progress);
  }
  SmoothContact contact;
  if (options.geodesic.avoid_contact) {
    contact = SmoothPastContact(options, *path, progress, &smoothed);
  }
  path->shapes = std::move(smoothed.shapes);
  path->motions = std::move(smoothed.motions);
  return contact;
}

}  // namespace shapespace::internal
