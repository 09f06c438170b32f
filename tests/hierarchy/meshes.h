#ifndef TESTS_HIERARCHY_MESHES_H_
#define TESTS_HIERARCHY_MESHES_H_

#include <cmath>
#include <memory>
#include <ostream>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/quadruped.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/hierarchy/detail/decimate.h>
#include <shapespace/mesh/topology.h>

#include "mesh/bodies.h"
#include "support/paths.h"

namespace shapespace::testing {

struct PosedMesh {
  std::string name;
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Shape> poses;
};

inline std::shared_ptr<const Connectivity> ConnectivityOf(const Soup& soup) {
  return Connectivity::Make(soup.NumVertices(), soup.polygon_begin, soup.corners);
}

inline std::shared_ptr<const Connectivity> TrianglesOf(
    int num_vertices, const std::vector<Eigen::Vector3i>& triangles) {
  Eigen::Matrix3Xi columns(3, triangles.size());
  for (size_t f = 0; f < triangles.size(); ++f) columns.col(f) = triangles[f];
  return Connectivity::FromTriangles(num_vertices, columns);
}

/// Bends a shape along x, in proportion to its size.
inline Shape BentByHand(const Shape& shape) {
  const double turn = 2 / (shape.row(0).maxCoeff() - shape.row(0).minCoeff());
  Shape bent = shape;
  for (int v = 0; v < bent.cols(); ++v) {
    const double angle = turn * shape(0, v), radius = 1 / turn - shape(2, v);
    bent.col(v) << radius * std::sin(angle), shape(1, v), 1 / turn - radius * std::cos(angle);
  }
  return bent;
}

inline PosedMesh WithBent(std::string name, const Soup& soup) {
  return {std::move(name), ConnectivityOf(soup), {soup.vertices, BentByHand(soup.vertices)}};
}

inline PosedMesh Animal(int triangles, std::vector<std::string> pose_names = {}) {
  const SkinnedBody body = MakeQuadruped(triangles);
  if (pose_names.empty()) pose_names = body.pose_names;
  PosedMesh mesh = {"animal", body.connectivity, {}};
  for (const std::string& name : pose_names) mesh.poses.push_back(body.pose(name));
  return mesh;
}

/// Two meshes as one, the second one translated.
inline PosedMesh Pair(const PosedMesh& first, const PosedMesh& second) {
  const int offset = first.connectivity->NumVertices();
  std::vector<Eigen::Vector3i> triangles;
  for (const auto& t : first.connectivity->Triangles().colwise()) triangles.push_back(t);
  for (const auto& t : second.connectivity->Triangles().colwise()) {
    triangles.push_back(t.array() + offset);
  }
  PosedMesh pair = {first.name + "And" + second.name,
                    TrianglesOf(offset + second.connectivity->NumVertices(), triangles),
                    {}};
  for (size_t p = 0; p < first.poses.size(); ++p) {
    Shape shape(3, pair.connectivity->NumVertices());
    shape << first.poses[p], second.poses[p].colwise() + Eigen::Vector3d(0, 0, 20);
    pair.poses.push_back(shape);
  }
  return pair;
}

/// A flat ring of n x m quadrilaterals.
inline Soup Ring(int n, int m) {
  Shape vertices(3, n * (m + 1));
  std::vector<std::vector<int>> polygons;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * M_PI * i / n;
    for (int j = 0; j <= m; ++j) {
      const double radius = 1 + static_cast<double>(j) / m;
      const int a = i * (m + 1) + j, b = (i + 1) % n * (m + 1) + j;
      vertices.col(a) << radius * std::cos(angle), radius * std::sin(angle), 0;
      if (j < m) polygons.push_back({a, a + 1, b + 1, b});
    }
  }
  return MakeSoup(vertices, polygons);
}

inline PosedMesh BentTube(int triangles) {
  const ShapeFamily tube = MakeTube(triangles);
  return {"tube", tube.connectivity, {tube.pose(0), tube.pose(90)}};
}

inline PosedMesh RolledSheet() {
  const ShapeFamily sheet = MakeSheet(3, 2, 30, 20);
  return {"sheet", sheet.connectivity, {sheet.pose(0), sheet.pose(100), sheet.pose(200)}};
}

/// A mesh, made on demand.
struct SurfaceCase {
  const char* name;
  PosedMesh (*make)();
};

inline void PrintTo(const SurfaceCase& surface, std::ostream* out) { *out << surface.name; }

/// Surfaces of every kind: with and without boundary, handles, several components, quadrilaterals.
inline constexpr SurfaceCase kSurfaces[] = {
    {"tube", [] { return BentTube(2000); }},
    {"sheet", RolledSheet},
    {"animal", [] { return Animal(2500); }},
    {"torus", [] { return WithBent("torus", Torus(40, 20)); }},
    {"ring", [] { return WithBent("ring", Ring(60, 10)); }},
    {"tubeAndTorus", [] { return Pair(BentTube(1200), WithBent("torus", Torus(30, 15))); }},
    {"ringAndTube", [] { return Pair(WithBent("ring", Ring(40, 8)), BentTube(800)); }}};

inline void ExpectSameTopology(const Connectivity& first, const Connectivity& second) {
  const Topology a = ComputeTopology(first), b = ComputeTopology(second);
  EXPECT_EQ(a.components, b.components);
  EXPECT_EQ(a.manifold, b.manifold);
  EXPECT_EQ(a.boundary_loops.size(), b.boundary_loops.size());
  EXPECT_EQ(a.genus, b.genus);
}

/// The mesh after collapses, with all its vertices.
inline std::shared_ptr<const Connectivity> After(const Connectivity& mesh,
                                                 const std::vector<internal::Collapse>& collapses) {
  std::vector<int> place(mesh.NumVertices());
  for (int v = 0; v < mesh.NumVertices(); ++v) place[v] = v;
  for (size_t i = collapses.size(); i-- > 0;) place[collapses[i].from] = place[collapses[i].to];
  std::vector<Eigen::Vector3i> triangles;
  for (const auto& t : mesh.Triangles().colwise()) {
    const Eigen::Vector3i moved(place[t(0)], place[t(1)], place[t(2)]);
    if (moved(0) != moved(1) && moved(1) != moved(2) && moved(2) != moved(0)) {
      triangles.push_back(moved);
    }
  }
  return TrianglesOf(mesh.NumVertices(), triangles);
}

/// A random mesh of up to 40 vertices and 80 triangles, with boundaries, edges of many triangles,
/// and triangles that are repeated, without area or with a repeated corner.
inline PosedMesh AnyMesh(int seed) {
  std::mt19937 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % n); };
  const int n = 3 + below(6), m = 2 + below(4);
  Soup soup = Grid(n, m);
  std::vector<Eigen::Vector3i> triangles;
  for (int f = 0; f < soup.NumPolygons(); ++f) {
    if (below(8) > 0) {
      triangles.emplace_back(soup.corners[3 * f], soup.corners[3 * f + 1], soup.corners[3 * f + 2]);
    }
  }
  for (int i = below(6); i > 0; --i) {
    triangles.emplace_back(below(soup.NumVertices()), below(soup.NumVertices()),
                           below(soup.NumVertices()));
  }
  PosedMesh mesh = {"any", TrianglesOf(soup.NumVertices(), triangles), {}};
  const double noise = below(3) * 0.2;
  for (int p = 0; p < 2; ++p) {
    Shape pose = soup.vertices + Noise(soup.NumVertices(), noise, seed + p);
    for (int i = below(4); i > 0; --i) {
      pose.col(below(soup.NumVertices())) = pose.col(below(soup.NumVertices()));
    }
    mesh.poses.push_back(pose);
  }
  if (below(10) == 0) mesh.poses[1].setZero();
  return mesh;
}

}  // namespace shapespace::testing

#endif  // TESTS_HIERARCHY_MESHES_H_
