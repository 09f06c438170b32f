// All summaries, through the lists of their fields: what was not computed must not look like a
// result.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/correspondence/internal/summary_fields.h>
#include <shapespace/deformation/internal/summary_fields.h>
#include <shapespace/exploration/internal/summary_fields.h>
#include <shapespace/exponential/internal/summary_fields.h>
#include <shapespace/skinning/internal/summary_fields.h>
#include <shapespace/spline/internal/summary_fields.h>
#include <shapespace/statistics/internal/summary_fields.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/transfer/internal/summary_fields.h>

namespace shapespace {
namespace {

// Counts of what there is and of what was done: nothing, and so zero.
const std::set<std::string>& Counters() {
  static const std::set<std::string> counters = {
      // What there is.
      "vertices", "triangles", "edges", "hinges", "poses", "shapes", "nodes", "cells", "parts",
      "bones", "markers", "modes", "rank", "first_count", "second_count", "inner_shapes", "piece",
      "distance_vertices", "template_vertices", "template_triangles", "target_vertices",
      "target_triangles", "factor_nonzeros", "requested_steps", "threads", "processes",
      // What was done.
      "iterations", "evaluations", "increments", "krylov_iterations", "factorisations",
      "refinements", "rounds", "stress_iterations", "solved", "found", "damaged", "not_converged",
      "unconverged", "marked", "new_nodes"};
  return counters;
}

bool IsTimeOrMemory(const std::string& name) {
  const std::regex pattern("(.*_)?seconds|estimated_bytes");
  return std::regex_match(name, pattern);
}

class Visitor {
 public:
  std::set<std::string> types, counters;
  std::vector<std::string> wrong;

  template <typename T>
  void Visit(const std::string& type) {
    types.insert(type);
    const T summary;
    internal::ForFields(internal::Of<T>(), [&](const char* name, const auto& get) {
      Check(type + "." + name, name, std::invoke(get, summary));
    });
  }

 private:
  template <typename Value>
  void Check(const std::string& path, const std::string& name, const Value& value) {
    bool fine = true;
    if constexpr (std::is_same_v<Value, bool>) {
      // Whether it converged and is smooth; not whether a handle is hard or a row kept.
      fine = !value || name == "hard" || name == "kept";
    } else if constexpr (std::is_floating_point_v<Value>) {
      fine = std::isnan(value) || IsTimeOrMemory(name);
    } else if constexpr (std::is_integral_v<Value>) {
      fine = value == static_cast<Value>(-1) || Counters().count(name) > 0;
      if (value != static_cast<Value>(-1)) counters.insert(name);
    } else if constexpr (std::is_convertible_v<Value, std::string>) {
      fine = std::string(value).find("converged") != 0 && std::string(value) != "complete";
    } else if constexpr (std::is_enum_v<Value>) {
      const std::string word = internal::WordOf(value);
      fine = word != "converged" && word != "complete";
    } else if constexpr (!internal::HasFields<Value>::value) {
      fine = value.empty();
    }
    if (!fine) wrong.push_back(path);
  }
};

Visitor VisitAll() {
  Visitor visitor;
#define SHAPESPACE_VISIT(type) visitor.Visit<type>(#type)
  SHAPESPACE_VISIT(PathQuality);
  SHAPESPACE_VISIT(ShapeError);
  SHAPESPACE_VISIT(PathIntersections);
  SHAPESPACE_VISIT(GeodesicSummary);
  SHAPESPACE_VISIT(GeodesicSummary::Level);
  SHAPESPACE_VISIT(DeformationSummary);
  SHAPESPACE_VISIT(DeformationSummary::HandleResult);
  SHAPESPACE_VISIT(DeformationSummary::Level);
  SHAPESPACE_VISIT(RepairSummary);
  SHAPESPACE_VISIT(StandingSummary);
  SHAPESPACE_VISIT(ExponentialSummary);
  SHAPESPACE_VISIT(ExponentialSummary::Step);
  SHAPESPACE_VISIT(CorrectionSummary);
  SHAPESPACE_VISIT(TransportSummary);
  SHAPESPACE_VISIT(TransportSummary::Step);
  SHAPESPACE_VISIT(SkinningSummary);
  SHAPESPACE_VISIT(SplineSummary);
  SHAPESPACE_VISIT(ExploreSummary);
  SHAPESPACE_VISIT(ExploreSummary::Level);
  SHAPESPACE_VISIT(TransferSummary);
  SHAPESPACE_VISIT(TransferSummary::Step);
  SHAPESPACE_VISIT(PoseTransferSummary);
  SHAPESPACE_VISIT(CorrespondenceSummary);
  SHAPESPACE_VISIT(CorrespondenceSummary::Candidate);
  SHAPESPACE_VISIT(CorrespondenceSummary::PartInDoubt);
  SHAPESPACE_VISIT(CorrespondenceSummary::Stage);
  SHAPESPACE_VISIT(CorrespondenceSummary::Doubt);
  SHAPESPACE_VISIT(AverageSummary);
  SHAPESPACE_VISIT(ShapeModelSummary);
  SHAPESPACE_VISIT(ModelQuality);
  SHAPESPACE_VISIT(Assessment);
  SHAPESPACE_VISIT(Regression);
  SHAPESPACE_VISIT(GroupDifference);
#undef SHAPESPACE_VISIT
  return visitor;
}

TEST(Summaries, ShowNoResultBeforeThereIsOne) {
  const Visitor visitor = VisitAll();
  EXPECT_EQ(visitor.wrong, std::vector<std::string>());
  // The list of counters has no name that is not needed.
  EXPECT_EQ(visitor.counters, Counters());
}

// In the headers with lists of fields, so that a new summary cannot be forgotten.
TEST(Summaries, AreAllLookedAt) {
  const std::filesystem::path root = std::filesystem::path(SHAPESPACE_DOCS_DIR).parent_path();
  const std::regex list("ForFields\\(Of<([A-Za-z:]+)>");
  std::set<std::string> listed;
  for (const char* folder : {"lib", "solvers"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      if (entry.path().filename() != "summary_fields.h") continue;
      std::ifstream in(entry.path());
      const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
      for (std::sregex_iterator at(text.begin(), text.end(), list), end; at != end; ++at) {
        listed.insert((*at)[1]);
      }
    }
  }
  EXPECT_EQ(VisitAll().types, listed);
}

TEST(Summaries, WhatWasNotComputedIsNullInJson) {
  const auto json = internal::JsonOf(AverageSummary());
  for (const char* name : {"energy", "lower_bound", "ratio", "edge_rms"}) {
    EXPECT_TRUE(json[name].is_null()) << name;
  }
  EXPECT_TRUE(internal::JsonOf(GeodesicSummary())["ratio"].is_null());
}

}  // namespace
}  // namespace shapespace
