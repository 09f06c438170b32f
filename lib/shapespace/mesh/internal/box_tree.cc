#include <shapespace/mesh/internal/box_tree.h>

#include <limits>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/embree.h>
#include <shapespace/base/internal/fork_join.h>

namespace shapespace::internal {
namespace {

constexpr float kRounding = std::numeric_limits<float>::epsilon();

void CheckTree(RTCDevice device) {
  CheckEmbree(device, "not enough memory for Embree's search tree",
              "Embree, which searches for what is near, failed");
}

}  // namespace

struct BoxTree::Tree {
  // Boxes are in single precision, relative to the centre, in units of half the extent, and larger
  // by more than that rounds.
  Eigen::Vector3d centre;
  double unit;
  Eigen::Matrix3Xf low, high;
  ForkJoin building{};  // constructed after the data that Bounds reads
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Tree(const Eigen::Matrix3Xd& lows, const Eigen::Matrix3Xd& highs) {
    const Eigen::Vector3d lowest = lows.rowwise().minCoeff(), highest = highs.rowwise().maxCoeff();
    centre = lowest + 0.5 * (highest - lowest);
    unit = 0.5 * (highest - lowest).maxCoeff();
    low = ((lows.colwise() - centre) / unit).cast<float>().array() - kRounding;
    high = ((highs.colwise() - centre) / unit).cast<float>().array() + kRounding;
  }
  Tree(const Tree&) = delete;
  ~Tree() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  static void Bounds(const RTCBoundsFunctionArguments* arguments) {
    const auto* self = static_cast<const Tree*>(arguments->geometryUserPtr);
    const ForkJoin::Piece piece(self->building);
    const auto low = self->low.col(arguments->primID), high = self->high.col(arguments->primID);
    RTCBounds* bounds = arguments->bounds_o;
    bounds->lower_x = low.x(), bounds->lower_y = low.y(), bounds->lower_z = low.z();
    bounds->upper_x = high.x(), bounds->upper_y = high.y(), bounds->upper_z = high.z();
  }

  // The point query's radius, in these units, that includes everything within `distance`. Near the
  // boxes, points are rounded by less than the boxes are widened; farther away, by a share of their
  // distance.
  float Radius(double distance) const {
    return static_cast<float>(distance / unit * (1 + 4.0 * kRounding));
  }

  struct Query {
    const Tree* tree;
    const std::function<double(int)>* visit;
    double within;
  };

  static bool OnElement(RTCPointQueryFunctionArguments* arguments) {
    auto* query = static_cast<Query*>(arguments->userPtr);
    const double within = (*query->visit)(static_cast<int>(arguments->primID));
    if (!(within < query->within)) return false;
    query->within = within;
    arguments->query->radius = query->tree->Radius(within);
    return true;
  }

  struct Pairs {
    const std::function<void(int, int)>* visit;
    ForkJoin calls{};
  };

  // Called on several threads. For a scene with itself Embree finds every pair twice.
  static void OnPairs(void* user, RTCCollision* pairs, unsigned num_pairs) {
    const auto* query = static_cast<const Pairs*>(user);
    const ForkJoin::Piece piece(query->calls);
    for (unsigned i = 0; i < num_pairs; ++i) {
      const unsigned first = pairs[i].primID0, second = pairs[i].primID1;
      if (first < second) (*query->visit)(static_cast<int>(first), static_cast<int>(second));
    }
  }
};

BoxTree::BoxTree(const Eigen::Matrix3Xd& low, const Eigen::Matrix3Xd& high) {
  auto tree = std::make_unique<Tree>(low, high);
  tree->device = rtcNewDevice(nullptr);
  if (tree->device == nullptr) throw Error("Embree cannot start on this machine");
  tree->scene = rtcNewScene(tree->device);
  RTCGeometry geometry = rtcNewGeometry(tree->device, RTC_GEOMETRY_TYPE_USER);
  CheckTree(tree->device);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(low.cols()));
  rtcSetGeometryUserData(geometry, tree.get());
  rtcSetGeometryBoundsFunction(geometry, &Tree::Bounds, nullptr);
  rtcSetGeometryPointQueryFunction(geometry, &Tree::OnElement);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(tree->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(tree->scene);
  CheckTree(tree->device);
  tree_ = std::move(tree);
}

BoxTree::~BoxTree() = default;

void BoxTree::VisitNear(const Eigen::Vector3d& point, double within,
                        const std::function<double(int element)>& visit) const {
  const Eigen::Vector3f local = ((point - tree_->centre) / tree_->unit).cast<float>();
  RTCPointQuery at;
  at.x = local.x(), at.y = local.y(), at.z = local.z();
  at.time = 0;
  at.radius = tree_->Radius(within);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  Tree::Query query = {tree_.get(), &visit, within};
  rtcPointQuery(tree_->scene, &at, &context, nullptr, &query);
}

void BoxTree::VisitPairs(const std::function<void(int first, int second)>& visit) const {
  Tree::Pairs query{&visit};
  rtcCollide(tree_->scene, tree_->scene, &Tree::OnPairs, &query);
  CheckTree(tree_->device);
}

}  // namespace shapespace::internal
