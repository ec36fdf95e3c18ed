#include "hal/keyboards/input_devices.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

namespace pleinair::hal {
namespace {

constexpr Duration kLookInterval = std::chrono::seconds(5);
/// Events that are read of a device at a time: one that floods must not hold the thread.
constexpr int kMaxEvents = 512;

}  // namespace

bool isNamed(const KeyboardDescription& device, const std::string& choice,
             KeyboardDevices& devices) {
  return choice == device.name || (!device.id.empty() && choice == device.id) ||
         devices.nodeOf(choice) == device.node;
}

InputDevices::InputDevices(Chooser chooser, KeyboardDevices& devices, const Clock& clock)
    : chooser_(std::move(chooser)), devices_(devices), clock_(clock) {}

void InputDevices::read(const Accept& accept) {
  if (hasChanged_.exchange(false) || clock_.now() - lookedAt_ >= kLookInterval) look();
  for (Open& each : open_) readDevice(each, accept);
  for (const Open& each : open_) {
    // One that was pulled out is no problem: it is found again.
    if (each.isGone) changes_.push_back({each.choice.index, each.name, false});
  }
  std::erase_if(open_, [](const Open& each) { return each.isGone; });
}

void InputDevices::look() {
  lookedAt_ = clock_.now();
  const std::vector<KeyboardDescription> there = devices_.list();
  std::erase_if(told_, [&](const std::string& node) {
    return std::ranges::find(there, node, &KeyboardDescription::node) == there.end();
  });
  for (const KeyboardDescription& each : there) {
    if (std::ranges::find(open_, each.node, &Open::node) != open_.end()) continue;
    if (const auto choice = chooser_(each)) openDevice(each, *choice);
  }
}

void InputDevices::openDevice(const KeyboardDescription& description, const Choice& choice) {
  Result<std::unique_ptr<KeyboardDevice>> device = devices_.open(description.node);
  if (!device) return tell(description.node, std::move(device.error()));
  if (choice.grabs && !isPaused_) {
    if (auto grabbed = (*device)->setGrabbed(true); !grabbed) {
      tell(description.node, std::move(grabbed.error()));
    }
  }
  open_.push_back({.node = description.node,
                   .name = description.name,
                   .choice = choice,
                   .device = *std::move(device),
                   .held = {}});
  changes_.push_back({choice.index, description.name, true});
}

void InputDevices::readDevice(Open& device, const Accept& accept) {
  for (int i = 0; i < kMaxEvents; ++i) {
    KeyEvent event;
    const Answer has = device.device->read(event);
    device.isGone = has.hasError();
    if (device.isGone || !has.isYes()) return;
    if (event.code >= device.held.size()) continue;
    device.held[event.code] = event.value != 0;
    accept(device, event);
  }
}

void InputDevices::setPaused(bool on) {
  if (std::exchange(isPaused_, on) == on) return;
  for (Open& each : open_) {
    if (!each.choice.grabs) continue;
    if (auto set = each.device->setGrabbed(!on); !set) tell(each.node, std::move(set.error()));
  }
}

void InputDevices::tell(const std::string& node, Error problem) {
  if (told_.insert(node).second) problems_.push_back(std::move(problem));
}

void InputDevices::takeProblems(std::vector<Error>& problems) {
  std::ranges::move(problems_, std::back_inserter(problems));
  problems_.clear();
}

void InputDevices::takeChanges(std::vector<Change>& changes) {
  std::ranges::move(changes_, std::back_inserter(changes));
  changes_.clear();
}

}  // namespace pleinair::hal
