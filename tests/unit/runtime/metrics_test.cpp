#include "pipeline/runtime/status/metrics.h"

#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/runtime/outcome.h"

namespace pleinair::runtime {
namespace {

std::string textOfOperationGuide() {
  std::ifstream file(std::string(PLEINAIR_TESTS_DIR) + "/../docs/operation.md");
  EXPECT_TRUE(file);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string code(const std::string& text) {
  return text.empty() ? "" : "`" + text + "`";
}

/// "`output_ended_total{output,outcome}`".
std::string familyOf(const Metric& metric) {
  const std::string name = prometheusName(metric);
  if (name.empty()) return {};
  std::string labels;
  const auto add = [&](std::string_view label) {
    if (!labels.empty()) labels += ",";
    labels += label;
  };
  if (metric.scope == MetricScope::kOutput) add("output");
  if (!metric.label.empty()) add(metric.label);
  if (metric.type == MetricType::kState) add(metric.name);
  if (metric.type == MetricType::kSummary) add("quantile");
  return code(labels.empty() ? name : name + "{" + labels + "}");
}

/// The table of docs/operation.md as generated from the declarations.
std::string documentedTable() {
  std::string table =
      "| in `/status` | in `/metrics`, after `pleinair_` | type | what |\n|---|---|---|---|\n";
  for (const Metric& metric : allMetrics()) {
    std::string what(metric.help);
    if (!metric.formerly.empty()) what += " Replaces `" + std::string(metric.formerly) + "`.";
    std::string path = jsonPath(metric);
    if (!metric.label.empty()) path += ".<" + std::string(metric.label) + ">";
    table += "| " + code(path) + " | " + familyOf(metric) + " | " +
             std::string(toString(metric.type)) + " | " + what + " |\n";
  }
  return table;
}

TEST(MetricDeclarations, AreTheTableOfTheOperationGuide) {
  const std::string table = documentedTable();
  EXPECT_TRUE(textOfOperationGuide().find(table) != std::string::npos)
      << "docs/operation.md, \"Status over HTTP\", wants this table:\n\n"
      << table;
}

TEST(MetricDeclarations, NamesAreUniqueAndWhatPrometheusTakes) {
  static const std::regex kName("[a-z][a-z0-9_]*");
  std::set<std::string> paths;
  std::set<std::string> families;
  for (const Metric& metric : allMetrics()) {
    EXPECT_TRUE(paths.insert(jsonPath(metric)).second) << jsonPath(metric);
    EXPECT_TRUE(metric.help.ends_with(".")) << metric.help;
    ASSERT_NE(metric.read, nullptr);
    const std::string family = prometheusName(metric);
    EXPECT_EQ(family.empty(), metric.type == MetricType::kText) << metric.name;
    if (family.empty()) continue;
    EXPECT_TRUE(std::regex_match(family, kName)) << family;
    EXPECT_TRUE(families.insert(family).second) << family;
  }
  // A former name is never reused, because dashboards would show another metric under it.
  for (const Metric& metric : allMetrics()) {
    EXPECT_FALSE(families.contains(std::string(metric.formerly))) << metric.formerly;
  }
}

TEST(MetricDeclarations, GiveNamesByScopeUnitAndType) {
  const Metric latency{
      .scope = MetricScope::kPainting, .name = "latency", .unit = MetricUnit::kMilliseconds};
  EXPECT_EQ(jsonPath(latency), "painting.latency_ms");
  EXPECT_EQ(prometheusName(latency), "painting_latency_seconds");
  const Metric losses{
      .scope = MetricScope::kCamera, .name = "losses", .type = MetricType::kCounter};
  EXPECT_EQ(jsonPath(losses), "camera.losses");
  EXPECT_EQ(prometheusName(losses), "camera_losses_total");
}

TEST(Outcomes, AreTheTableOfTheOperationGuide) {
  const std::string guide = textOfOperationGuide();
  std::size_t at = guide.find("## What became of each frame");
  ASSERT_NE(at, std::string::npos);
  for (const Outcome outcome : allOutcomes()) {
    const std::string row = "\n| `" + std::string(nameOf(outcome)) + "` | ";
    const std::size_t found = guide.find(row, at);
    EXPECT_NE(found, std::string::npos) << "no row in this place: " << row;
    if (found != std::string::npos) at = found;
  }
}

}  // namespace
}  // namespace pleinair::runtime
