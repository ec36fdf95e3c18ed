#include "firmware_app/repair_station/input_learning.h"

#include <algorithm>

#include <fmt/format.h>
#include <linux/input-event-codes.h>

#include "hal/keyboards/buttons.h"

namespace pleinair::app {

const std::string& selectorOf(const hal::KeyboardDescription& device) {
  return device.id.empty() ? device.name : device.id;
}

bool isTouch(unsigned code) {
  return code >= BTN_DIGI && code < BTN_WHEEL;
}

InputLearning::InputLearning(std::vector<procedure::StepCommand> commands,
                             hal::KeyboardDevices& devices, const hal::Clock& clock)
    : commands_(std::move(commands)),
      clock_(clock),
      devices_(
          [this](const hal::KeyboardDescription& device) {
            known_.push_back(device);
            return std::optional(hal::InputDevices::Choice{.index = known_.size() - 1});
          },
          devices, clock) {}

std::vector<std::string> InputLearning::poll() {
  std::vector<std::string> lines;
  std::vector<std::pair<std::size_t, unsigned>> pressed;
  devices_.read([&](const hal::InputDevices::Open& device, const hal::KeyEvent& event) {
    if (event.value == 1 && !isTouch(event.code)) {
      pressed.emplace_back(device.choice.index, event.code);
    }
  });
  std::vector<hal::Error> problems;
  devices_.takeProblems(problems);
  for (const hal::Error& each : problems) lines.push_back(each.message());
  if (!since_) {
    ask(lines);
    pressed.clear();  // before anything was asked for
  }
  for (const auto& [device, code] : pressed) look(known_.at(device), code, lines);
  if (!isDone() && clock_.now() - *since_ >= kPatience) {
    lines.push_back(fmt::format("  no button for {}", textOf(commands_[asked_])));
    ++asked_;
    ask(lines);
  }
  return lines;
}

void InputLearning::look(const hal::KeyboardDescription& device, unsigned code,
                         std::vector<std::string>& lines) {
  if (isDone()) return;
  const std::string name = hal::buttonName(code);
  if (!used_.emplace(selectorOf(device), code).second) {
    lines.push_back(
        fmt::format("  {} of {} has a meaning already: another one", name, device.name));
    return;
  }
  mapped(device).buttons[code] = commands_[asked_];
  lines.push_back(fmt::format("  {} of {}: {}", name, device.name, textOf(commands_[asked_])));
  ++asked_;
  ask(lines);
}

MappedDevice& InputLearning::mapped(const hal::KeyboardDescription& device) {
  const auto known = std::ranges::find(map_.devices, selectorOf(device), &MappedDevice::device);
  if (known != map_.devices.end()) {
    // One node of a device may be a keyboard, and another none: its keys write elsewhere.
    known->grabs = known->grabs && !device.isKeyboard;
    return *known;
  }
  map_.devices.push_back({.device = selectorOf(device),
                          .label = device.name,
                          .grabs = !device.isKeyboard,
                          .buttons = {}});
  return map_.devices.back();
}

void InputLearning::ask(std::vector<std::string>& lines) {
  since_ = clock_.now();
  if (isDone()) return;
  lines.push_back(fmt::format("press the button for \"{}\" ({} s; none: wait)",
                              textOf(commands_[asked_]),
                              std::chrono::duration_cast<std::chrono::seconds>(kPatience).count()));
}

}  // namespace pleinair::app
