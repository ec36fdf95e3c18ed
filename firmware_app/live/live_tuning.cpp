#include "firmware_app/live/live_tuning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "firmware_app/live/parameter_step.h"

namespace pleinair::app {
namespace {

using config::ParameterDescriptor;
using config::ParameterKind;

constexpr const char* kOrigin = "a key";

std::size_t around(std::size_t index, int direction, std::size_t count) {
  return (index + (direction > 0 ? 1 : count - 1)) % count;
}

/// "4 to 64", or the full description of a range that is not closed and finite.
std::string rangeText(const ParameterDescriptor& parameter) {
  const config::NumberRange& numbers = parameter.numberRange;
  const bool isPlain =
      std::isfinite(numbers.max - numbers.min) && !numbers.minOpen && !numbers.maxOpen;
  if (parameter.kind() == ParameterKind::kNumber && isPlain) {
    return fmt::format("{} to {}", numbers.min, numbers.max);
  }
  if (parameter.kind() == ParameterKind::kInteger) {
    return fmt::format("{} to {}", parameter.integerRange.min, parameter.integerRange.max);
  }
  return parameter.allowed();
}

}  // namespace

LiveTuning::LiveTuning(std::string style, PaintParameters start,
                       const std::vector<DebugView>& views, std::vector<LiveLook> looks)
    : style_(std::move(style)),
      parameters_(std::move(start)),
      views_{std::string()},
      looks_(std::move(looks)) {
  for (const DebugView& view : views) views_.push_back(view.name);
  const auto current = std::ranges::find(looks_, parameters_.style, &LiveLook::values);
  if (current != looks_.end()) look_ = static_cast<std::size_t>(current - looks_.begin());
  const auto descriptors = parameters_.style.list().descriptors();
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    if (descriptors[i].takesEffect == config::TakesEffect::kLive) tunable_.push_back(i);
  }
}

LiveTuning::Request LiveTuning::press(const hal::KeyPressed& key) {
  if (pressHeld(key)) return Request::kNone;
  // A held key must not toggle these repeatedly.
  return key.isRepeat ? Request::kUnknownKey : pressOnce(key);
}

/// Handles the keys that repeat while they are held; returns whether this is one.
bool LiveTuning::pressHeld(const hal::KeyPressed& key) {
  if (key.name == "tab") {
    choose(key.shift ? -1 : 1);
  } else if (key.name == "down" || key.name == "up") {
    choose(key.name == "down" ? 1 : -1);
  } else if (key.name == "left" || key.name == "right") {
    change(key.name == "right" ? 1 : -1, key.shift);
  } else {
    return false;
  }
  return true;
}

LiveTuning::Request LiveTuning::pressOnce(const hal::KeyPressed& key) {
  if (key.name == "q" || key.name == "escape") return Request::kQuit;
  if (key.name == "s") return Request::kSnapshot;
  if (key.name == "f") return Request::kFullScreen;
  if (key.name == "backspace") {
    resetParameter();
  } else if (key.name == "v") {
    cycleView(key.shift ? -1 : 1);
  } else if (key.name == "l") {
    cycleLook(key.shift ? -1 : 1);
  } else if (key.name == "space") {
    isPaused_ = !isPaused_;
  } else if (key.name == "h" || key.name == "?" || key.name == "f1") {
    showsHelp_ = !showsHelp_;
  } else {
    return Request::kUnknownKey;
  }
  return Request::kNone;
}

void LiveTuning::choose(int direction) {
  if (!tunable_.empty()) chosen_ = around(chosen_, direction, tunable_.size());
}

void LiveTuning::change(int direction, bool large) {
  if (tunable_.empty()) return;
  const std::size_t index = tunable_[chosen_];
  const ParameterDescriptor& parameter = parameters_.style.list().descriptors()[index];
  const auto next = stepped(parameter, parameters_.style.at(index), direction, large);
  if (next) parameters_.style = parameters_.style.with(index, *next, kOrigin);
}

/// Resets to the look's value, or to the style's default if no look is chosen.
void LiveTuning::resetParameter() {
  if (tunable_.empty()) return;
  const std::size_t index = tunable_[chosen_];
  const config::ParameterValue& value =
      look_ ? looks_[*look_].values.at(index)
            : parameters_.style.list().descriptors()[index].defaultValue;
  parameters_.style = parameters_.style.with(index, value, kOrigin);
}

void LiveTuning::cycleView(int direction) {
  const auto shown = std::ranges::find(views_, parameters_.view);
  const auto index = static_cast<std::size_t>(shown - views_.begin());
  parameters_.view = views_.at(around(index, direction, views_.size()));
}

void LiveTuning::cycleLook(int direction) {
  if (looks_.empty()) return;
  const std::size_t before = direction > 0 ? looks_.size() - 1 : 0;
  look_ = around(look_.value_or(before), direction, looks_.size());
  parameters_.style = looks_[*look_].values;
}

std::string LiveTuning::state() const {
  std::string text = style_;
  if (look_) {
    const bool isChanged = !(looks_[*look_].values == parameters_.style);
    text += fmt::format(" · {}{}", looks_[*look_].name, isChanged ? ", changed" : "");
  }
  if (!parameters_.view.empty()) text += " · view " + parameters_.view;
  if (isPaused_) text += " · paused";
  return text;
}

std::string LiveTuning::parameterLine() const {
  if (tunable_.empty()) return fmt::format("{} has nothing to tune", style_);
  const std::size_t index = tunable_[chosen_];
  const ParameterDescriptor& parameter = parameters_.style.list().descriptors()[index];
  const std::string_view unit = parameter.unit();
  return fmt::format("{} {}{}{}  ({})  {}", parameter.name,
                     parameter.textOf(parameters_.style.at(index)), unit.empty() ? "" : " ", unit,
                     rangeText(parameter), parameter.help);
}

std::string LiveTuning::help() {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 10> kKeys{{
      {"Tab, Down", "next parameter (Shift-Tab, Up: the one before)"},
      {"Left, Right", "change it (with Shift: ten times as far)"},
      {"Backspace", "its value as the look has it"},
      {"l, Shift-l", "next look, the one before"},
      {"v, Shift-v", "next view, the one before"},
      {"Space", "pause"},
      {"s", "save the finished picture"},
      {"f", "full screen"},
      {"h, ?, F1", "these lines"},
      {"q, Escape", "quit"},
  }};
  std::string text;
  for (const auto& [keys, meaning] : kKeys) {
    text += fmt::format("{}{}\t{}", text.empty() ? "" : "\n", keys, meaning);
  }
  return text;
}

}  // namespace pleinair::app
