// Two plates, of which the upper one moves: everything about their contact is known.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/contact/detail/motion_contact.h>
#include <shapespace/contact/detail/separation_potential.h>
#include <shapespace/contact/internal/avoid_contact.h>
#include <shapespace/contact/internal/contact_model.h>
#include <shapespace/contact/internal/follow.h>
#include <shapespace/contact/internal/path_contact.h>
#include <shapespace/contact/obstacle.h>
#include <shapespace/minimise/internal/preconditioner.h>

#include "support/cut_ring.h"
#include "support/message_of.h"
#include "support/paths.h"

namespace shapespace::internal {
namespace {

using shapespace::testing::MessageOf;
using shapespace::testing::Names;
using shapespace::testing::Noise;
using shapespace::testing::Refuses;

// Where only positions cost. The edges' lengths are about 1, and so is the potential's reach 0.4.
struct Plates {
  Plates() {
    plate = MakeSheet(2, 3, 2, 3);
    flat = plate.pose(0);
    const Obstacle other = {plate.connectivity, flat};
    connectivity = other.Joined(plate.connectivity);
    MetricOptions options;
    options.strain = options.isometric = options.bending = 0;
    options.lambda = 1;
    metric = FreezeMetric(options, connectivity, {At({0.3, 0.2, 5})});
  }
  // The upper plate, this far from the lower one, in the user's unit.
  Shape At(const Eigen::Vector3d& way) const {
    Shape shape(3, 2 * flat.cols());
    shape << flat, flat.colwise() + way;
    return shape;
  }
  // In the metric's unit.
  Shape In(const Eigen::Vector3d& way) const { return At(way) / metric->unit; }
  Shape Above(double height) const { return In({0.3, 0.2, height}); }
  ContactModel Model() const {
    return {metric, {Above(5)}, ContactModel::Intersections::kNotExempt};
  }

  ShapeFamily plate;
  Shape flat;
  std::shared_ptr<const Connectivity> connectivity;
  std::shared_ptr<const Metric> metric;
};

TEST(ContactModel, TellsInWhichSegmentsSomethingTouches) {
  const Plates plates;
  const ContactModel model = plates.Model();
  const std::vector<Shape> shapes = {plates.Above(2), plates.Above(1), plates.Above(-1),
                                     plates.Above(-2), plates.Above(1)};
  EXPECT_EQ(SegmentsWithContact(model, shapes), (std::vector<int>{1, 3}));
  EXPECT_TRUE(SegmentsWithContact(model, {shapes[0], shapes[1]}).empty());
  // Past each other at the side.
  EXPECT_TRUE(model.IsFree(plates.In({2.5, 0, 1}), plates.In({2.5, 0, -1})));
  EXPECT_FALSE(model.IsFree(plates.In({1.5, 0, 1}), plates.In({1.5, 0, -1})));
  EXPECT_EQ(model.NumIntersections(), 0);
  EXPECT_FALSE(model.HasObstacle());
}

TEST(LeastDistance, IsThatAtSomeTimeOfThePathInTheUsersUnit) {
  const Plates plates;
  const ContactModel model = plates.Model();
  ASSERT_GT(plates.metric->unit, 2);
  EXPECT_NEAR(LeastDistance(model, {plates.Above(0.9), plates.Above(0.2), plates.Above(0.6)}), 0.2,
              1e-9);
  EXPECT_NEAR(LeastDistance(model, {plates.Above(0.1), plates.Above(0.6)}), 0.1, 1e-9);
  EXPECT_NEAR(LeastDistance(model, {plates.Above(0.6), plates.Above(0.1)}), 0.1, 1e-9);
  EXPECT_TRUE(std::isnan(LeastDistance(model, {plates.Above(3), plates.Above(2)})));
}

TEST(EnergyAlong, IsHalfTheSquaredLength) {
  const Plates plates;
  const auto moved = [&](const Eigen::Vector3d& way) -> Shape {
    return plates.Above(5).colwise() + way / plates.metric->unit;
  };
  // The energy of a straight motion is its squared length, so the length has a factor of root 2.
  const double unit = plates.metric->unit;
  EXPECT_NEAR(EnergyAlong(*plates.metric, {moved({0, 0, 0}), moved({3, 0, 0}), moved({3, 4, 0})}),
              49 / (unit * unit), 1e-9);
}

TEST(ContactWarnings, SayHowManyAndWhere) {
  const Plates plates;
  // Two sheets that cross.
  Shape crossed = plates.Above(0);
  crossed.row(2).tail(plates.flat.cols()) =
      crossed.row(0).tail(plates.flat.cols()).array() + 0.0371;
  const ContactModel model(plates.metric, {crossed}, ContactModel::Intersections::kExempt);
  ASSERT_GT(model.NumIntersections(), 1);
  EXPECT_TRUE(Names(WarningOfIntersections("the pose is crumpled", model),
                    {"the pose is crumpled", std::to_string(model.NumIntersections())}));
  EXPECT_TRUE(Names(WarningOfUncertified(3), {"3 segments"}));
  const ContactModel not_exempt(plates.metric, {crossed}, ContactModel::Intersections::kNotExempt);
  EXPECT_EQ(not_exempt.NumIntersections(), 0);
}

TEST(FirstLevelOfContact, HasEnoughTrianglesAndNoMoreIntersections) {
  const auto model = [](int cells, bool crossed) {
    const ShapeFamily sheet = MakeSheet(2, 2, cells, cells);
    Shape shape = sheet.pose(0);
    if (crossed) {  // folded, and the halves pass through each other
      for (int v = 0; v < shape.cols(); ++v) {
        if (shape(0, v) <= 0) continue;
        shape(2, v) = 0.371 - shape(0, v);
        shape(0, v) = -shape(0, v);
      }
    }
    const auto metric = FreezeMetric({}, sheet.connectivity, {shape});
    return ContactModel(metric, {shape / metric->unit}, ContactModel::Intersections::kExempt);
  };
  std::vector<int> asked;
  const auto first = [&](int finest, int intersections, const std::vector<int>& cells,
                         int level_crossed) {
    asked.clear();
    return FirstLevelOfContact(finest, intersections, [&](int level) {
      asked.push_back(level);
      return model(cells[level], level == level_crossed);
    });
  };
  EXPECT_EQ(first(3, 0, {10, 19, 20, 21}, -1), 2);  // 800 triangles
  EXPECT_EQ(asked, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(first(2, 0, {10, 19, 30}, -1), 2);
  EXPECT_EQ(asked, (std::vector<int>{0, 1}));
  const int crossings = model(20, true).NumIntersections();
  ASSERT_GT(crossings, 0);
  EXPECT_EQ(first(2, 0, {20, 21, 22}, 0), 1);
  EXPECT_EQ(first(2, crossings - 1, {20, 21, 22}, 0), 1);
  EXPECT_EQ(first(2, crossings, {20, 21, 22}, 0), 0);
}

TEST(Shorten, LeavesOutWhatChangesTheLengthLeast) {
  const Plates plates;
  const ContactModel model = plates.Model();
  const std::vector<Shape> way = {plates.In({0, 0, 3}), plates.In({1, 0.3, 3}),
                                  plates.In({2, 2, 3}), plates.In({3, 0.2, 3}),
                                  plates.In({4, 0, 3})};
  EXPECT_EQ(Shorten(model, way, 4), way);
  EXPECT_EQ(Shorten(model, way, 9), way);
  EXPECT_EQ(Shorten(model, way, 3).size(), 4u);
  EXPECT_EQ(Shorten(model, way, 2), (std::vector<Shape>{way[0], way[2], way[4]}));
  EXPECT_EQ(Shorten(model, way, 1), (std::vector<Shape>{way[0], way[4]}));
  // Round the lower plate each corner is needed, and what lies between them is not.
  const std::vector<Shape> round = {plates.In({0.3, 0, 1}), plates.In({1.5, 0, 1}),
                                    plates.In({3, 0, 1}),   plates.In({3, 0, 0}),
                                    plates.In({3, 0, -1}),  plates.In({0.3, 0, -1})};
  EXPECT_EQ(Shorten(model, round, 1), (std::vector<Shape>{round[0], round[2], round[4], round[5]}));
}

TEST(Follow, TakesTheGuideWhereNothingTouches) {
  const Plates plates;
  const ContactModel model = plates.Model();
  const CholeskyFactor<float> factor(ScalarMetric(*plates.metric, {plates.Above(5)}, 0));
  const Attraction draw = {plates.metric, factor, kRoughApproach};
  const std::vector<Shape> guide = {plates.Above(3), plates.Above(2), plates.Above(1)};
  int asked = 0;
  const FreeWay way = Follow(model, draw, 1, guide, [&] { return ++asked > 0; });
  EXPECT_EQ(way.shapes, guide);
  EXPECT_TRUE(way.arrives);
  EXPECT_EQ(way.reached, (std::vector<size_t>{0, 1, 2}));
  EXPECT_EQ(asked, 2);
  const FreeWay stopped = Follow(model, draw, 1, guide, [] { return false; });
  EXPECT_EQ(stopped.shapes, (std::vector<Shape>{guide[0]}));
  EXPECT_FALSE(stopped.arrives);
  EXPECT_EQ(stopped.reached, (std::vector<size_t>{0}));
}

TEST(UntilLittleIsGained, EndsAfterTenStepsInARow) {
  const auto go_on = UntilLittleIsGained(0.1);
  double energy = 1000;
  EXPECT_TRUE(go_on(0, energy));
  for (int i = 0; i < 9; ++i) EXPECT_TRUE(go_on(i, energy *= 0.95)) << i;
  EXPECT_TRUE(go_on(0, energy *= 0.8));  // the count begins again
  for (int i = 0; i < 9; ++i) EXPECT_TRUE(go_on(i, energy *= 0.95)) << i;
  EXPECT_FALSE(go_on(0, energy *= 0.95));
}

TEST(ContactModel, PotentialsAreOfTheAreasAndTheLengthsOfBothSides) {
  const Plates plates;
  const Obstacle table = {testing::Rectangle({-1, -1}, {2, 1.5}, 0).connectivity,
                          Shape(testing::Rectangle({-1, -1}, {2, 1.5}, 0).shape)};
  const auto metric = FreezeMetric({}, plates.plate.connectivity, {plates.flat});
  const auto above = [&](double height) -> Shape {
    return (plates.flat.colwise() + Eigen::Vector3d(0.3, 0.2, height)) / metric->unit;
  };
  const Obstacle in_frame = InFrame(table, {0, 0, 0}, metric->unit);
  const ContactModel model(metric, {above(5), above(0.3)}, ContactModel::Intersections::kExempt,
                           &in_frame);
  EXPECT_TRUE(model.HasObstacle());
  const int count = static_cast<int>(plates.flat.cols());
  EXPECT_TRUE(model.IsOfBody(count - 1));
  EXPECT_FALSE(model.IsOfBody(count));
  // The table's area is that of 7.5 squares; two of its corners are of both triangles.
  const double area = 7.5 / (metric->unit * metric->unit);
  Eigen::VectorXd areas(count + 4);
  areas << metric->vertex_area, area / 3, area / 6, area / 3, area / 6;
  int kinds[2] = {0, 0}, of_table = 0;
  for (const NearPair& pair : model.Find(above(0.5), above(0.2), ContactModel::kReach, 0)) {
    const PairPotential potential = model.PotentialOf(pair);
    const double in_pose = NearestPoints(pair.kind, model.At(pair, above(0.3))).Distance();
    EXPECT_NEAR(potential.reach, std::min(0.4 * model.Length(pair), 0.9 * in_pose), 1e-12);
    if (pair.kind == PairKind::kVertexTriangle) {
      EXPECT_NEAR(potential.weight, areas(pair.vertices[0]), 1e-12);
      EXPECT_EQ(potential.parallel, 0);
      of_table += model.IsOfBody(pair.vertices[0]) ? 0 : 1;
    } else {
      double sum = 0;
      for (const int v : pair.vertices) sum += areas(v);
      EXPECT_NEAR(potential.weight, sum / 12, 1e-12);
      EXPECT_NEAR(potential.parallel, 1e-3 * std::pow(model.Length(pair), 4), 1e-15);
    }
    ++kinds[pair.kind == PairKind::kEdgeEdge];
    // The obstacle is at rest.
    const FourPoints change = model.ChangeAt(pair, Tangent::Constant(3, plates.flat.cols(), 2));
    for (int k = 0; k < 4; ++k) {
      const double expected = model.IsOfBody(pair.vertices[k]) ? 2 : 0;
      EXPECT_EQ(change.col(k), Eigen::Vector3d::Constant(expected));
    }
  }
  EXPECT_GT(kinds[0], 0);
  EXPECT_GT(kinds[1], 0);
  EXPECT_GT(of_table, 0);
  EXPECT_TRUE(model.IsFree(above(1), above(0.1)));
  EXPECT_FALSE(model.IsFree(above(1), above(-0.1)));
  double mean = 0;
  const NearPairs pairs(in_frame.Joined(metric->connectivity),
                        {in_frame.Joined(above(5)), in_frame.Joined(above(0.3))}, count);
  for (int v = 0; v < count; ++v) mean += pairs.Length(v) / count;
  EXPECT_NEAR(model.MeanLength(), mean, 1e-12);
}

TEST(Obstacle, IsJoinedBehindTheBodyAndRefusedWhereItIsNone) {
  const Plates plates;
  const Obstacle table = testing::Rectangle({-1, -1}, {2, 1.5}, 7);
  const int count = static_cast<int>(plates.flat.cols());
  const auto joined = table.Joined(plates.plate.connectivity);
  EXPECT_EQ(joined->NumVertices(), count + 4);
  const int triangles = plates.plate.connectivity->NumTriangles();
  EXPECT_EQ(Eigen::Matrix3Xi(joined->Triangles().leftCols(triangles)),
            plates.plate.connectivity->Triangles());
  EXPECT_EQ(Eigen::Matrix3Xi(joined->Triangles().rightCols(2).array() - count),
            table.connectivity->Triangles());
  EXPECT_EQ(Shape(table.Joined(plates.flat).rightCols(4)), table.shape);
  EXPECT_EQ(Shape(table.Joined(plates.flat).leftCols(count)), plates.flat);
  const Obstacle seen = InFrame(table, {1, 2, 3}, 2);
  EXPECT_EQ(Eigen::Vector3d(seen.shape.col(2)), Eigen::Vector3d(0.5, -0.25, 2));

  const auto message = [&](const std::function<void(Obstacle*)>& change) {
    Obstacle obstacle = table;
    change(&obstacle);
    return MessageOf<MeshError>([&] { CheckObstacle(obstacle, true); });
  };
  EXPECT_EQ(message([](Obstacle*) {}), "nothing was thrown");
  EXPECT_TRUE(Names(message([](Obstacle* o) { o->connectivity = nullptr; }), {"obstacle:"}));
  EXPECT_TRUE(
      Names(message([](Obstacle* o) { o->connectivity = testing::SingleEdge(); }), {"obstacle:"}));
  const std::string shape = "obstacle: its shape is not finite, or has another number of vertices";
  EXPECT_EQ(message([](Obstacle* o) { o->shape.conservativeResize(3, 3); }), shape);
  EXPECT_EQ(message([](Obstacle* o) { o->shape(2, 3) = NAN; }), shape);
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { CheckObstacle(table, false); },
                                      {"obstacle:", "avoid_contact"}));
  EXPECT_NO_THROW(CheckObstacle(std::nullopt, false));
}

// The times of a motion are its beginning and others before its end.
TEST(MotionContact, IsTheMeanOverTimesBeforeTheEnd) {
  const Plates plates;
  const ContactModel model = plates.Model();
  const Shape from = plates.Above(0.3), to = plates.Above(0.1);
  const auto value = [&](const Shape& first, const Shape& last, int times) {
    MotionContact contact(model, times);
    contact.Prepare(first, last, 0.01);
    return contact.Evaluate(first, last, nullptr);
  };
  const auto at_rest = [&](double t) {
    const Shape shape = (1 - t) * from + t * to;
    return value(shape, shape, 1);
  };
  EXPECT_GT(at_rest(0), 0);
  EXPECT_GT(at_rest(0.5), 2 * at_rest(0));
  EXPECT_NEAR(value(from, from, 5), at_rest(0), 1e-12 * at_rest(0));
  EXPECT_NEAR(value(from, to, 1), at_rest(0), 1e-12 * at_rest(0));
  const double four = (at_rest(0) + at_rest(0.25) + at_rest(0.5) + at_rest(0.75)) / 4;
  EXPECT_NEAR(value(from, to, 4), four, 1e-9 * four);
  // Pairs that are refined have twice as many, once they are prepared for again.
  MotionContact refined(model, 2);
  refined.Prepare(from, to, 0.01);
  EXPECT_NEAR(refined.Room(from, to), 0.01, 1e-15);
  refined.Refine(model.Find(from, to, 1, 0));
  EXPECT_LT(refined.Room(from, to), 0);
  refined.Prepare(from, to, 0.01);
  EXPECT_NEAR(refined.Evaluate(from, to, nullptr), four, 1e-9 * four);
}

TEST(MotionContact, StepsKeepAFifthOfTheDistanceAndWhatTouchesIsFound) {
  const Plates plates;
  const ContactModel model = plates.Model();
  const Shape from = plates.Above(0.3);
  Tangent down = Tangent::Zero(3, from.cols());
  down.row(2).tail(plates.flat.cols()).setConstant(-0.6 / plates.metric->unit);
  for (const bool first : {true, false}) {
    MotionContact contact(model, 3);
    contact.Prepare(from, from, 1);
    const Tangent still = Tangent::Zero(3, from.cols());
    const double step = contact.SafeStep(from, from, first ? down : still, first ? still : down);
    // At the end of the motion there is no time, only at two thirds of it.
    const double most = first ? 0.4 : 0.6;
    EXPECT_LE(step, most + 1e-9) << first;
    EXPECT_GT(step, 0.5 * most) << first;
  }
  MotionContact contact(model, 3);
  contact.Prepare(from, plates.Above(-0.1), 0.5);
  EXPECT_FALSE(contact.Touching(from, plates.Above(-0.1)).empty());
  EXPECT_TRUE(contact.Touching(from, plates.Above(0.1)).empty());
  EXPECT_FALSE(contact.Touching(plates.Above(-0.1), from).empty());
}

TEST(PathContact, IsTheMeanOverItsMotions) {
  const Plates plates;
  const ContactModel model = plates.Model();
  const std::vector<Shape> shapes = {plates.Above(0.5), plates.Above(0.3), plates.Above(0.15),
                                     plates.Above(0.25)};
  PathEnergy energy(plates.metric, 2);
  std::vector<double> x(energy.Size()), gradient(energy.Size());
  energy.Load(shapes, x.data());
  const auto alone = [&](int from, int to) {
    MotionContact contact(model, 4);
    contact.Prepare(shapes[from], shapes[to], 0.01);
    return contact.Evaluate(shapes[from], shapes[to], nullptr);
  };
  ASSERT_EQ(PathContact::Segments(4).size(), 3u);
  EXPECT_EQ(PathContact::Segments(4)[2].from, 2);
  EXPECT_EQ(PathContact::Segments(4)[2].to, 3);
  PathContact all(model, energy, shapes, PathContact::Segments(4), 4);
  const double sum = alone(0, 1) + alone(1, 2) + alone(2, 3);
  EXPECT_NEAR(all.Evaluate(x.data(), 5, gradient.data()), 5 * sum / 3, 1e-9 * sum);
  PathContact some(model, energy, shapes, {{1, 1}, {2, 3}}, 4);
  const double other = alone(1, 1) + alone(2, 3);
  EXPECT_NEAR(some.Evaluate(x.data(), 2, gradient.data()), other, 1e-9 * other);
}

TEST(PathContact, StepsEndBeforeContactAndPathsWithContactAreNotAllowed) {
  const Plates plates;
  const ContactModel model = plates.Model();
  const double unit = plates.metric->unit;
  PathEnergy energy(plates.metric, 1);
  std::vector<double> x(energy.Size()), way(energy.Size()), there(energy.Size());
  Tangent down = Tangent::Zero(3, 2 * plates.flat.cols());
  const Tangent still = down;
  down.row(2).tail(plates.flat.cols()).setConstant(-1 / unit);
  const auto longest = [&](double height, double move, PathContact* contact) {
    energy.Load({still, move * down, still}, way.data());
    const std::vector<float> direction(way.begin(), way.end());
    energy.Load({plates.Above(3), plates.Above(height), plates.Above(2)}, x.data());
    return contact->LongestStep(x.data(), direction.data());
  };
  const auto contact_at = [&](double height) {
    return PathContact(model, energy, {plates.Above(3), plates.Above(height), plates.Above(2)},
                       PathContact::Segments(3), 5);
  };
  PathContact far = contact_at(1.5);
  EXPECT_EQ(longest(1.5, 0.02, &far), 1);
  // A fifth of the distance is kept.
  PathContact near = contact_at(0.1);
  const double step = longest(0.1, 0.2, &near);
  EXPECT_LE(step, 0.4 + 1e-6);
  EXPECT_GT(step, 0.2);
  // No step is longer than the room for which pairs are known: at first a twentieth of a length,
  // and a quarter where most of that has been used.
  const double length = model.MeanLength() * unit;
  PathContact room = contact_at(1.5);
  EXPECT_NEAR(longest(1.5, 1, &room), 0.05 * length, 1e-5);
  EXPECT_NEAR(longest(1.5 - 0.04 * length, 1, &room), 0.25 * length, 1e-5);

  PathContact contact = contact_at(0.05);
  longest(0.05, 0.1, &contact);
  energy.Load({plates.Above(3), plates.Above(-0.05), plates.Above(2)}, there.data());
  EXPECT_TRUE(contact.Allows(x.data()));
  EXPECT_FALSE(contact.Allows(there.data()));
  EXPECT_TRUE(contact.Allows(x.data()));
}

TEST(SeparationPotential, PairsAreWeightedByAreaAndReachNoFartherThanInThePoses) {
  const Plates plates;
  const std::vector<Shape> poses = {plates.Above(1.5), plates.Above(1)};
  const double reach = 1.2 / plates.metric->unit;
  const SeparationPotential parting(*plates.metric, poses, reach);
  const Eigen::VectorXd& area = plates.metric->vertex_area;
  const double all = area.sum();
  size_t count = 0;
  for (int i = 0; i < area.size(); ++i) {
    for (int j = 0; j < i; ++j) {
      double nearest = reach / 0.9;
      for (const Shape& pose : poses) {
        nearest = std::min(nearest, (pose.col(i) - pose.col(j)).norm());
      }
      ASSERT_GT(std::abs(nearest / reach - 0.2), 0.01);
      if (nearest < 0.2 * reach) continue;
      ASSERT_LT(count, parting.Pairs().size());
      const SeparationPair& pair = parting.Pairs()[count++];
      EXPECT_EQ(pair.first, i);
      EXPECT_EQ(pair.second, j);
      EXPECT_NEAR(pair.weight, area(i) * area(j) / (all * all), 1e-15);
      EXPECT_NEAR(pair.reach2, 0.81 * nearest * nearest, 1e-12);
    }
  }
  EXPECT_EQ(parting.Pairs().size(), count);
}

// The mean over four times of each segment.
TEST(SeparationPotential, IsTheMeanOverTimes) {
  const Plates plates;
  const std::vector<Shape> poses = {plates.Above(1.5), plates.Above(1)};
  SeparationPotential parting(*plates.metric, poses, 1.2 / plates.metric->unit);
  std::vector<Shape> path = {plates.Above(1.5), plates.Above(0.2), plates.Above(-0.3),
                             plates.Above(1)};
  PathEnergy energy(plates.metric, 2);
  std::vector<double> x(energy.Size()), gradient(energy.Size());
  energy.Load(path, x.data());
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    for (const double time : {0., 0.25, 0.5, 0.75}) {
      const Shape shape = (1 - time) * path[i] + time * path[i + 1];
      Tangent ignored = Tangent::Zero(3, shape.cols());
      for (const SeparationPair& pair : parting.Pairs()) sum += pair.Add(shape, &ignored);
    }
  }
  EXPECT_GT(sum, 0);
  EXPECT_NEAR(parting.Evaluate(energy, x.data(), 7, &path, gradient.data()), 7 * sum / 12,
              1e-12 * sum);
}

TEST(SeparationPotential, OfManyVerticesTakesEverySecondOrThird) {
  const ShapeFamily sheet = MakeSheet(20, 21, 20, 21);  // 462 vertices
  const auto metric = FreezeMetric({}, sheet.connectivity, {sheet.pose(0)});
  const SeparationPotential parting(*metric, {sheet.pose(0) / metric->unit}, 0.1);
  ASSERT_EQ(sheet.connectivity->NumVertices(), 462);
  double sum = 0;
  for (const SeparationPair& pair : parting.Pairs()) {
    EXPECT_EQ(pair.first % 2, 0);
    EXPECT_EQ(pair.second % 2, 0);
    sum += pair.weight;
  }
  EXPECT_EQ(parting.Pairs().size(), 231u * 230 / 2);
  // Of all pairs, half of the square of all areas but for those of a vertex with itself.
  EXPECT_NEAR(sum, 0.5, 0.01);
}

}  // namespace
}  // namespace shapespace::internal
