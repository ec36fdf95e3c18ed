#include "pipeline/styles/plain.h"

#include <cassert>
#include <memory>

namespace pleinair::styles {

config::ParameterValues plainParameters() {
  static const auto kNone =
      std::make_shared<const config::ParameterList>(std::vector<config::ParameterDescriptor>{});
  return config::ParameterValues(kNone);
}

const gpu::Texture& Plain::paint(const scene::ArFrame& frame, std::string_view view,
                                 gpu::PassTimer& /*timer*/) {
  assert(view.empty());
  return *frame.colour;
}

}  // namespace pleinair::styles
