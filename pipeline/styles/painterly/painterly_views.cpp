#include "pipeline/styles/painterly/painterly_views.h"

#include <array>

#include <glm/common.hpp>

namespace pleinair::styles {
namespace {

constexpr std::array<DebugViewInfo, 7> kViews{{
    {kTensorsView, "the tensor field: which way strokes go; blue from edges, red filled in"},
    {kPyramidView, "four levels of its pyramid"},
    {kRegionsView, "what is painted finely (red), middlingly (yellow) and broadly (blue)"},
    {kLayersView, "strokes in their layer's colour"},
    {kSkeletonsView, "the strokes' skeletons in their layer's colour"},
    {kAnchorsView, "the strokes' anchors: red ones are young"},
    {kHeightView, "how thick the paint lies"},
}};

}  // namespace

std::span<const DebugViewInfo> painterlyViews() {
  return kViews;
}

glm::vec3 layerColour(float part) {
  constexpr glm::vec3 kCoarse{0.3F, 0.45F, 0.8F};
  constexpr glm::vec3 kMiddle{0.95F, 0.8F, 0.3F};
  constexpr glm::vec3 kFine{0.9F, 0.3F, 0.2F};
  return part < 0.5F ? glm::mix(kCoarse, kMiddle, 2.0F * part)
                     : glm::mix(kMiddle, kFine, 2.0F * part - 1.0F);
}

}  // namespace pleinair::styles
