#include "firmware_app/commands/styles.h"

#include <fmt/format.h>

#include "pipeline/painter.h"
#include "pipeline/styles/style_registry.h"

namespace pleinair::app {
namespace {

/// Any size serves to ask a style what it has.
constexpr hal::FrameSize kSize{64, 64};

void list(const styles::StyleInfo& info) {
  const Painter painter({.pictureSize = kSize, .style = std::string(info.name)});
  fmt::print("{}: {}\n", info.name, info.help);
  fmt::print("  parameters (--set NAME=VALUE)\n");
  const config::ParameterValues values = painter.defaultParameters().style;
  for (const config::ParameterDescriptor& parameter : values.list().descriptors()) {
    fmt::print("    {:<22} {:<8} {} {}\n", parameter.name, values.text(parameter.name),
               parameter.allowed(), parameter.help);
  }
  fmt::print("  views (--view NAME)\n");
  for (const PainterView& view : painter.views()) {
    fmt::print("    {:<22} {}\n", view.name, view.help);
  }
}

}  // namespace

int listStyles() {
  for (const styles::StyleInfo& info : styles::styleInfos()) list(info);
  return 0;
}

}  // namespace pleinair::app
