#include "hal/keyboards/keyboards.h"

#include <algorithm>
#include <utility>

#include "hal/keyboards/key_codes.h"

namespace pleinair::hal {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

InputDevices::Chooser chooserOf(KeyboardChoice choice, KeyboardDevices& devices) {
  return [choice = std::move(choice),
          &devices](const KeyboardDescription& description) -> std::optional<InputDevices::Choice> {
    const auto names = [&](const std::string& name) { return isNamed(description, name, devices); };
    if (std::ranges::any_of(choice.except, names)) return std::nullopt;
    const bool isChosen =
        (choice.all && description.isKeyboard) || std::ranges::any_of(choice.named, names);
    if (!isChosen) return std::nullopt;
    return InputDevices::Choice{.grabs = choice.grabs};
  };
}

}  // namespace

std::optional<KeyboardChoice> KeyboardChoice::parsed(std::string_view text) {
  constexpr std::size_t kMaxLength = 256;  // of a device's name, in the kernel
  if (text == "auto") return KeyboardChoice{};
  if (text == "none") return KeyboardChoice{.all = false};
  KeyboardChoice choice{.all = false};
  for (;;) {
    const std::size_t comma = std::min(text.find(','), text.size());
    const std::string_view name = trimmed(text.substr(0, comma));
    if (name.empty() || name.size() > kMaxLength) return std::nullopt;
    choice.named.emplace_back(name);
    if (comma == text.size()) return choice;
    text.remove_prefix(comma + 1);
  }
}

Keyboards::Keyboards(KeyboardChoice choice, KeyboardDevices& devices, const Clock& clock)
    : devices_(chooserOf(std::move(choice), devices), devices, clock) {}

void Keyboards::takeKeys(std::vector<KeyPressed>& keys) {
  devices_.read([&](const InputDevices::Open&, const KeyEvent& event) { accept(event, keys); });
}

void Keyboards::accept(const KeyEvent& event, std::vector<KeyPressed>& keys) {
  const bool isModifier = keyboards::modifierOf(event.code) != keyboards::Modifier::kNone;
  if (event.value == 0 || isModifier || devices_.isPaused() || keys.size() >= kMaxKeys) return;
  if (isHeld(false)) return;  // the console's
  const bool shift = isHeld(true);
  std::string name = keyboards::keyNameOf(event.code, shift);
  if (name.empty()) return;
  keys.push_back({.name = std::move(name), .shift = shift, .isRepeat = event.value == 2});
}

/// Whether Shift, or another modifier, is held on any keyboard.
bool Keyboards::isHeld(bool shift) const {
  const keyboards::Modifier wanted =
      shift ? keyboards::Modifier::kShift : keyboards::Modifier::kOther;
  for (const InputDevices::Open& each : devices_.open()) {
    for (std::size_t code = each.held._Find_first(); code < each.held.size();
         code = each.held._Find_next(code)) {
      if (keyboards::modifierOf(static_cast<unsigned>(code)) == wanted) return true;
    }
  }
  return false;
}

}  // namespace pleinair::hal
