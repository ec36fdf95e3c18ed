#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "firmware_app/cli/text_table.h"
#include "firmware_app/commands/commands.h"
#include "pipeline/engine/painter.h"
#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

/// A heading and its rows in columns; empty without rows.
std::string section(const std::string& heading, const std::vector<TextRow>& rows) {
  return rows.empty() ? "" : "  " + heading + "\n" + textTable(rows);
}

std::string describe(const styles::StyleKind& info) {
  std::vector<TextRow> looks;
  for (const styles::Look& look : info.looks) {
    looks.push_back({std::string(look.name), std::string(look.help)});
  }
  std::vector<TextRow> parameters;
  for (const config::ParameterDescriptor& each : info.defaults.list().descriptors()) {
    parameters.push_back({each.name, fmt::format("{} ({}; {})", each.help,
                                                 info.defaults.text(each.name), each.allowed())});
  }
  std::vector<TextRow> views;
  for (const DebugView& view : debugViewsOf(info.name)) views.push_back({view.name, view.help});
  return fmt::format("{}: {}\n", info.name, info.help) + section("looks (--look NAME)", looks) +
         section("parameters (--set NAME=VALUE), with defaults and allowed values", parameters) +
         section("debug views (--view NAME)", views);
}

}  // namespace

int listStyles() {
  // Write errors are checked once, at the end of the program.
  std::string text;
  for (const styles::StyleKind* kind : styles::styleKinds()) {
    text += (text.empty() ? "" : "\n") + describe(*kind);
  }
  std::fputs(text.c_str(), stdout);
  return 0;
}

}  // namespace pleinair::app
