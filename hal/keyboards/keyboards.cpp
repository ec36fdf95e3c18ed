#include "hal/keyboards/keyboards.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "hal/keyboards/key_codes.h"

namespace pleinair::hal {
namespace {

constexpr Duration kLookInterval = std::chrono::seconds(5);
/// Events that are read of a keyboard at a time: one that floods must not hold the thread.
constexpr int kMaxEvents = 512;

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
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
    : choice_(std::move(choice)), devices_(devices), clock_(clock) {}

void Keyboards::takeKeys(std::vector<KeyPressed>& keys) {
  if (hasChanged_.exchange(false) || clock_.now() - lookedAt_ >= kLookInterval) look();
  std::erase_if(open_, [&](Open& each) { return !read(each, keys); });
}

void Keyboards::look() {
  lookedAt_ = clock_.now();
  const std::vector<KeyboardDescription> there = devices_.list();
  std::erase_if(told_, [&](const std::string& node) {
    return std::ranges::find(there, node, &KeyboardDescription::node) == there.end();
  });
  for (const KeyboardDescription& each : there) {
    if (std::ranges::find(open_, each.node, &Open::node) == open_.end() && isChosen(each)) {
      open(each);
    }
  }
}

bool Keyboards::isChosen(const KeyboardDescription& description) const {
  if (choice_.all && description.isKeyboard) return true;
  return std::ranges::any_of(choice_.named, [&](const std::string& name) {
    return name == description.name || devices_.nodeOf(name) == description.node;
  });
}

void Keyboards::open(const KeyboardDescription& description) {
  Result<std::unique_ptr<KeyboardDevice>> device = devices_.open(description.node);
  if (!device) {
    tell(description.node, std::move(device.error()));
    return;
  }
  if (choice_.grabs && !isPaused_) {
    if (auto grabbed = (*device)->setGrabbed(true); !grabbed) {
      tell(description.node, std::move(grabbed.error()));
    }
  }
  open_.push_back({.node = description.node, .device = *std::move(device), .held = {}});
}

bool Keyboards::read(Open& keyboard, std::vector<KeyPressed>& keys) {
  for (int i = 0; i < kMaxEvents; ++i) {
    KeyEvent event;
    const Answer has = keyboard.device->read(event);
    // One that was pulled out is no problem: it is found again.
    if (has.hasError()) return false;
    if (!has.isYes()) break;
    accept(keyboard, event, keys);
  }
  return true;
}

void Keyboards::accept(Open& keyboard, const KeyEvent& event, std::vector<KeyPressed>& keys) {
  if (event.code >= keyboard.held.size()) return;
  const bool isRepeat = event.value == 2;
  keyboard.held[event.code] = event.value != 0;
  const bool isModifier = keyboards::modifierOf(event.code) != keyboards::Modifier::kNone;
  if (event.value == 0 || isModifier || isPaused_ || keys.size() >= kMaxKeys) return;
  if (isHeld(false)) return;  // the console's
  const bool shift = isHeld(true);
  std::string name = keyboards::keyNameOf(event.code, shift);
  if (name.empty()) return;
  keys.push_back({.name = std::move(name), .shift = shift, .isRepeat = isRepeat});
}

/// Whether Shift, or another modifier, is held on any keyboard.
bool Keyboards::isHeld(bool shift) const {
  const keyboards::Modifier wanted =
      shift ? keyboards::Modifier::kShift : keyboards::Modifier::kOther;
  for (const Open& each : open_) {
    for (std::size_t code = each.held._Find_first(); code < each.held.size();
         code = each.held._Find_next(code)) {
      if (keyboards::modifierOf(static_cast<unsigned>(code)) == wanted) return true;
    }
  }
  return false;
}

void Keyboards::setPaused(bool on) {
  if (std::exchange(isPaused_, on) == on || !choice_.grabs) return;
  for (Open& each : open_) {
    if (auto set = each.device->setGrabbed(!on); !set) tell(each.node, std::move(set.error()));
  }
}

void Keyboards::tell(const std::string& node, Error problem) {
  if (told_.insert(node).second) problems_.push_back(std::move(problem));
}

void Keyboards::takeProblems(std::vector<Error>& problems) {
  std::ranges::move(problems_, std::back_inserter(problems));
  problems_.clear();
}

}  // namespace pleinair::hal
