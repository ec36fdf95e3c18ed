#include "pipeline/styles/painterly/painterly_views.h"

#include <array>

#include <glm/common.hpp>

namespace pleinair::styles {
namespace {

struct View {
  DebugViewInfo info;
  PainterlyViewer viewer{};
};

constexpr std::array kViews{
    View{{"tensors", "the tensor field: which way strokes go; blue from edges, red filled in"},
         PainterlyViewer::kField},
    View{{"pyramid", "four levels of its pyramid"}, PainterlyViewer::kField},
    View{{"regions", "what is painted finely (red), middlingly (yellow) and broadly (blue)"},
         PainterlyViewer::kField},
    View{{"focus", "how finely a place may be painted: dark where only broad strokes are"},
         PainterlyViewer::kField},
    View{{"layers", "strokes in their layer's colour"}, PainterlyViewer::kStrokes},
    View{{"skeletons", "the strokes' skeletons in their layer's colour"},
         PainterlyViewer::kStrokes},
    View{{"anchors", "the strokes' anchors: red ones are young"}, PainterlyViewer::kStrokes},
    View{{"movers",
          "what moves by itself: red where it is sure (the second mover green, the third blue), "
          "pale "
          "where it is not yet, violet where it rests; yellow: just changed; blue: the background "
          "is hardly known"},
         PainterlyViewer::kMovers},
    View{{"background", "the background as it is remembered; black: never seen"},
         PainterlyViewer::kMovers},
    View{{"segments", "the camera image's segments, in colours of their own; grey: none"},
         PainterlyViewer::kSegments},
    View{{"features", "the camera image's features (rings), and whence they came (lines)"},
         PainterlyViewer::kFeatures},
    View{{"height", "how thick the paint lies"}, PainterlyViewer::kHeight},
};

constexpr auto kInfos = [] {
  std::array<DebugViewInfo, kViews.size()> infos;
  for (std::size_t i = 0; i < infos.size(); ++i) infos[i] = kViews[i].info;
  return infos;
}();

}  // namespace

std::span<const DebugViewInfo> painterlyViews() {
  return kInfos;
}

PainterlyViewer viewerOf(std::size_t viewIndex) {
  return kViews.at(viewIndex).viewer;
}

glm::vec3 layerColour(float part) {
  constexpr glm::vec3 kCoarse{0.3F, 0.45F, 0.8F};
  constexpr glm::vec3 kMiddle{0.95F, 0.8F, 0.3F};
  constexpr glm::vec3 kFine{0.9F, 0.3F, 0.2F};
  return part < 0.5F ? glm::mix(kCoarse, kMiddle, 2.0F * part)
                     : glm::mix(kMiddle, kFine, 2.0F * part - 1.0F);
}

}  // namespace pleinair::styles
