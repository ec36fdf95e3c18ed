#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include <glm/vec3.hpp>

#include "pipeline/styles/debug_views.h"

namespace pleinair::styles {

/// The style's inner pictures, apart from the finished one.
std::span<const DebugViewInfo> painterlyViews();

/// The program that shows a view. It gets the view's number, which its shader compares with
/// `VIEW_NAME` (viewDefines()).
enum class PainterlyViewer {
  kField,     ///< shaders/field_view.frag
  kStrokes,   ///< shaders/stroke_view.frag, over a pale picture
  kMovers,    ///< shaders/mover_view.frag
  kSegments,  ///< shaders/segment_view.frag
  kFeatures,  ///< shaders/feature_view.frag
  kHeight,    ///< shaders/height_view.frag, once the strokes are painted
};
PainterlyViewer viewerOf(std::size_t viewIndex);

/// In which strokes are shown that are `part` of the way from the coarsest layer, 0, to the finest.
glm::vec3 layerColour(float part);

}  // namespace pleinair::styles
