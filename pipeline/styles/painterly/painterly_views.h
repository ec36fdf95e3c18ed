#pragma once

#include <span>
#include <string_view>

#include <glm/vec3.hpp>

#include "pipeline/styles/style.h"

namespace pleinair::styles {

inline constexpr std::string_view kTensorsView = "tensors";
inline constexpr std::string_view kPyramidView = "pyramid";
inline constexpr std::string_view kRegionsView = "regions";
inline constexpr std::string_view kLayersView = "layers";
inline constexpr std::string_view kSkeletonsView = "skeletons";
inline constexpr std::string_view kAnchorsView = "anchors";
inline constexpr std::string_view kHeightView = "height";

/// The style's inner pictures, apart from the finished one.
std::span<const DebugViewInfo> painterlyViews();

/// In which strokes are shown that are `part` of the way from the coarsest layer, 0, to the finest.
glm::vec3 layerColour(float part);

}  // namespace pleinair::styles
