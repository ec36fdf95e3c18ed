#include "firmware_app/commands/styles.h"

#include <cstdio>
#include <string>

#include <fmt/format.h>

#include "pipeline/painter.h"
#include "pipeline/styles/style_registry.h"

namespace pleinair::app {
namespace {

/// Any size serves to ask a style what it has.
constexpr hal::FrameSize kSize{64, 64};

std::string describe(const styles::StyleInfo& info) {
  const Painter painter({.pictureSize = kSize, .style = std::string(info.name)});
  std::string text = fmt::format("{}: {}\n", info.name, info.help);
  text += "  parameters (--set NAME=VALUE)\n";
  const config::ParameterValues values = painter.defaultParameters().style;
  for (const config::ParameterDescriptor& parameter : values.list().descriptors()) {
    text += fmt::format("    {:<22} {:<8} {} {}\n", parameter.name, values.text(parameter.name),
                        parameter.allowed(), parameter.help);
  }
  text += "  views (--view NAME)\n";
  for (const PainterView& view : painter.views()) {
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
