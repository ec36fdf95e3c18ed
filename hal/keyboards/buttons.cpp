#include "hal/keyboards/buttons.h"

#include <charconv>
#include <system_error>
#include <utility>

namespace pleinair::hal {
namespace {

InputDevices::Chooser buttonChooser(const std::vector<ButtonDevice>& chosen,
                                    KeyboardDevices& devices) {
  return [&chosen,
          &devices](const KeyboardDescription& description) -> std::optional<InputDevices::Choice> {
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (isNamed(description, chosen[i].device, devices)) {
        return InputDevices::Choice{.index = i, .grabs = chosen[i].grabs};
      }
    }
    return std::nullopt;
  };
}

}  // namespace

Buttons::Buttons(std::vector<ButtonDevice> chosen, KeyboardDevices& devices, const Clock& clock)
    : chosen_(std::move(chosen)), devices_(buttonChooser(chosen_, devices), devices, clock) {}

void Buttons::take(std::vector<ButtonPressed>& pressed) {
  devices_.read([&](const InputDevices::Open& device, const KeyEvent& event) {
    if (event.value != 1 || devices_.isPaused() || pressed.size() >= kMaxPressed) return;
    pressed.push_back({.device = device.choice.index, .code = event.code});
  });
}

std::optional<unsigned> buttonNumbered(const std::string& text) {
  constexpr unsigned kCodes = 768;
  unsigned code = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, code);
  if (read.ec != std::errc() || read.ptr != end || code >= kCodes) return std::nullopt;
  return code;
}

}  // namespace pleinair::hal
