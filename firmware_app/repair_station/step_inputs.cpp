#include "firmware_app/repair_station/step_inputs.h"

#include <utility>

namespace pleinair::app {
namespace {

std::vector<hal::ButtonDevice> buttonDevicesOf(const InputMap& map) {
  std::vector<hal::ButtonDevice> devices;
  for (const MappedDevice& each : map.devices) {
    devices.push_back({.device = each.device, .grabs = each.grabs});
  }
  return devices;
}

}  // namespace

hal::Result<void> StepCommandQueue::put(procedure::StepCommand command) {
  const std::scoped_lock lock(mutex_);
  if (waiting_.size() >= kMaxWaiting) {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kBusy,
                                     .subject = "command",
                                     .problem = "too many commands wait",
                                     .remedy = "send it again later"});
  }
  waiting_.push_back(std::move(command));
  return {};
}

std::optional<procedure::StepCommand> StepCommandQueue::take() {
  const std::scoped_lock lock(mutex_);
  if (waiting_.empty()) return std::nullopt;
  procedure::StepCommand command = std::move(waiting_.front());
  waiting_.pop_front();
  return command;
}

StepInputs::StepInputs(InputMap map, hal::KeyboardDevices& devices, LiveProcedure& procedure,
                       StepCommandQueue* queue, const hal::Clock& clock)
    : map_(std::move(map)),
      procedure_(procedure),
      queue_(queue),
      buttons_(buttonDevicesOf(map_), devices, clock),
      cards_(map_.cards) {}

std::string StepInputs::nameOf(std::size_t device) const {
  const MappedDevice& mapped = map_.devices.at(device);
  return mapped.label.empty() ? mapped.device : mapped.label;
}

StepInputs::Taken StepInputs::poll() {
  pressed_.clear();
  buttons_.take(pressed_);
  for (const hal::ButtonPressed& each : pressed_) {
    const auto& buttons = map_.devices.at(each.device).buttons;
    if (const auto found = buttons.find(each.code); found != buttons.end()) {
      obey(found->second, nameOf(each.device));
    }
  }
  while (queue_ != nullptr && !procedure_.isBusy()) {
    const auto command = queue_->take();
    if (!command) break;
    obey(*command, std::string(notices().theServer));
  }
  buttons_.takeProblems(taken_.problems);
  std::vector<hal::InputDevices::Change> changes;
  buttons_.takeChanges(changes);
  for (const hal::InputDevices::Change& each : changes) {
    taken_.notices.push_back(procedure::filled(
        each.isThere ? notices().inputReady : notices().inputGone, nameOf(each.index)));
  }
  return std::exchange(taken_, {});
}

void StepInputs::see(std::span<const ShownTag> tags, hal::TimePoint captured) {
  if (std::exchange(seen_, captured) == captured) return;
  if (const auto command = cards_.see(tags, captured)) obey(*command, std::string(notices().aCard));
}

void StepInputs::obey(const procedure::StepCommand& command, const std::string& source) {
  taken_.any = true;
  if (command.kind == procedure::StepCommandKind::kRaw) {
    taken_.togglesRaw = !taken_.togglesRaw;
  } else {
    procedure_.obey(command, source);
  }
}

}  // namespace pleinair::app
