#include <shapespace/bodies/quadruped.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <random>
#include <sstream>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/random.h>
#include <shapespace/bodies/detail/bend.h>
#include <shapespace/bodies/detail/checks.h>
#include <shapespace/bodies/detail/quadruped_poses.h>
#include <shapespace/bodies/detail/remesh.h>
#include <shapespace/bodies/detail/skeleton.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace {
namespace {

constexpr int kMinTriangles = 500;
constexpr int kMaxTriangles = 1'000'000;
/// Cell size of the grid for the surface: the thinnest parts, the ears, are twice as thick.
constexpr double kCell = 0.035;
constexpr double kLeastMeasure = 0.3, kGreatestMeasure = 3;
/// The greatest factor of a random form.
constexpr double kVariation = 4.0 / 3;

constexpr std::pair<const char*, double QuadrupedForm::*> kMeasures[] = {
    {"body_length", &QuadrupedForm::body_length}, {"body_girth", &QuadrupedForm::body_girth},
    {"neck_length", &QuadrupedForm::neck_length}, {"neck_girth", &QuadrupedForm::neck_girth},
    {"head_size", &QuadrupedForm::head_size},     {"ear_length", &QuadrupedForm::ear_length},
    {"leg_length", &QuadrupedForm::leg_length},   {"leg_girth", &QuadrupedForm::leg_girth},
    {"tail_length", &QuadrupedForm::tail_length}};

/// Adds bones and their flesh.
class Builder {
 public:
  explicit Builder(const QuadrupedForm& form) : form_(form) {}

  internal::Skeleton Build() {
    Trunk();
    for (int side : {1, -1}) Ear(side);
    Tail();
    for (int side : {1, -1}) Legs(side);
    return std::move(skeleton_);
  }

 private:
  struct Scale {
    double length, girth;
  };

  /// A bone that begins where its parent ends, or at `begin`.
  void Add(const std::string& name, const std::string& parent, const Eigen::Vector3d& begin,
           const Eigen::Vector3d& end, double reach, int limb, Scale scale) {
    skeleton_.bones.push_back({name, parent.empty() ? -1 : skeleton_.Find(parent), begin, end,
                               reach, limb, scale.length, scale.girth});
  }

  /// Adds flesh to the last bone.
  void Grow(const Eigen::Vector3d& begin, double begin_radius, const Eigen::Vector3d& end,
            double end_radius, double blend, const Eigen::Vector3d& flat = Eigen::Vector3d::UnitY(),
            double flatness = 1) {
    const int bone = static_cast<int>(skeleton_.bones.size()) - 1;
    skeleton_.flesh.push_back(
        {bone, {begin, end, begin_radius, end_radius, blend, flat.normalized(), flatness}});
  }

  int NewLimb(double reach, int side) {
    skeleton_.limbs.push_back({reach, side});
    return static_cast<int>(skeleton_.limbs.size()) - 1;
  }

  void Trunk() {
    const Eigen::Vector3d side = Eigen::Vector3d::UnitY();
    const Scale body = {form_.body_length, form_.body_girth};
    const Scale neck = {form_.neck_length, form_.neck_girth};
    const Scale head = {form_.head_size, form_.head_size};
    Add("pelvis", "", {-0.5, 0, 0.89}, {-0.2, 0, 0.89}, 0, -1, body);
    Grow({-0.44, 0, 0.9}, 0.21, {-0.2, 0, 0.89}, 0.205, 0.04, side, 0.88);
    Add("loin", "pelvis", {-0.2, 0, 0.89}, {0.08, 0, 0.88}, 0.17, -1, body);
    Grow({-0.2, 0, 0.89}, 0.205, {0.08, 0, 0.87}, 0.22, 0.04, side, 0.88);
    Add("chest", "loin", {0.08, 0, 0.88}, {0.42, 0, 0.88}, 0.17, -1, body);
    Grow({0.08, 0, 0.87}, 0.22, {0.32, 0, 0.88}, 0.235, 0.04, side, 0.88);
    Add("neck", "chest", {0.42, 0, 0.95}, {0.56, 0, 1.18}, 0.15, -1, neck);
    Grow({0.4, 0, 0.95}, 0.175, {0.56, 0, 1.18}, 0.125, 0.16, side, 0.92);
    Add("nape", "neck", {0.56, 0, 1.18}, {0.66, 0, 1.38}, 0.12, -1, neck);
    Grow({0.56, 0, 1.18}, 0.125, {0.66, 0, 1.38}, 0.115, 0.06, side, 0.95);
    Add("head", "nape", {0.66, 0, 1.38}, {1, 0, 1.33}, 0.11, -1, head);
    Grow({0.68, 0, 1.43}, 0.155, {0.78, 0, 1.425}, 0.135, 0.08, side, 0.97);  // skull
    Grow({0.78, 0, 1.395}, 0.115, {0.96, 0, 1.345}, 0.095, 0.09);             // muzzle
  }

  void Ear(int side) {
    const std::string name = side > 0 ? "left ear" : "right ear";
    const int limb = NewLimb(0.07, side);
    const auto at = [&](double x, double y, double z) { return Eigen::Vector3d(x, side * y, z); };
    const Eigen::Vector3d root = at(0.67, 0.08, 1.5), middle = at(0.65, 0.185, 1.6),
                          tip = at(0.62, 0.285, 1.67);
    const Eigen::Vector3d flat = at(1, -0.25, 0.15);
    Add(name, "head", at(0.665, 0.1, 1.525), tip, 0.07, limb,
        {form_.head_size * form_.ear_length, form_.head_size});
    Grow(root, 0.065, middle, 0.092, 0.05, flat, 0.58);
    Grow(middle, 0.092, tip, 0.06, 0.03, flat, 0.58);
  }

  void Tail() {
    const int limb = NewLimb(0.12, 0);
    const Scale scale = {form_.tail_length, 1};
    const Eigen::Vector3d at[] = {
        {-0.6, 0, 0.98}, {-0.76, 0, 0.95}, {-0.87, 0, 0.81}, {-0.92, 0, 0.65}};
    Add("tail root", "pelvis", at[0], at[1], 0.1, limb, scale);
    Grow(at[0], 0.07, at[1], 0.056, 0.1);
    Add("tail", "tail root", at[1], at[2], 0.07, limb, scale);
    Grow(at[1], 0.056, at[2], 0.054, 0.02);
    Add("tail tip", "tail", at[2], at[3], 0.07, limb, scale);
    Grow(at[2], 0.054, at[3], 0.062, 0.02);
  }

  /// The centres of a leg's joints and of its toes, and the radii there.
  struct LegForm {
    Eigen::Vector3d top, knee, ankle, fetlock, foot;
    double top_radius, knee_radius, ankle_radius;
  };

  void Leg(const std::string& name, const std::string& parent, int side, const LegForm& leg) {
    const int limb = NewLimb(0.28, side);
    const Scale scale = {form_.leg_length, form_.leg_girth};
    // The leg rotates about a point below the top of its flesh, near the skin that it stretches.
    const Eigen::Vector3d hip = leg.top + 0.3 * (leg.knee - leg.top);
    Add(name + "upper", parent, hip, leg.knee, 0.18, limb, scale);
    Grow(leg.top, leg.top_radius, leg.knee, leg.knee_radius, 0.1);
    Add(name + "lower", name + "upper", leg.knee, leg.ankle, 0.18, limb, scale);
    Grow(leg.knee, leg.knee_radius, leg.ankle, leg.ankle_radius, 0.03);
    Add(name + "cannon", name + "lower", leg.ankle, leg.fetlock, 0.12, limb, scale);
    Grow(leg.ankle, leg.ankle_radius, leg.fetlock, 0.06, 0.03);
    // A paw scales with the girth of its leg.
    Add(name + "paw", name + "cannon", leg.fetlock, leg.foot + Eigen::Vector3d(0.08, 0, 0), 0.09,
        limb, {form_.leg_girth, form_.leg_girth});
    Grow(leg.foot, 0.078, leg.foot + Eigen::Vector3d(0.08, 0, -0.008), 0.07, 0.05);
  }

  void Legs(int side) {
    const auto at = [&](double x, double y, double z) { return Eigen::Vector3d(x, side * y, z); };
    const std::string name = side > 0 ? "left " : "right ";
    Leg("front " + name, "chest", side,
        {at(0.34, 0.12, 0.8), at(0.31, 0.145, 0.54), at(0.33, 0.145, 0.31), at(0.32, 0.145, 0.12),
         at(0.33, 0.145, 0.078), 0.13, 0.082, 0.066});
    Leg("hind " + name, "pelvis", side,
        {at(-0.43, 0.115, 0.84), at(-0.35, 0.145, 0.55), at(-0.5, 0.145, 0.33),
         at(-0.475, 0.145, 0.12), at(-0.465, 0.145, 0.078), 0.16, 0.092, 0.066});
  }

  const QuadrupedForm form_;
  internal::Skeleton skeleton_;
};

struct NamedPose {
  std::vector<internal::Turn> turns;
  bool mirrored = false;  // left and right are exchanged
};

const std::vector<std::pair<std::string, NamedPose>>& PoseTable() {
  const auto all = [](const auto& turns, bool mirrored = false) {
    return NamedPose{{std::begin(turns), std::end(turns)}, mirrored};
  };
  static const auto* const poses = new std::vector<std::pair<std::string, NamedPose>>{
      {"stand", {}},
      {"stride", all(internal::kStride)},
      {"sit", all(internal::kSit)},
      {"stretch", all(internal::kStretch)},
      {"rear", all(internal::kRear)},
      {"pass", all(internal::kPass)},
      {"other_stride", all(internal::kStride, true)},
      {"other_pass", all(internal::kPass, true)}};
  return *poses;
}

std::string OnOtherSide(std::string bone) {
  const size_t left = bone.find("left"), right = bone.find("right");
  if (left != std::string::npos) return bone.replace(left, 4, "right");
  if (right != std::string::npos) return bone.replace(right, 5, "left");
  return bone;
}

bool IsPaw(const internal::Bone& bone) {
  return bone.name.size() > 3 && bone.name.compare(bone.name.size() - 3, 3, "paw") == 0;
}

/// A paw without a rotation in the pose remains level.
internal::Rotations RotationsOf(const internal::Skeleton& skeleton, const NamedPose& pose) {
  internal::Rotations rotations(skeleton.bones.size(), Eigen::Vector3d::Zero());
  std::vector<bool> named(rotations.size(), false);
  const int sideways = pose.mirrored ? -1 : 1;
  for (const internal::Turn& turn : pose.turns) {
    const int j = skeleton.Find(pose.mirrored ? OnOtherSide(turn.bone) : turn.bone);
    rotations[j] =
        internal::kRadians * Eigen::Vector3d(sideways * turn.roll, turn.pitch, sideways * turn.yaw);
    named[j] = true;
  }
  for (size_t j = 0; j < rotations.size(); ++j) {
    if (named[j] || !IsPaw(skeleton.bones[j])) continue;
    for (int up = skeleton.bones[j].parent; up >= 0; up = skeleton.bones[up].parent) {
      rotations[j].y() -= rotations[up].y();
    }
  }
  return rotations;
}

class RandomNumbers {
 public:
  explicit RandomNumbers(unsigned seed) : random_(seed) {}

  double Between(double least, double greatest) {
    return least + (greatest - least) * internal::Uniform(&random_);
  }

 private:
  std::mt19937_64 random_;
};

/// Paws have random rotations like all joints, and do not remain level.
internal::Rotations RandomRotations(const internal::Skeleton& skeleton, unsigned seed) {
  RandomNumbers random(seed);
  internal::Rotations rotations(skeleton.bones.size(), Eigen::Vector3d::Zero());
  for (const internal::TurnRange& range : internal::kRandomTurns) {
    const double pitch = random.Between(range.least_pitch, range.greatest_pitch);
    const double yaw = random.Between(-range.yaw, range.yaw),
                 roll = random.Between(-range.roll, range.roll);
    rotations[skeleton.Find(range.bone)] = internal::kRadians * Eigen::Vector3d(roll, pitch, yaw);
  }
  return rotations;
}

/// From the bones' axes (x ahead, y to the left, z up) to those of glTF: z ahead, x to the left, y
/// up.
Shape Placed(const Shape& shape) {
  Shape placed(3, shape.cols());
  placed << shape.row(1), shape.row(2), shape.row(0);
  return placed;
}

const std::vector<std::pair<std::string, QuadrupedForm>>& Forms() {
  static const auto* const forms = [] {
    QuadrupedForm normal, slender, low, heavy;
    slender.leg_length = 1.4;
    slender.leg_girth = 0.9;
    slender.neck_length = 2;
    slender.neck_girth = 0.9;
    slender.body_length = 1.15;
    slender.head_size = 0.95;
    low.leg_length = 0.6;
    low.leg_girth = 0.85;
    low.body_length = 1.35;
    low.body_girth = 0.85;
    low.neck_length = 0.75;
    low.ear_length = 1.3;
    heavy.body_girth = 1.35;
    heavy.leg_girth = 1.25;
    heavy.leg_length = 0.9;
    heavy.neck_girth = 1.35;
    heavy.neck_length = 0.75;
    heavy.head_size = 1.15;
    heavy.ear_length = 0.75;
    heavy.tail_length = 0.6;
    return new std::vector<std::pair<std::string, QuadrupedForm>>{
        {"normal", normal}, {"long", slender}, {"short", low}, {"heavy", heavy}};
  }();
  return *forms;
}

template <typename Value>
std::vector<std::string> Names(const std::vector<std::pair<std::string, Value>>& table) {
  std::vector<std::string> names;
  for (const auto& entry : table) names.push_back(entry.first);
  return names;
}

template <typename Value>
const Value& Lookup(const char* what, const std::vector<std::pair<std::string, Value>>& table,
                    const std::string& name) {
  std::string known;
  for (const auto& [each, value] : table) {
    if (each == name) return value;
    known += (known.empty() ? "" : ", ") + each;
  }
  throw InvalidOptions(what, "none is called '" + name + "'; known are " + known);
}

}  // namespace

std::vector<std::pair<std::string, double>> QuadrupedForm::Measures() const {
  std::vector<std::pair<std::string, double>> measures;
  for (const auto& [name, field] : kMeasures) measures.emplace_back(name, this->*field);
  return measures;
}

void QuadrupedForm::Validate() const {
  for (const auto& [field, value] : Measures()) {
    if (value >= kLeastMeasure && value <= kGreatestMeasure) continue;
    std::ostringstream message;
    message << value << " is outside " << kLeastMeasure << " .. " << kGreatestMeasure;
    throw InvalidOptions(field, message.str());
  }
}

QuadrupedForm RandomQuadrupedForm(const QuadrupedForm& form, unsigned seed) {
  RandomNumbers random(~seed);  // others than those of the random pose of the same seed
  QuadrupedForm individual = form;
  for (const auto& [name, field] : kMeasures) {
    const double value = form.*field * std::exp(random.Between(-1, 1) * std::log(kVariation));
    individual.*field = std::clamp(value, kLeastMeasure, kGreatestMeasure);
  }
  return individual;
}

std::vector<std::string> QuadrupedProportions() { return Names(Forms()); }

QuadrupedForm NamedQuadrupedForm(const std::string& name) {
  return Lookup("proportions", Forms(), name);
}

std::vector<std::string> QuadrupedPoses() { return Names(PoseTable()); }

SkinnedBody MakeQuadruped(int triangles, const QuadrupedForm& form) {
  form.Validate();
  internal::CheckTriangles(triangles, kMaxTriangles);
  const internal::Skeleton skeleton = Builder(form).Build();
  const std::vector<internal::RoundCone> cones = skeleton.Cones();
  const internal::TriangleMesh mesh =
      internal::Remesh(internal::March(cones, kCell), cones, std::max(kMinTriangles, triangles));
  const int num_vertices = static_cast<int>(mesh.points.size());
  const auto skin = std::make_shared<const internal::Skin>(
      skeleton, Eigen::Map<const Eigen::Matrix3Xd>(mesh.points[0].data(), 3, num_vertices));

  const auto rotations = [skeleton](const std::string& name) {
    return RotationsOf(skeleton, Lookup("pose", PoseTable(), name));
  };
  SkinnedBody body;
  body.name = "quadruped";
  body.connectivity = internal::ConnectivityOf(num_vertices, mesh.triangles);
  body.pose_names = QuadrupedPoses();
  body.pose = [=](const std::string& name) { return Placed(skin->Pose(rotations(name))); };
  body.between = [=](const std::string& from, const std::string& to, double part) {
    if (!(part >= 0 && part <= 1)) throw InvalidOptions("part", "must be in [0, 1]");
    internal::Rotations turned = rotations(from);
    const internal::Rotations goal = rotations(to);
    for (size_t j = 0; j < turned.size(); ++j) turned[j] += part * (goal[j] - turned[j]);
    return Placed(skin->Pose(turned));
  };
  body.random_pose = [=](unsigned seed) {
    return Placed(skin->Pose(RandomRotations(skeleton, seed)));
  };
  return body;
}

}  // namespace shapespace
