#pragma once

#include <string_view>

namespace pleinair {

// The views that the engine paints itself, beside scene::bufferViews().
inline constexpr std::string_view kCameraView = "camera";
inline constexpr std::string_view kArView = "ar";

/// Whether the engine paints this view, not the style.
bool isEngineView(std::string_view view);

}  // namespace pleinair
