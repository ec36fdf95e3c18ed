#include "pipeline/styles/plain/plain.h"

#include <cassert>
#include <memory>

namespace pleinair::styles {

const StyleKind& plainKind() {
  static const StyleKind kKind{
      .name = "none",
      .help = "the camera's picture with its virtual objects, unpainted",
      .defaults = config::ParameterValues(std::make_shared<const config::ParameterList>(
          std::vector<config::ParameterDescriptor>{})),
      .needs = {.shading = scene::Shading::kSmooth},
      .make = [](const gpu::ShaderLibrary&, SceneContents) -> std::unique_ptr<Style> {
        return std::make_unique<Plain>();
      }};
  return kKind;
}

const gpu::Texture& Plain::paint(const scene::ArFrame& frame,
                                 [[maybe_unused]] std::string_view view) {
  assert(view.empty());
  return *frame.colour;
}

}  // namespace pleinair::styles
