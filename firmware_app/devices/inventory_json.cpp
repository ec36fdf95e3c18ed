#include <nlohmann/json.hpp>

#include "firmware_app/devices/inventory.h"

namespace pleinair::app {
namespace {

using Json = nlohmann::ordered_json;

Json problemOf(const std::optional<hal::Error>& problem) {
  return problem ? Json(problem->message()) : Json();
}

Json modeOf(const hal::CameraMode& mode) {
  Json rates = Json::array();
  for (const hal::Duration period : mode.periods) {
    if (period.count() > 0) rates.push_back(1e9 / static_cast<double>(period.count()));
  }
  return {{"layout", mode.layout},
          {"width", mode.size.width},
          {"height", mode.size.height},
          {"rates", std::move(rates)},
          {"read", mode.isSupported}};
}

Json chosenOf(const std::optional<hal::ChosenMode>& chosen) {
  if (!chosen) return {};
  Json json = modeOf(chosen->mode);
  json["rate"] = json["rates"].empty() ? Json() : json["rates"][0];
  json.erase("rates");
  json.erase("read");
  json["reason"] = chosen->reason;
  return json;
}

Json cameraOf(const hal::CameraDescription& camera) {
  Json formats = Json::array();
  for (const hal::CameraMode& mode : camera.modes) formats.push_back(modeOf(mode));
  return {{"backend", camera.identity.backend},
          {"id", camera.identity.id},
          {"name", camera.identity.description},
          {"serial", camera.serial},
          {"node", camera.node},
          {"formats", std::move(formats)},
          {"chosen", chosenOf(camera.chosen)},
          {"problem", problemOf(camera.problem)}};
}

Json outputOf(const std::string& kind, const hal::OutputDescription& output) {
  return {{"kind", kind},
          {"target", output.target},
          {"name", output.name},
          {"formats", output.formats},
          {"busy", output.isBusy},
          {"scan_out", output.scanOut.empty() ? Json() : Json(output.scanOut)},
          {"problem", problemOf(output.problem)}};
}

Json keyboardOf(const ListedKeyboard& keyboard) {
  return {{"node", keyboard.description.node},
          {"name", keyboard.description.name},
          {"keyboard", keyboard.description.isKeyboard},
          {"problem", problemOf(keyboard.problem)}};
}

template <class Items, class Make>
Json arrayOf(const Items& items, Make make) {
  Json array = Json::array();
  for (const auto& each : items) array.push_back(make(each));
  return array;
}

}  // namespace

std::string asJson(const Inventory& inventory) {
  Json outputs = Json::array();
  for (const KindOfOutputs& kind : inventory.outputs) {
    for (const hal::OutputDescription& each : kind.listing.outputs) {
      outputs.push_back(outputOf(kind.kind, each));
    }
  }
  const Json document{{"cameras", arrayOf(inventory.cameras.cameras, cameraOf)},
                      {"outputs", std::move(outputs)},
                      {"keyboards", arrayOf(inventory.keyboards, keyboardOf)},
                      {"problems", arrayOf(inventory.cameras.problems, [](const hal::Error& error) {
                         return error.message();
                       })}};
  // Replaces invalid UTF-8, since labels come from devices.
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace pleinair::app
