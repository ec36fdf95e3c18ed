#include "firmware_app/commands/styles.h"

#include <cstdio>
#include <string>

#include <fmt/format.h>

#include "pipeline/painter.h"
#include "pipeline/styles/style_registry.h"

namespace pleinair::app {
namespace {

std::string describe(const styles::StyleInfo& info) {
  std::string text = fmt::format("{}: {}\n", info.name, info.help);
  if (!info.looks.empty()) text += "  looks (--look NAME)\n";
  for (const styles::Look& look : info.looks) {
    text += fmt::format("    {:<22} {}\n", look.name, look.help);
  }
  const auto parameters = info.defaults.list().descriptors();
  if (!parameters.empty()) text += "  parameters (--set NAME=VALUE)\n";
  for (const config::ParameterDescriptor& parameter : parameters) {
    text += fmt::format("    {:<22} {:<8} {} {}\n", parameter.name,
                        info.defaults.text(parameter.name), parameter.allowed(), parameter.help);
  }
  text += "  views (--view NAME)\n";
  for (const PainterView& view : viewsOf(info.name)) {
    text += fmt::format("    {:<22} {}\n", view.name, view.help);
  }
  return text;
}

}  // namespace

int listStyles() {
  // Whether it arrived is looked at once, at the program's end.
  for (const styles::StyleInfo& info : styles::styleInfos()) {
    std::fputs(describe(info).c_str(), stdout);
  }
  return 0;
}

}  // namespace pleinair::app
