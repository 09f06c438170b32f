#ifndef TESTS_OUTPUT_PAINTED_CUBE_H_
#define TESTS_OUTPUT_PAINTED_CUBE_H_

#include <memory>

#include <Eigen/Core>

#include <shapespace/output/picture.h>
#include <shapespace/path/path.h>

#include "mesh/bodies.h"
#include "mesh/files.h"
#include "support/path_of.h"

namespace shapespace {

/// A cube in a folder of its own: every square has its own part of the texture, except two that
/// share an edge; three materials, one of which no library contains, and one polygon without
/// material.
class PaintedCubeTest : public testing::FilesTest {
 protected:
  PaintedCubeTest() {
    const Soup cube = testing::Cube();
    connectivity_ =
        Connectivity::Make(cube.NumVertices(), cube.polygon_begin, cube.corners, cube.segments);
    const Eigen::Vector3d stretch(1, 1.5, 0.75);
    path_ = testing::PathOf(connectivity_, {cube.vertices, stretch.asDiagonal() * cube.vertices});

    Appearance& appearance = path_.appearance;
    appearance.folder = appearance.own_folder = Path("");
    appearance.material_libraries = {"cube.mtl"};
    appearance.materials = {{"painted", "glass", "unknown"}, {0, 0, 1, 0, 2, -1}};
    appearance.texture_coordinates.resize(2, 24);
    for (int k = 0; k < 24; ++k) {
      const int p = k / 4, corner = k % 4;
      appearance.corner_texture.push_back(k);
      appearance.texture_coordinates.col(k) << (p + (corner == 1 || corner == 2)) / 8.0,
          corner / 2 / 4.0;
    }
    // Polygons 0 and 4 meet in the edge from 0 to 2: no seam there.
    for (const int vertex : {0, 2}) {
      Texture(4, vertex) = Texture(0, vertex);
    }
    appearance.corner_texture[23] = -1;  // a corner without
    File("cube.mtl",
         "newmtl painted\nKd 0 0 0\nmap_Kd maps/checks.png\nnewmtl glass\nKd 0.5 0.25 1\nd 0.5\n");
    WritePng(Path("maps/checks.png"), {2, 1, {255, 0, 0, 0, 0, 255}});
  }

  Eigen::Ref<Eigen::Vector2d> Texture(int polygon, int vertex) {
    return path_.appearance.texture_coordinates.col(
        path_.appearance.corner_texture[CornerOf(polygon, vertex)]);
  }

  int CornerOf(int polygon, int vertex) const {
    int k = connectivity_->PolygonBegin()[polygon];
    while (connectivity_->Corners()[k] != vertex) ++k;
    return k;
  }

  std::shared_ptr<const Connectivity> connectivity_;
  shapespace::Path path_;
};

}  // namespace shapespace

#endif  // TESTS_OUTPUT_PAINTED_CUBE_H_
