#include "pipeline/engine/debug_views.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "config/suggestion.h"
#include "hal/error.h"
#include "pipeline/engine/painter.h"
#include "pipeline/scene/render/buffer_views.h"
#include "pipeline/styles/registry.h"

namespace pleinair {

bool isEngineView(std::string_view view) {
  return view == kCameraView || view == kArView || scene::findBufferView(view) != nullptr;
}

std::vector<DebugView> debugViewsOf(std::string_view style) {
  std::vector<DebugView> views{
      {std::string(kCameraView), "what the camera shows, at the picture's size"},
      {std::string(kArView), "the camera's picture with the models in it, before the style"}};
  for (const scene::BufferView& view : scene::bufferViews()) {
    views.push_back({std::string(view.name), std::string(view.help)});
  }
  for (const styles::DebugViewInfo& view : styles::styleKind(style).views) {
    views.push_back({std::string(view.name), std::string(view.help)});
  }
  return views;
}

hal::Result<void> checkDebugView(std::string_view style, std::string_view view) {
  if (view.empty() || isEngineView(view)) return {};
  const auto ofStyle = styles::styleKind(style).views;
  if (std::ranges::find(ofStyle, view, &styles::DebugViewInfo::name) != ofStyle.end()) return {};
  std::vector<std::string> names;
  for (DebugView& each : debugViewsOf(style)) names.push_back(std::move(each.name));
  return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                                   .subject = fmt::format("view \"{}\"", view),
                                   .problem = config::unknownText("view", view, names),
                                   .remedy = "choose one of: " + config::listText(names)});
}

}  // namespace pleinair
