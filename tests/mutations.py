#!/usr/bin/env python3
"""Changes one line of the solvers at a time and looks whether a test notices.

Every mutation below takes out, or puts out of order, one special case or one term. It is applied to
a copy of the tree, which is built and tested; a mutation that no test notices is printed as
SURVIVED: the line then either needs a test or can go. Run it by hand, from a shell (a mutation takes
about a minute):

    tests/mutations.py            all mutations
    tests/mutations.py shooter    those whose file or text contains "shooter"
    tests/mutations.py --list     only lists them

Lines that only make a solve faster (schedules, tolerances of inner solvers, preconditioners) are not
in the list: no test is a stopwatch. Real meshes are not used: tests on bodies made in code are to
notice. Exit code 1 if more than one in twenty-five survives.
"""

import filecmp
import os
import re
import shutil
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
COPY = os.path.join(ROOT, "build", "mutations")
SOLVERS = "solvers/shapespace/"
EDGE_LENGTH = "lib/shapespace/metric/edge_length.cc"
DIHEDRAL = "lib/shapespace/metric/dihedral.cc"
FREEZE_LEVEL = "lib/shapespace/hierarchy/freeze_level.cc"

# The tests that each part of the solvers has, as filters of GoogleTest's.
GOING = "Exponential*:Extrapolate*:FirstIntegral*:Logarithm*:InitialVelocity*:Shooter*:Step*:*Continuation*:RoundTrip*:Inverse*"
GEODESICS = "Interpolate*:Schedule*:UnwrapHinges*:EnergyLowerBound*:Minimise*"
MINIMISING = "Minimise*:ThreadedLbfgs*:SearchLine*:ScalarMetric*:*Precond*:Cholesky*:ChangeOf*:Deform*:Repair*:Interpolate*"
CARRYING = "*Transport*:*Transfer*:Ladder*:FindNearest*:Step*"
CORRECTING = "Correct*"
HANDLES = "Deform*:Repair*:FreeEnd*:Screw*:Handle*"
EXPLORING = "*Test.*:-HandleFileTest*"
WEIGHTS = "MetricOptions*:FreezeMetric*:Interpolate*:EnergyLowerBound*"

# File, text (which must stand there once), what takes its place, and the tests that are to notice.
MUTATIONS = [
    # Going on from a path.
    ("exponential/internal/shooter.cc", "coarse.previous = restrict(initial_state.previous);",
     "if (initial_state.previous.size() > 0) coarse.previous = coarse.shape;", GOING),
    ("exponential/internal/step.cc", "if (speed_ <= rounding_) {", "if (speed_ <= 1e9 * rounding_) {", GOING),
    ("exponential/internal/step.cc", "if (speed_ <= rounding_) {", "if (speed_ < 0) {", GOING),
    ("exponential/internal/step.cc", "constexpr double kContraction = 0.5;",
     "constexpr double kContraction = 1e9;", GOING),
    ("exponential/internal/step.cc", "constexpr double kMinIncrement = 1.0 / 64;",
     "constexpr double kMinIncrement = 1;", GOING),
    ("exponential/internal/step.cc", "return agrees(speed_) && (initial_state_.speed == 0 || agrees(initial_state_.speed));",
     "return agrees(speed_) || true;", GOING),
    ("exponential/internal/step.cc", "Shape root = reached + expansion(next) - expansion(load);",
     "Shape root = expansion(next);", GOING),
    ("exponential/internal/step.cc", "std::max(options.tolerance, rounding_ / speed_)", "options.tolerance", GOING),
    ("exponential/exponential.cc", "metric->unit * (first.rotation * SegmentVelocity(",
     "metric->unit * (1.0 * SegmentVelocity(", GOING),
    ("exponential/exponential.cc", "if (row.inverted > kInvertedShare) {", "if (row.inverted > 1) {", GOING),
    ("exponential/exponential.cc", "if (now < kVanishedEdge * before) {", "if (now < 0 * before) {", GOING),
    ("exponential/exponential.cc", "constexpr double kRisen = 2;", "constexpr double kRisen = 1e9;", GOING),
    ("exponential/exponential.cc", "if (found > 0) velocity *= speed / found;", "if (found < 0) velocity *= speed;", GOING),
    ("exponential/exponential.cc", "initial_state = Restart(map, initial_state.shape, shape, initial_state.speed);",
     "initial_state.previous = std::exchange(initial_state.shape, shape);", GOING),
    ("exponential/exponential.cc", "if (discrete) scheme.Next(&unused);", "if (!discrete) scheme.Next(&unused);", GOING),
    # Geodesics.
    (FREEZE_LEVEL, "hierarchy.LevelConnectivity(level), poses, 1, pairs)",
     "hierarchy.LevelConnectivity(level), poses, 0, pairs)", GEODESICS),
    ("geodesic/geodesic.cc", "if (!(energy < GeodesicSummary::kZeroEnergy)) return false;",
     "if (energy >= 0) return false;", GEODESICS),
    ("geodesic/geodesic.cc", "if (options.schedule != GeodesicSchedule::kAutomatic || metric.options.bending > 0) {",
     "if (options.schedule != GeodesicSchedule::kAutomatic || metric.options.bending >= 0) {", GEODESICS),
    ("geodesic/internal/resolution.cc", "return std::pow((inner + 1.0) / (options.shapes + 1.0), 2);",
     "return inner + options.shapes > 0 ? 1 : 0;", GEODESICS),
    ("geodesic/internal/resolution.cc", "if (metric_->RigidInvariantButForPosition()) RemoveRigidDrift(shapes, metric_->vertex_area);\n\n",
     "\n", GEODESICS),
    ("geodesic/internal/geodesic_piece.cc", "constexpr double kEnough = 1.0 / 2048;", "constexpr double kEnough = 1;", GEODESICS),
    ("geodesic/internal/geodesic_piece.cc", "UnwrapHinges(*resolution.GetMetric(), &shapes);", "", GEODESICS),
    ("geodesic/internal/geodesic_piece.cc", "return {GeodesicStart::kBlend, GeodesicStart::kFirst, GeodesicStart::kLast};",
     "return {GeodesicStart::kBlend};", GEODESICS),
    ("geodesic/internal/geodesic_piece.cc", "attempt.energy < best.energy && !workload_.Stopped()",
     "attempt.energy > best.energy && !workload_.Stopped()", GEODESICS),
    ("geodesic/internal/schedule.cc", "constexpr int kShapesOnAllLevels = 7;", "constexpr int kShapesOnAllLevels = 1;", GEODESICS),
    ("geodesic/internal/unwrap_hinges.cc", "for (int v : vertices) mover.Move({v});", "", GEODESICS),
    ("geodesic/internal/unwrap_hinges.cc", "mover.Move({stencil(0), stencil(1), stencil(2), stencil(3)});", "", GEODESICS),
    ("geodesic/internal/unwrap_hinges.cc", "|| fastest > 2 * M_PI / segments;", "|| fastest > 7;", GEODESICS),
    ("geodesic/internal/unwrap_hinges.cc", "std::abs(WrapAngle(before - first)) + M_PI ||", "1e9 ||", GEODESICS),
    # Minimising.
    ("numerics/internal/minimise_threaded_lbfgs.cc", "fresh_change_ = end.slope - slope >= -kMinCurvature * slope;",
     "fresh_change_ = true;", MINIMISING),
    ("numerics/internal/minimise_threaded_lbfgs.cc", "if (small >= 2) return Termination::kConverged;",
     "if (small >= 1) return Termination::kConverged;", MINIMISING),
    ("numerics/internal/minimise_threaded_lbfgs.cc", "if (fresh_) return Termination::kStalled;", "return Termination::kStalled;", MINIMISING),
    ("numerics/internal/minimise_threaded_lbfgs.cc", "result_.remaining < kNothingLeft * options_.tolerance) {",
     "result_.remaining < 0) {", MINIMISING),
    ("numerics/internal/line_search.cc", "if ((decreases || equal) && std::isfinite(point.slope)) {",
     "if (decreases && std::isfinite(point.slope)) {", MINIMISING),
    ("numerics/internal/line_search.cc", "return low.step > 0 ? evaluate(low.step) : start;", "return start;",
     MINIMISING),
    ("numerics/internal/preconditioner.cc", "constexpr double kMinLambda = 1e-6;", "constexpr double kMinLambda = 0;", MINIMISING),
    ("exponential/internal/nearest_shape.cc", "constexpr int kMaxHalvings = 8;", "constexpr int kMaxHalvings = 0;", CARRYING),
    # Transport and transfer.
    ("exponential/transport.cc", "x = nearest - 0.5 * Solve(to, from->derivative.Times(there_and_back), size, row);",
     "x = nearest;", CARRYING),
    ("exponential/transport.cc", "for (Tangent& x : result.tangents) x = metric_transport->Turn() * x;", ";", CARRYING),
    ("transfer/internal/ladder.cc", "if (HasNoLength(rung)) return", "if (false) return", CARRYING),
    ("transfer/internal/ladder.cc", "if (!options_.align) TurnShapes(&rung.geodesic.path);", "", CARRYING),
    ("transfer/internal/feature_transfer.cc", "const double rounding = 1e3 *", "const double rounding = 0 *", CARRYING),
    ("transfer/internal/feature_transfer.cc", "if (std::abs(turn) == 0) continue;", "", CARRYING),
    ("transfer/internal/feature_transfer.cc", "change.segment(map_.FirstValue(i), placed.size()).setZero();", "", CARRYING),
    ("transfer/internal/gradient_transfer.cc", "constexpr double kSliver = 1e-2, kSmall = 1e-3;",
     "constexpr double kSliver = 0, kSmall = 1e-3;", CARRYING),
    ("transfer/internal/gradient_transfer.cc", "constexpr double kSliver = 1e-2, kSmall = 1e-3;",
     "constexpr double kSliver = 1e-2, kSmall = 0;", CARRYING),
    ("exponential/correction.cc", "options.mode == CorrectionMode::kPaper ? 3 : 2", "options.mode == CorrectionMode::kPaper ? 2 : 2", CORRECTING),
    ("exponential/correction.cc", "options.mode == CorrectionMode::kPaper ? 3 : 2", "options.mode == CorrectionMode::kPaper ? 3 : 1", CORRECTING),
    ("exponential/correction.cc", "if (before > kNoDeformation)", "if (before > 0)", CORRECTING),
    # Handles and repair.
    ("deformation/deformation.cc", "constexpr int kFollowSteps = 10;", "constexpr int kFollowSteps = 1;", HANDLES),
    ("deformation/deformation.cc", "constexpr double kLittle = 0.1;", "constexpr double kLittle = 1e9;", HANDLES),
    ("deformation/deformation.cc", "level.MoveComponents(places, &last.back());", "", HANDLES),
    ("deformation/repair.cc", "FitRigidMotion(reference, distorted, metric->vertex_area)(reference)", "reference", HANDLES),
    # Exploring.
    ("exploration/embedding.cc", "if (points(axis, farthest) < 0) points.row(axis) *= -1;", "", EXPLORING),
    ("exploration/internal/refinement.cc", "count_split(t) < 2) {", "true) {", EXPLORING),
    ("exploration/internal/pair_solver.cc", 'if (header.at("digest") != digest) return {};', "", EXPLORING),
    # The weights that solvers rely on.
    (DIHEDRAL, "area * kGreatestHingeAspect > squared_length ? squared_length / area : kGreatestHingeAspect;",
     "squared_length / area;", WEIGHTS),
    (EDGE_LENGTH, "basis.squared_length.array().max(least).square();",
     "basis.squared_length.array().max(0 * least).square();", WEIGHTS),
    (DIHEDRAL, "feature.weights(h) = basis.hinge_stiffness(h) * aspect / (1 + u * u * u * u);",
     "feature.weights(h) = basis.hinge_stiffness(h) * aspect;", WEIGHTS),
]

# Fifty wrong lines, spread over the folders in proportion to their lines, as someone could write them
# by mistake. All test programs are to notice.
LINES = [
    ("lib/shapespace/analysis/quality.cc", "t * WrapAngle(angle_n - angle_m)", "t * (angle_n - angle_m)"),
    ("lib/shapespace/analysis/rigid_parts.cc", "result(v) == RigidParts::kJoint || of_triangle(f) < result(v)",
     "result(v) == RigidParts::kJoint"),
    ("lib/shapespace/base/internal/json.cc", "std::max(begin, reached - 1)", "reached"),
    ("lib/shapespace/bodies/quadruped.cc", "std::clamp(value, kLeastMeasure, kGreatestMeasure)", "value"),
    ("lib/shapespace/bodies/tube.cc", "std::max(form.base_radius, form.tip_radius) + form.knuckle",
     "form.base_radius + form.knuckle"),
    ("lib/shapespace/files/internal/read_gltf.cc", "placement = OwnPlacement(model_.nodes[i]) * placement;",
     "placement = placement * OwnPlacement(model_.nodes[i]);"),
    ("lib/shapespace/files/internal/read_obj.cc", "++lines_read_;\n      end = EndOfLine(next);", "end = EndOfLine(next);"),
    ("lib/shapespace/files/internal/read_ply.cc", "return 65535;", "return 65536;"),
    ("lib/shapespace/files/internal/read_vtk.cc", "std::swap(connectivity_[last - 1], connectivity_[last]);",
     "std::swap(connectivity_[last - 2], connectivity_[last - 1]);"),
    ("lib/shapespace/hierarchy/internal/detail.cc", "s >= 0 && t >= 0 && s + t <= 1", "s >= 0 && t >= 0"),
    ("lib/shapespace/mesh/check_same_mesh.cc", "std::abs(scale) < std::log(kOtherUnits)", "scale < std::log(kOtherUnits)"),
    ("lib/shapespace/mesh/selection.cc", "(kind->names[index] != name && !HasWord(kind->names[index], name))",
     "kind->names[index] != name"),
    ("lib/shapespace/mesh/volume.cc", "std::min(std::abs(before), std::abs(after)) > kMinShare",
     "std::max(std::abs(before), std::abs(after)) > kMinShare"),
    ("lib/shapespace/metric/metric.cc",
     "if (options.weights == Weighting::kUniform) metric->rigid.weights.setConstant(options.rigid);", ";"),
    ("lib/shapespace/metric/metric_basis.cc", "(vertex_area(ends(0)) + vertex_area(ends(1))) / 6",
     "(vertex_area(ends(0)) + vertex_area(ends(1))) / 3"),
    ("lib/shapespace/output/gltf.cc", "duration - moments[i].first", "duration - moments[i - 1].first"),
    ("lib/shapespace/output/gltf.cc", "place = Eigen::Vector3d(place.x(), place.z(), -place.y());",
     "place = Eigen::Vector3d(place.x(), place.z(), place.y());"),
    ("lib/shapespace/output/internal/page_scene.cc", "speeds[i] /= time * time;", "speeds[i] /= time;"),
    ("lib/shapespace/output/picture.cc", "labels.push_back(options.labels[i]);",
     "labels.push_back(options.labels[labels.size()]);"),
    ("lib/shapespace/output/usd.cc", "static_cast<int>(path_.appearance.texture_coordinates.cols())",
     "static_cast<int>(path_.appearance.texture_coordinates.cols()) - 1"),
    ("lib/shapespace/path/anchor.cc", "3 * std::min(before, after)", "3 * std::max(before, after)"),
    ("lib/shapespace/path/path.cc", "ascending && k > 0 && i >= inner", "ascending && i >= inner"),
    ("lib/shapespace/path/path.cc", "if (!path.smooth) corners = path.poses;", "corners = path.poses;"),
    ("solvers/shapespace/contact/internal/motion_contact.cc",
     "std::max(GreatestNorm(from - from_), GreatestNorm(to - to_))", "GreatestNorm(from - from_)"),
    ("solvers/shapespace/correspondence/correspondence.cc", "map->gap(y) = 1;", ";"),
    ("solvers/shapespace/correspondence/internal/marker_check.cc",
     "k == marker || is_out[k] || !std::isfinite(distance)", "k == marker || !std::isfinite(distance)"),
    ("solvers/shapespace/correspondence/surface_map.cc",
     "covariance +=\n          points.barycentric(k, v) * turns[connectivity.Triangles()(k, points.triangle(v))];",
     "covariance += turns[connectivity.Triangles()(k, points.triangle(v))];"),
    ("solvers/shapespace/cost/tangent_projection.cc", "std::sqrt(feature->Weight(e))", "feature->Weight(e)"),
    ("solvers/shapespace/deformation/handle_file.cc",
     "selection.vertices[i].first > selection.vertices[i - 1].second",
     "selection.vertices[i].first > selection.vertices[i - 1].first"),
    ("solvers/shapespace/deformation/internal/handle_targets.cc", "std::abs(handle.motion.angle)", "handle.motion.angle"),
    ("solvers/shapespace/deformation/standing.cc", "stands_[0] || stands_[last - 1]", "stands_[0]"),
    ("solvers/shapespace/exploration/explore.cc", "summary->damaged += counts.damaged;",
     "summary->damaged = counts.damaged;"),
    ("solvers/shapespace/exploration/space.cc", "(triangles.cols() > 0 ? kRounding : kFlatSpread) * extent",
     "kRounding * extent"),
    ("solvers/shapespace/exponential/exponential.cc", "MeasureEdges(metric, path.shapes.front(), shape, &row);",
     "MeasureEdges(metric, start, shape, &row);"),
    ("solvers/shapespace/exponential/transport.cc", "Normal(i + 1)", "Normal(i)"),
    ("solvers/shapespace/geodesic/geodesic.cc", "MoveStraight(without_cost_, &shapes);", ";"),
    ("solvers/shapespace/geodesic/geodesic.cc",
     "summary.termination = std::max(summary.termination, level.termination);",
     "summary.termination = level.termination;"),
    ("solvers/shapespace/numerics/internal/gradient_integrator.cc", "is_loose(a) || is_loose(b)", "is_loose(a) && is_loose(b)"),
    ("solvers/shapespace/numerics/internal/minimise_lbfgs.cc", "summary.final_cost * unit", "summary.final_cost"),
    ("solvers/shapespace/numerics/internal/task_group.cc",
     "if (!first_error_) first_error_ = std::current_exception();", "first_error_ = std::current_exception();"),
    ("solvers/shapespace/spline/spline.cc", "times.back() - first", "times.back()"),
    ("solvers/shapespace/statistics/assess.cc",
     "if (!weights.empty()) weights.erase(weights.begin() + pose);",
     "if (!weights.empty()) weights.erase(weights.begin());"),
    ("solvers/shapespace/statistics/groups.cc", "static_cast<double>(as_distant) / (permutation.permutations + 1)",
     "static_cast<double>(as_distant - 1) / permutation.permutations"),
    ("solvers/shapespace/statistics/regression.cc", "WithoutColumn(design, s + 1)", "WithoutColumn(design, s)"),
    ("solvers/shapespace/transfer/transfer.cc", "size_ * turn", "1.0 * turn"),
    ("tools/shape_inspect.cc", "std::sort(stretch.begin(), stretch.end());", ";"),
    ("tools/shape_statistics.cc", "model.Sample(FLAGS_seed + i)", "model.Sample(FLAGS_seed)"),
    ("tools/support/files.cc", "FrameName(file, static_cast<int>(i))", "FrameName(file, 0)"),
    ("tools/support/outputs.cc", "labels[path.poses[i]] = given[i];", "labels[i] = given[i];"),
    ("tools/support/stdin_mesh.cc", "(content.size() - kHeader) % kTriangle == 0", "(content.size() - 80) % kTriangle == 0"),
]


def run(command, **more):
  return subprocess.run(command, cwd=COPY, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                        text=True, **more)


def copy_tree():
  tracked = subprocess.run(["git", "ls-files", "-z", "CMakeLists.txt", "cmake", "docs", "lib",
                            "solvers", "tests"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout
  for name in filter(None, tracked.split("\0")):
    source, copy = os.path.join(ROOT, name), os.path.join(COPY, name)
    if not os.path.exists(copy) or not filecmp.cmp(source, copy, shallow=False):
      os.makedirs(os.path.dirname(copy), exist_ok=True)
      shutil.copy(source, copy)
  configured = run(["cmake", "-B", "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                    "-DSHAPESPACE_BUILD_TOOLS=OFF", "-DSHAPESPACE_DATA_DIR="])
  if configured.returncode != 0:
    sys.exit(configured.stdout)


PROGRAMS = ["solvers/solvers_test", "solvers/exploration/exploration_test", "metric/metric_test"]


def build():
  return run(["cmake", "--build", "build", "--target"] + [os.path.basename(p) for p in PROGRAMS])


def failing_test(test_filter):
  """The first test that fails, or None."""
  for program in PROGRAMS:
    try:
      tested = run([os.path.join(COPY, "build", "tests", program), "--gtest_fail_fast",
                    "--gtest_filter=" + test_filter], timeout=900)
    except subprocess.TimeoutExpired:
      return program + " (never ends)"
    if tested.returncode != 0:
      found = re.search(r"\[  FAILED  \] (\S+)", tested.stdout)
      return found.group(1).rstrip(",") if found else program + " (crashes)"
  return None


def main():
  wanted = sys.argv[1] if len(sys.argv) > 1 else ""
  chosen = [m for m in MUTATIONS if wanted == "--list" or wanted in m[0] + m[1]]
  if wanted == "--list":
    for name, text, instead, tests in chosen:
      print(f"{name}: {text.strip()}  ->  {instead.strip()}  [{tests}]")
    return 0
  copy_tree()
  built = build()
  if built.returncode != 0:
    sys.exit(built.stdout[-3000:])
  for tests in sorted({m[3] for m in chosen}):
    fails = failing_test(tests)
    if fails:
      sys.exit(f"without any change fails {fails}")
  survived = 0
  for name, text, instead, tests in chosen:
    path = os.path.join(COPY, name if name.startswith("lib/") else SOLVERS + name)
    with open(path) as file:
      source = file.read()
    if source.count(text) != 1:
      sys.exit(f"{name}: this text stands there {source.count(text)} times, not once: {text}")
    with open(path, "w") as file:
      file.write(source.replace(text, instead))
    try:
      built = build()
      if built.returncode != 0:
        sys.exit(f"{name}: does not compile: {instead}\n" + built.stdout[-3000:])
      by = failing_test(tests)
    finally:
      with open(path, "w") as file:
        file.write(source)
    survived += by is None
    print(f"{'SURVIVED' if by is None else 'noticed '}  {name}: {instead.strip() or text.strip()}"
          f"{'' if by is None else '  by ' + by}", flush=True)
  print(f"{len(chosen) - survived} of {len(chosen)} noticed")
  return survived * 25 > len(chosen)


if __name__ == "__main__":
  sys.exit(main())
