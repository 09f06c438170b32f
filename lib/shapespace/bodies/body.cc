#include <shapespace/bodies/body.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/bricard.h>
#include <shapespace/bodies/catenoid.h>
#include <shapespace/bodies/detail/bend.h>
#include <shapespace/bodies/detail/checks.h>
#include <shapespace/bodies/detail/grid.h>
#include <shapespace/bodies/miura.h>
#include <shapespace/bodies/quadruped.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/bodies/steffen.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace {
namespace {

// Each of these divides its body into cells that are as square as the number of triangles allows.

ShapeFamily Bar(int triangles) {
  const double length = 5, width = 1, height = 1;
  const double area = 2 * (length * width + width * height + height * length);
  const double cell = std::sqrt(2 * area / triangles);
  return MakeBar(length, width, height, internal::CellsAlong(length, cell),
                 internal::CellsAlong(width, cell), internal::CellsAlong(height, cell));
}

ShapeFamily Sheet(int triangles) {
  const double length = 3, width = 2;
  const double cell = std::sqrt(2 * length * width / triangles);
  return MakeSheet(length, width, internal::CellsAlong(length, cell),
                   internal::CellsAlong(width, cell));
}

ShapeFamily Strip(int triangles) { return MakeStrip(1, 1.5, std::max(2, triangles)); }

ShapeFamily Bricard(int) { return MakeBricard(); }

ShapeFamily Catenoid(int triangles) {
  const double half_height = 1;
  const double cell = std::sqrt(2 * 2 * internal::kPi * 2 * half_height / triangles);
  return MakeCatenoid(half_height, std::max(3, internal::CellsAlong(2 * internal::kPi, cell)),
                      internal::CellsAlong(2 * half_height, cell));
}

ShapeFamily Tube(int triangles) { return MakeTube(triangles); }

ShapeFamily Steffen(int) { return MakeSteffen(); }

ShapeFamily Miura(int triangles) {
  const int nx = std::max<int>(1, std::lround(std::sqrt(triangles / 2.0)));
  return MakeMiura(1, 1, 60, nx, std::max<int>(1, std::lround(triangles / 2.0 / nx)));
}

// From its rest pose to the one that is farthest from it.
ShapeFamily Quadruped(int triangles) {
  SkinnedBody animal = MakeQuadruped(std::min(triangles, 1'000'000));
  ShapeFamily body;
  body.name = animal.name;
  body.connectivity = animal.connectivity;
  body.parameter = "part of the way from standing to stretching";
  body.end = 1;
  body.pose = [between = std::move(animal.between)](double part) {
    return between("stand", "stretch", part);
  };
  return internal::WithCheckedRange(std::move(body));
}

struct Entry {
  BodyInfo info;
  ShapeFamily (*make)(int triangles);
};

const std::vector<Entry>& Registry() {
  static const auto* const registry = new std::vector<Entry>{
      {{"tube", "a finger: a closed tube, bending at two joints", 5000}, Tube},
      {{"bar", "a closed box, bent to an arc; keeps its volume", 2200}, Bar},
      {{"sheet", "a rectangle, rolled up; isometric as a smooth surface", 2000}, Sheet},
      {{"strip", "a strip of triangles, folded to a ring; exactly isometric", 24}, Strip},
      {{"catenoid", "catenoid to helicoid; isometric as a smooth surface", 2000}, Catenoid},
      {{"bricard", "Bricard's flexible octahedron, 8 triangles; exactly isometric", 8}, Bricard},
      {{"steffen", "Steffen's flexible polyhedron, 14 triangles; exactly isometric", 14}, Steffen},
      {{"miura", "a Miura fold of flat parallelograms; exactly isometric", 512}, Miura},
      {{"quadruped", "a friendly animal with bones, standing to stretching", 20000}, Quadruped}};
  return *registry;
}

}  // namespace

std::vector<BodyInfo> ListBodies() {
  std::vector<BodyInfo> infos;
  for (const Entry& entry : Registry()) infos.push_back(entry.info);
  return infos;
}

ShapeFamily MakeBody(const std::string& name, int triangles) {
  std::string known;
  for (const Entry& entry : Registry()) {
    if (entry.info.name == name) {
      // Half the limit, because rounding to whole cells may add triangles.
      internal::CheckTriangles(triangles, internal::kMaxBodyTriangles / 2);
      return entry.make(triangles == 0 ? entry.info.default_triangles : triangles);
    }
    known += (known.empty() ? "" : ", ") + entry.info.name;
  }
  throw InvalidOptions("name", "no body is called '" + name + "'; known are " + known);
}

}  // namespace shapespace
