#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hal/keyboards/keyboard_device.h"

namespace pleinair::support {

/// An input device: what happens to it is for the test to say, meanwhile.
struct FakeKeyboard {
  hal::KeyboardDescription description{
      .node = "/dev/input/event0", .name = "keyboard", .isKeyboard = true};
  std::deque<hal::KeyEvent> events;       ///< not read yet
  bool isGone = false;                    ///< pulled out
  std::optional<hal::ErrorKind> refusal;  ///< of open()
  bool isGrabbedByAnother = false;
  bool isGrabbed = false;
  int opened = 0;  ///< that are open now
  int opens = 0;   ///< attempts
};

/// A machine with input devices. One thread.
class FakeKeyboards final : public hal::KeyboardDevices {
 public:
  FakeKeyboard& add(hal::KeyboardDescription description) {
    FakeKeyboard& added = keyboards_[description.node];
    added = {};
    added.description = std::move(description);
    return added;
  }

  std::vector<hal::KeyboardDescription> list() override {
    std::vector<hal::KeyboardDescription> there;
    for (const auto& [node, each] : keyboards_) {
      if (!each.isGone) there.push_back(each.description);
    }
    return there;
  }
  std::string nodeOf(const std::string& path) override {
    const auto link = links.find(path);
    return link == links.end() ? path : link->second;
  }
  hal::Result<std::unique_ptr<hal::KeyboardDevice>> open(const std::string& node) override {
    FakeKeyboard& keyboard = keyboards_.at(node);
    ++keyboard.opens;
    if (keyboard.isGone) return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kNotFound});
    if (keyboard.refusal) {
      return tl::unexpected(hal::Error{.kind = *keyboard.refusal, .subject = node});
    }
    return std::make_unique<Device>(keyboard);
  }

  std::map<std::string, std::string> links;

 private:
  class Device final : public hal::KeyboardDevice {
   public:
    explicit Device(FakeKeyboard& keyboard) : keyboard_(keyboard) { ++keyboard_.opened; }
    ~Device() override { --keyboard_.opened; }

    hal::Answer read(hal::KeyEvent& event) override {
      if (keyboard_.isGone) return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kDeviceLost});
      if (keyboard_.events.empty()) return false;
      event = keyboard_.events.front();
      keyboard_.events.pop_front();
      return true;
    }
    hal::Result<void> setGrabbed(bool on) override {
      if (on && keyboard_.isGrabbedByAnother) {
        return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kBusy});
      }
      keyboard_.isGrabbed = on;
      return {};
    }

   private:
    FakeKeyboard& keyboard_;
  };
  std::map<std::string, FakeKeyboard> keyboards_;
};

}  // namespace pleinair::support
