#include <shapespace/bodies/quadruped.h>

#include <algorithm>
#include <map>
#include <memory>
#include <sstream>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bend.h>
#include <shapespace/bodies/checks.h>
#include <shapespace/bodies/polygonise.h>
#include <shapespace/bodies/skeleton.h>

namespace shapespace {
namespace {

constexpr int kLeastTriangles = 500;
constexpr int kMostTriangles = 1'000'000;
/// Of the grid that finds the surface: its thinnest parts, the ears, are twice as thick.
constexpr double kCell = 0.035;

/// Adds bones and their flesh one after another.
class Builder {
 public:
  explicit Builder(const QuadrupedForm& form) : form_(form) {}

  Skeleton Build() {
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

  /// Flesh of the last bone.
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
    Add("pelvis", "", {-0.5, 0, 0.9}, {-0.2, 0, 0.89}, 0, -1, body);
    Grow({-0.44, 0, 0.9}, 0.21, {-0.2, 0, 0.89}, 0.205, 0.1, side, 0.88);
    Add("loin", "pelvis", {-0.2, 0, 0.89}, {0.08, 0, 0.87}, 0.17, -1, body);
    Grow({-0.2, 0, 0.89}, 0.205, {0.08, 0, 0.87}, 0.22, 0.1, side, 0.9);
    Add("chest", "loin", {0.08, 0, 0.87}, {0.42, 0, 0.95}, 0.17, -1, body);
    Grow({0.08, 0, 0.87}, 0.22, {0.32, 0, 0.88}, 0.235, 0.1, side, 0.88);
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
    Grow(root, 0.06, middle, 0.095, 0.05, flat, 0.42);
    Grow(middle, 0.095, tip, 0.05, 0.03, flat, 0.42);
  }

  void Tail() {
    const int limb = NewLimb(0.12, 0);
    const Scale scale = {form_.tail_length, 1};
    const Eigen::Vector3d at[] = {
        {-0.6, 0, 0.98}, {-0.76, 0, 0.95}, {-0.87, 0, 0.81}, {-0.92, 0, 0.65}};
    Add("tail root", "pelvis", at[0], at[1], 0.07, limb, scale);
    Grow(at[0], 0.07, at[1], 0.056, 0.1);
    Add("tail", "tail root", at[1], at[2], 0.07, limb, scale);
    Grow(at[1], 0.056, at[2], 0.054, 0.04);
    Add("tail tip", "tail", at[2], at[3], 0.07, limb, scale);
    Grow(at[2], 0.054, at[3], 0.062, 0.04);
  }

  /// The middles of a leg's joints and of its toes, and the radii there.
  struct LegForm {
    Eigen::Vector3d top, knee, ankle, fetlock, foot;
    double top_radius, knee_radius, ankle_radius;
  };

  void Leg(const std::string& name, const std::string& parent, int side, const LegForm& leg) {
    const int limb = NewLimb(0.28, side);
    const Scale scale = {form_.leg_length, form_.leg_girth};
    // It turns about a point below the top of its flesh, near the skin that it pulls at.
    const Eigen::Vector3d hip = leg.top + 0.3 * (leg.knee - leg.top);
    Add(name + "upper", parent, hip, leg.knee, 0.18, limb, scale);
    Grow(leg.top, leg.top_radius, leg.knee, leg.knee_radius, 0.1);
    Add(name + "lower", name + "upper", leg.knee, leg.ankle, 0.14, limb, scale);
    Grow(leg.knee, leg.knee_radius, leg.ankle, leg.ankle_radius, 0.05);
    Add(name + "cannon", name + "lower", leg.ankle, leg.fetlock, 0.1, limb, scale);
    Grow(leg.ankle, leg.ankle_radius, leg.fetlock, 0.06, 0.04);
    // A paw grows with the girth of its leg.
    Add(name + "paw", name + "cannon", leg.fetlock, leg.foot + Eigen::Vector3d(0.08, 0, 0), 0.09,
        limb, {form_.leg_girth, form_.leg_girth});
    Grow(leg.foot, 0.078, leg.foot + Eigen::Vector3d(0.08, 0, -0.008), 0.07, 0.05);
  }

  void Legs(int side) {
    const auto at = [&](double x, double y, double z) { return Eigen::Vector3d(x, side * y, z); };
    const std::string name = side > 0 ? "left " : "right ";
    Leg("front " + name, "chest", side,
        {at(0.34, 0.12, 0.8), at(0.31, 0.145, 0.54), at(0.33, 0.145, 0.31), at(0.32, 0.145, 0.12),
         at(0.33, 0.145, 0.078), 0.13, 0.085, 0.068});
    Leg("hind " + name, "pelvis", side,
        {at(-0.43, 0.115, 0.84), at(-0.35, 0.145, 0.55), at(-0.5, 0.145, 0.33),
         at(-0.475, 0.145, 0.12), at(-0.465, 0.145, 0.078), 0.16, 0.1, 0.068});
  }

  const QuadrupedForm form_;
  Skeleton skeleton_;
};

/// A joint's rotation in degrees: `pitch` about +y (a leg goes back, a head down), `yaw` about +z
/// (to the left), `roll` about +x (the left side up).
struct Turn {
  const char* bone;
  double pitch, yaw = 0, roll = 0;
};

/// Bones of poses. A paw that is not named stays level.
const std::vector<std::pair<std::string, std::vector<Turn>>>& Poses() {
  static const auto* const poses =
      new std::vector<std::pair<std::string, std::vector<Turn>>>{{"stand", {}},
                                                                 {"stride",
                                                                  {{"neck", 6},
                                                                   {"nape", 6, 6},
                                                                   {"head", -8, 8},
                                                                   {"loin", 0, 4},
                                                                   {"chest", 0, 4},
                                                                   {"tail root", 26, 10},
                                                                   {"tail", 10, 10},
                                                                   {"tail tip", 16, 10},
                                                                   {"front left upper", -34},
                                                                   {"front left lower", 0},
                                                                   {"front left cannon", 10},
                                                                   {"front right upper", 26},
                                                                   {"front right lower", 10},
                                                                   {"front right cannon", 18},
                                                                   {"front right paw", -14},
                                                                   {"hind left upper", 28},
                                                                   {"hind left lower", 2},
                                                                   {"hind left cannon", 8},
                                                                   {"hind left paw", -10},
                                                                   {"hind right upper", -36},
                                                                   {"hind right lower", 22},
                                                                   {"hind right cannon", -10}}},
                                                                 {"sit",
                                                                  {{"pelvis", -46},
                                                                   {"loin", 4},
                                                                   {"chest", 4},
                                                                   {"neck", 14},
                                                                   {"nape", 14},
                                                                   {"head", 10},
                                                                   {"tail root", 16},
                                                                   {"tail", -24},
                                                                   {"tail tip", -24},
                                                                   {"front left upper", 42},
                                                                   {"front left lower", -6},
                                                                   {"front left cannon", 2},
                                                                   {"front right upper", 42},
                                                                   {"front right lower", -6},
                                                                   {"front right cannon", 2},
                                                                   {"hind left upper", -45, 12},
                                                                   {"hind left lower", 88},
                                                                   {"hind left cannon", -62},
                                                                   {"hind left paw", 52},
                                                                   {"hind right upper", -45, -12},
                                                                   {"hind right lower", 88},
                                                                   {"hind right cannon", -62},
                                                                   {"hind right paw", 52}}},
                                                                 {"stretch",
                                                                  {{"pelvis", 25},
                                                                   {"loin", 6},
                                                                   {"chest", -4},
                                                                   {"neck", -14},
                                                                   {"nape", -16},
                                                                   {"head", -10},
                                                                   {"tail root", 60},
                                                                   {"tail", 30},
                                                                   {"tail tip", 24},
                                                                   {"front left upper", -74},
                                                                   {"front left lower", -14},
                                                                   {"front left paw", 50},
                                                                   {"front right upper", -74},
                                                                   {"front right lower", -14},
                                                                   {"front right paw", 50},
                                                                   {"hind left upper", -4},
                                                                   {"hind left lower", -20},
                                                                   {"hind right upper", -4},
                                                                   {"hind right lower", -20}}},
                                                                 {"rear",
                                                                  {{"pelvis", -52},
                                                                   {"loin", -6},
                                                                   {"chest", -4},
                                                                   {"neck", 14},
                                                                   {"nape", 18},
                                                                   {"head", 16},
                                                                   {"tail root", 20},
                                                                   {"front left upper", -30},
                                                                   {"front left lower", 70},
                                                                   {"front left cannon", 30},
                                                                   {"front left paw", 20},
                                                                   {"front right upper", -5},
                                                                   {"front right lower", 60},
                                                                   {"front right cannon", 30},
                                                                   {"front right paw", 20},
                                                                   {"hind left upper", 30},
                                                                   {"hind left lower", 34},
                                                                   {"hind left cannon", -20},
                                                                   {"hind right upper", 20},
                                                                   {"hind right lower", 38},
                                                                   {"hind right cannon", -18}}}};
  return *poses;
}

Rotations RotationsOf(const Skeleton& skeleton, const std::vector<Turn>& turns) {
  Rotations rotations(skeleton.bones.size(), Eigen::Vector3d::Zero());
  std::vector<bool> named(rotations.size(), false);
  for (const Turn& turn : turns) {
    const int j = skeleton.Find(turn.bone);
    rotations[j] = kRadians * Eigen::Vector3d(turn.roll, turn.pitch, turn.yaw);
    named[j] = true;
  }
  for (size_t j = 0; j < rotations.size(); ++j) {
    const std::string& name = skeleton.bones[j].name;
    if (named[j] || name.size() < 3 || name.substr(name.size() - 3) != "paw") continue;
    for (int up = skeleton.bones[j].parent; up >= 0; up = skeleton.bones[up].parent) {
      rotations[j].y() -= rotations[up].y();
    }
  }
  return rotations;
}

/// "name: no ... is called 'x'; known are a, b".
std::string Unknown(const char* what, const std::string& name,
                    const std::vector<std::string>& known) {
  std::string list;
  for (const std::string& each : known) list += (list.empty() ? "" : ", ") + each;
  return std::string(what) + ": none is called '" + name + "'; known are " + list;
}

const std::vector<std::pair<std::string, QuadrupedForm>>& Forms() {
  static const auto* const forms = [] {
    QuadrupedForm normal, slender, low, heavy;
    slender.leg_length = 1.5;
    slender.leg_girth = 0.9;
    slender.neck_length = 2.1;
    slender.neck_girth = 0.9;
    slender.body_length = 0.9;
    slender.head_size = 0.95;
    low.leg_length = 0.5;
    low.leg_girth = 0.95;
    low.body_length = 1.4;
    low.body_girth = 0.85;
    low.neck_length = 0.75;
    low.ear_length = 1.4;
    heavy.body_girth = 1.35;
    heavy.leg_girth = 1.35;
    heavy.leg_length = 0.85;
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
  for (const auto& entry : table) {
    if (entry.first == name) return entry.second;
  }
  throw InvalidOptions(Unknown(what, name, Names(table)));
}

}  // namespace

void QuadrupedForm::Validate() const {
  for (const auto& [field, value] :
       {std::pair("body_length", body_length), std::pair("body_girth", body_girth),
        std::pair("neck_length", neck_length), std::pair("neck_girth", neck_girth),
        std::pair("head_size", head_size), std::pair("ear_length", ear_length),
        std::pair("leg_length", leg_length), std::pair("leg_girth", leg_girth),
        std::pair("tail_length", tail_length)}) {
    if (value >= 0.3 && value <= 3) continue;
    std::ostringstream message;
    message << field << ": " << value << " is outside 0.3 .. 3";
    throw InvalidOptions(message.str());
  }
}

std::vector<std::string> QuadrupedProportions() { return Names(Forms()); }

QuadrupedForm NamedQuadrupedForm(const std::string& name) {
  return Lookup("proportions", Forms(), name);
}

std::vector<std::string> QuadrupedPoses() { return Names(Poses()); }

SkinnedBody MakeQuadruped(int triangles, const QuadrupedForm& form) {
  form.Validate();
  CheckTriangles(triangles, kMostTriangles);
  const Skeleton skeleton = Builder(form).Build();
  const std::vector<RoundCone> cones = skeleton.Cones();
  const TriangleMesh mesh =
      Remesh(March(cones, kCell), cones, std::max(kLeastTriangles, triangles));
  const int num_vertices = static_cast<int>(mesh.points.size());
  const auto skin = std::make_shared<const Skin>(
      skeleton, Eigen::Map<const Eigen::Matrix3Xd>(mesh.points[0].data(), 3, num_vertices));

  const auto rotations = [skeleton](const std::string& name) {
    return RotationsOf(skeleton, Lookup("pose", Poses(), name));
  };
  SkinnedBody body;
  body.name = "quadruped";
  body.connectivity = ConnectivityOf(num_vertices, mesh.triangles);
  body.pose_names = QuadrupedPoses();
  body.pose = [=](const std::string& name) { return skin->Pose(rotations(name)); };
  body.between = [=](const std::string& from, const std::string& to, double part) {
    if (!(part >= 0 && part <= 1)) throw InvalidOptions("part: must be in [0, 1]");
    Rotations turned = rotations(from);
    const Rotations goal = rotations(to);
    for (size_t j = 0; j < turned.size(); ++j) turned[j] += part * (goal[j] - turned[j]);
    return skin->Pose(turned);
  };
  return body;
}

}  // namespace shapespace
