#include "hal/outputs/display/modeset.h"

#include <string_view>

namespace pleinair::hal::display {
namespace {

void add(std::vector<Change>& changes, ObjectId object, const std::vector<Property>& properties,
         std::string_view name, std::uint64_t value) {
  if (const Property* property = find(properties, name)) {
    changes.push_back({object, property->id, value});
  }
}

}  // namespace

std::vector<Change> modesetChanges(const DisplayRoute& route, ObjectId modeBlob,
                                   ObjectId framebuffer, CanvasOffset offset) {
  const FrameSize size = route.mode.size;
  const auto width = static_cast<std::uint64_t>(size.width);
  const auto height = static_cast<std::uint64_t>(size.height);
  const Connector& connector = route.connector;
  const Crtc& crtc = route.crtc;
  const Plane& plane = route.plane;
  std::vector<Change> changes;
  add(changes, connector.id, connector.properties, "CRTC_ID", crtc.id);
  add(changes, crtc.id, crtc.properties, "MODE_ID", modeBlob);
  add(changes, crtc.id, crtc.properties, "ACTIVE", 1);
  const auto addToPlane = [&](std::string_view name, std::uint64_t value) {
    add(changes, plane.id, plane.properties, name, value);
  };
  addToPlane("FB_ID", framebuffer);
  addToPlane("CRTC_ID", crtc.id);
  addToPlane("rotation", 1);  // none, whatever another program left
  addToPlane("SRC_X", sourcePlace(offset.x));
  addToPlane("SRC_Y", sourcePlace(offset.y));
  addToPlane("SRC_W", sourcePlace(size.width));
  addToPlane("SRC_H", sourcePlace(size.height));
  addToPlane("CRTC_X", 0);
  addToPlane("CRTC_Y", 0);
  addToPlane("CRTC_W", width);
  addToPlane("CRTC_H", height);
  return changes;
}

std::vector<Change> switchOffChanges(const DisplayRoute& route) {
  std::vector<Change> changes;
  add(changes, route.crtc.id, route.crtc.properties, "ACTIVE", 0);
  return changes;
}

}  // namespace pleinair::hal::display
