#include <shapespace/output/page.h>

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>

#include "mesh/bodies.h"
#include "mesh/files.h"
#include "output/read_page.h"
#include "support/message_of.h"
#include "support/path_of.h"

namespace shapespace {
namespace {

using testing::MessageOf;
using testing::Names;
using testing::Refuses;

class PageHeaderTest : public testing::FilesTest {
 protected:
  PageHeaderTest() {
    // Two modes, two places: the mean, four keys of single modes, one of both.
    const Soup cube = testing::Cube();
    modes_.connectivity = testing::Connected(cube);
    modes_.places = {-2, 1.5};
    modes_.pair_place = 0.75;
    for (int k = 0; k < 6; ++k) {
      Shape key = cube.vertices;
      key.row(k % 3) *= 1 + 0.25 * k;
      key.col(k).z() -= 0.5 * k;
      modes_.keys.push_back(key);
    }
    modes_.up = {0, 0, 1};
    modes_.error = 0.0125;
    modes_.shares = {0.7, 0.2};
    modes_.names = {"a", "b", "c"};
    modes_.coordinates = (Eigen::MatrixXd(3, 2) << 1, 2, 3, 4, 5, 6).finished();
    modes_.scalars = {{"age", 1, 9, 4}, {"mass", -1, 2, 0.5}, {"third", 0, 1, 1}};
    modes_.intercept = Eigen::Vector2d(0.25, -0.5);
    modes_.slopes = (Eigen::MatrixXd(2, 3) << 1, 2, 3, 4, 5, 6).finished();
    modes_.file = "some \"folder\"/herd.modes";
    modes_.name = "herd";
  }

  DecodedScene Write(const PageScene& scene) const {
    WritePage(Path("page.html"), "<p><!-- scenes --></p>", {scene});
    return DecodedScene(ReadPage(Path("page.html"))[0].bytes);
  }

  void ExpectRefused(const std::function<void(PageModes*)>& change,
                     const std::string& part = "herd:") {
    PageModes modes = modes_;
    change(&modes);
    EXPECT_TRUE(Refuses<MeshError>([&] { MakePage("<!-- scenes -->", {modes}); }, {"herd:", part}));
  }

  PageModes modes_;
};

TEST_F(PageHeaderTest, ModesKeepEveryNumber) {
  modes_.vertex_colours = Eigen::MatrixXd::Constant(3, 8, 0.2);
  modes_.vertex_colours(2, 7) = 1;
  const DecodedScene scene = Write(modes_);
  const auto& header = scene.header;
  EXPECT_EQ(header["version"], 1);
  EXPECT_EQ(header["kind"], "modes");
  EXPECT_EQ(header["name"], "herd");
  EXPECT_EQ(header["vertices"], 8);
  EXPECT_EQ(header["triangles"], 12);
  EXPECT_EQ(header["segments"], 0);
  EXPECT_EQ(header["shapes"], 6);
  EXPECT_EQ(header["places"], (std::vector<double>{-2, 1.5}));
  EXPECT_EQ(header["pairPlace"], 0.75);
  EXPECT_EQ(header["error"], 0.0125);
  EXPECT_EQ(header["shares"], (std::vector<double>{0.7, 0.2}));
  EXPECT_EQ(header["names"], (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(header["coordinates"], (std::vector<std::vector<double>>{{1, 2}, {3, 4}, {5, 6}}));
  ASSERT_EQ(header["scalars"].size(), 3u);
  EXPECT_EQ(header["scalars"][1],
            (nlohmann::json{{"name", "mass"}, {"least", -1.0}, {"most", 2.0}, {"value", 0.5}}));
  EXPECT_EQ(header["intercept"], (std::vector<double>{0.25, -0.5}));
  EXPECT_EQ(header["slopes"], (std::vector<std::vector<double>>{{1, 4}, {2, 5}, {3, 6}}));
  EXPECT_EQ(header["file"], "some \"folder\"/herd.modes");
  EXPECT_EQ(header["up"], (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(static_cast<unsigned char>(scene.colours[0]), 51);
  EXPECT_EQ(static_cast<unsigned char>(scene.colours[23]), 255);
  // Every key is stored as its difference from the mean.
  const Eigen::MatrixXi mean = scene.steps[0];
  Eigen::Vector3d low = modes_.keys[0].rowwise().minCoeff();
  for (const Shape& key : modes_.keys) low = low.cwiseMin(key.rowwise().minCoeff());
  EXPECT_EQ(header["low"], (std::vector<double>{low.x(), low.y(), low.z()}));
  for (int k = 0; k < 6; ++k) {
    EXPECT_LE((scene.Shape(k) - modes_.keys[k]).cwiseAbs().maxCoeff(), 0.501 * scene.Step()) << k;
  }
}

TEST_F(PageHeaderTest, ModesThatDoNotFitAreRefused) {
  using M = PageModes;
  ExpectRefused([](M* m) { m->connectivity = nullptr; }, "numbers");
  ExpectRefused([](M* m) { m->shares.clear(); }, "numbers");
  ExpectRefused([](M* m) { m->places.clear(); }, "numbers");
  ExpectRefused([](M* m) { m->keys.pop_back(); }, "numbers");
  ExpectRefused([](M* m) { m->keys.push_back(m->keys[0]); }, "numbers");
  ExpectRefused([](M* m) { m->names.pop_back(); }, "numbers");
  ExpectRefused([](M* m) { m->coordinates.conservativeResize(3, 1); }, "numbers");
  ExpectRefused([](M* m) { m->intercept.resize(3); }, "numbers");
  ExpectRefused([](M* m) { m->slopes.conservativeResize(1, 3); }, "numbers");
  ExpectRefused([](M* m) { m->scalars.pop_back(); }, "numbers");
  ExpectRefused([](M* m) { m->keys[5].conservativeResize(3, 7); });
  ExpectRefused([](M* m) { m->keys[4](1, 7) = NAN; });
  ExpectRefused([](M* m) { m->vertex_colours.setConstant(2, 8, 0.5); }, "colours");
  ExpectRefused([](M* m) { m->vertex_colours.setConstant(3, 7, 0.5); }, "colours");
  ExpectRefused([](M* m) { m->vertex_colours.setConstant(3, 8, 1.1); }, "colours");
  ExpectRefused([](M* m) { m->vertex_colours.setConstant(3, 8, -0.1); }, "colours");
  // Without scalars there are no slopes.
  modes_.scalars.clear();
  modes_.intercept.resize(0);
  modes_.slopes.resize(0, 0);
  EXPECT_EQ(Write(modes_).header["scalars"].size(), 0u);
}

TEST_F(PageHeaderTest, SpacesThatDoNotFitAreRefused) {
  PageSpace good;
  good.connectivity = modes_.connectivity;
  good.nodes = {modes_.keys[0], modes_.keys[1], modes_.keys[2], modes_.keys[3]};
  good.names = {"a", "b", "c"};
  good.parents = {{0, 2}};
  good.points = (Eigen::Matrix2Xd(2, 4) << 0, 1, 0, 0, 0, 0, 2, 1).finished();
  good.segments = (Eigen::Matrix2Xi(2, 1) << 0, 3).finished();
  good.triangles = (Eigen::Matrix3Xi(3, 1) << 0, 1, 2).finished();
  good.name = "plane";
  EXPECT_EQ(Write(good).header["planeSegments"], (std::vector<std::vector<int>>{{0, 3}}));
  const auto refused = [&](const std::function<void(PageSpace*)>& change, const std::string& part) {
    PageSpace space = good;
    change(&space);
    EXPECT_TRUE(
        Refuses<MeshError>([&] { MakePage("<!-- scenes -->", {space}); }, {"plane:", part}));
  };
  const char numbers[] = "numbers";
  using S = PageSpace;
  refused([](S* s) { s->connectivity = nullptr; }, "shape");
  refused([](S* s) { s->nodes.clear(); }, "shape");
  refused([](S* s) { s->points.conservativeResize(2, 3); }, numbers);
  refused([](S* s) { s->parents.clear(); }, numbers);
  refused(
      [](S* s) {
        s->names.clear();
        s->parents.assign(4, {0, 0});
      },
      numbers);
  refused([](S* s) { s->points(1, 2) = NAN; }, "point");
  refused([](S* s) { s->triangles(2, 0) = 4; }, "triangles");
  refused([](S* s) { s->triangles(1, 0) = -1; }, "triangles");
  refused([](S* s) { s->segments(1, 0) = 4; }, "segments");
  refused([](S* s) { s->parents[0][1] = 3; }, "parents");
  refused([](S* s) { s->parents[0][0] = -1; }, "parents");
}

TEST_F(PageHeaderTest, PathsTellTheirTimesAndTheirView) {
  shapespace::Path path =
      testing::PathOf(modes_.connectivity, {modes_.keys[0], modes_.keys[1], modes_.keys[5]});
  path.parameters = {0, 0.25, 1};
  path.poses = {0, 2};
  path.smooth = true;
  const auto header = Write(PagePath{&path, "w\xff.path"}).header;
  EXPECT_EQ(header["version"], 1);
  EXPECT_EQ(header["kind"], "path");
  EXPECT_EQ(header["name"], "w\xef\xbf\xbd.path");
  EXPECT_EQ(header["parameters"], path.parameters);
  EXPECT_EQ(header["poses"], path.poses);
  EXPECT_EQ(header["smooth"], true);
  EXPECT_EQ(header["metric"], DescribeMetric(path.metric->options));
  EXPECT_EQ(header["colours"], false);
  const Eigen::Vector3d eye(header["eye"][0], header["eye"][1], header["eye"][2]);
  EXPECT_NEAR(eye.norm(), 1, 1e-12);
  path.shapes.resize(1);
  path.motions.resize(1);
  path.parameters.resize(1);
  path.poses = {0};
  EXPECT_TRUE(Write(PagePath{&path, "w"}).header["energyEnd"].is_null());
}

TEST_F(PageHeaderTest, AViewThatIsGivenIsThatOfThePage) {
  const PageMesh mesh{modes_.connectivity, modes_.keys[0], {}, "cube"};
  const auto header = [&](const PageScene& scene, const PageView& view) {
    WritePage(Path("page.html"), "<!-- scenes -->", {scene}, view);
    return DecodedScene(ReadPage(Path("page.html"))[0].bytes).header;
  };
  for (const PageScene& scene : {PageScene(mesh), PageScene(modes_)}) {
    const auto given = header(scene, {{-3, 0, 0}, {0, 0, -2}});
    EXPECT_EQ(given["up"], (std::vector<double>{-1, 0, 0}));
    EXPECT_EQ(given["eye"], (std::vector<double>{0, 0, -1}));
    // From above, y cannot point up.
    const auto from_above = header(scene, {{0, 0, 0}, {0, 1, 0}});
    EXPECT_EQ(from_above["eye"], (std::vector<double>{0, 1, 0}));
    EXPECT_EQ(from_above["up"][1], 0);
    const auto upright = header(scene, {{0, -1, 0}, {0, 0, 0}});
    EXPECT_EQ(upright["up"], (std::vector<double>{0, -1, 0}));
    EXPECT_LT(upright["eye"][1], 0);
  }
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { header(mesh, {{0, 1, 0}, {0, -2, 0}}); }, {"up"}));
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { header(mesh, {{NAN, 1, 0}, {0, 0, 0}}); }, {"up"}));
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { header(mesh, {{0, 1, 0}, {0, NAN, 0}}); }, {"eye"}));
}

TEST_F(PageHeaderTest, WhatStandsAroundTheScenesIsKept) {
  const PageGlb glb{"glTF", "a"};
  EXPECT_EQ(MakePage("<p>before<!-- scenes -->after</p>", {glb}),
            "<p>before<script type=\"model/gltf-binary\" data-scene data-name=\"a\">Z2xURg=="
            "</script>\nafter</p>");
  const auto message = [&](const std::string& page, const std::vector<PageScene>& scenes) {
    return MessageOf<InvalidOptions>([&] { MakePage(page, scenes); });
  };
  const std::string mark = "<!-- scenes -->";
  EXPECT_TRUE(Names(message(mark, {}), {"scenes:"}));
  EXPECT_TRUE(Names(message(mark, {glb, glb, glb}), {"scenes:"}));
  EXPECT_TRUE(Names(message(mark, {modes_, glb}), {"scenes:"}));
  EXPECT_TRUE(Names(message(mark, {glb, modes_}), {"scenes:"}));
  EXPECT_TRUE(Names(message(mark, {PageSpace(), glb}), {"scenes:"}));
  EXPECT_TRUE(Names(message(mark, {PageMesh(), glb}), {"scenes:"}));
  EXPECT_TRUE(Names(message(mark, {glb, PageMesh()}), {"scenes:"}));
  EXPECT_TRUE(Names(message("<p></p>", {glb}), {"page_template:"}));
  EXPECT_TRUE(Names(message(mark + mark, {glb}), {"page_template:"}));
  const PageMesh mesh{modes_.connectivity, modes_.keys[2], {}, "m"};
  EXPECT_TRUE(Refuses<MeshError>(
      [&] {
        MakePage(mark, {PageMesh{nullptr, {}, {}, "m"}});
      },
      {"m:"}));
  const std::string two = MakePage(mark, {mesh, mesh});
  EXPECT_NE(two.find("data-name=\"m\""), two.rfind("data-name=\"m\""));
}

}  // namespace
}  // namespace shapespace
