#include "firmware_app/live/interaction/live_tuning.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "firmware_app/config/configuration_sections.h"
#include "firmware_app/config/look_file.h"
#include "firmware_app/live/interaction/parameter_step.h"

namespace pleinair::app {
namespace {

using config::ParameterDescriptor;
using config::ParameterKind;

constexpr const char* kOrigin = "a key";
constexpr std::string_view kRawView = "camera";  // of the engine: debugViewsOf()

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

LiveTuning::Style::Style(LiveStyle start)
    : name(std::move(start.name)),
      parameters(std::move(start.start)),
      views{std::string()},
      looks(std::move(start.looks)) {
  for (DebugView& view : start.views) views.push_back(std::move(view.name));
  findLook();
  const auto descriptors = parameters.style.list().descriptors();
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    if (descriptors[i].takesEffect == config::TakesEffect::kLive) tunable.push_back(i);
    const std::string& origin = parameters.style.origin(descriptors[i].name);
    if (origin != config::kDefaultOrigin && !origin.starts_with("look ")) given.push_back(i);
  }
}

void LiveTuning::Style::findLook() {
  const auto current = std::ranges::find(looks, parameters.style, &LiveLook::values);
  look.reset();
  if (current != looks.end()) look = static_cast<std::size_t>(current - looks.begin());
}

LiveTuning::LiveTuning(std::vector<LiveStyle> styles, std::size_t first) : current_(first) {
  for (LiveStyle& each : styles) styles_.emplace_back(std::move(each));
  assert(current_ < styles_.size());
}

void LiveTuning::setParameters(const std::string& style, PaintParameters parameters) {
  const auto named = std::ranges::find(styles_, style, &Style::name);
  assert(named != styles_.end());
  current_ = static_cast<std::size_t>(named - styles_.begin());
  named->parameters = std::move(parameters);
  named->findLook();
}

LiveTuning::Request LiveTuning::press(const hal::KeyPressed& key) {
  if (filter_ && filter_(key)) return Request::kNone;
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
  if (key.name == "w") return Request::kSaveLook;
  if (key.name == "c") return Request::kCommandLine;
  if (key.name == "f") return Request::kFullScreen;
  if (key.name == "backspace") {
    resetParameter();
  } else if (key.name == "r") {
    toggleCamera();
  } else if (key.name == "v") {
    cycleView(key.shift ? -1 : 1);
  } else if (key.name == "l") {
    cycleLook(key.shift ? -1 : 1);
  } else if (key.name == "t") {
    cycleStyle(key.shift ? -1 : 1);
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
  if (!style().tunable.empty())
    style().chosen = around(style().chosen, direction, style().tunable.size());
}

void LiveTuning::change(int direction, bool large) {
  if (style().tunable.empty()) return;
  const std::size_t index = style().tunable[style().chosen];
  const ParameterDescriptor& parameter = style().parameters.style.list().descriptors()[index];
  const auto next = stepped(parameter, style().parameters.style.at(index), direction, large);
  if (next) style().parameters.style = style().parameters.style.with(index, *next, kOrigin);
}

const config::ParameterValue& LiveTuning::baseAt(std::size_t index) const {
  if (style().look) return style().looks[*style().look].values.at(index);
  return style().parameters.style.list().descriptors()[index].defaultValue;
}

void LiveTuning::resetParameter() {
  if (style().tunable.empty()) return;
  const std::size_t index = style().tunable[style().chosen];
  style().parameters.style = style().parameters.style.with(index, baseAt(index), kOrigin);
}

std::vector<std::string> LiveTuning::arguments() const {
  std::vector<std::string> list{"--style", style().name};
  if (!style().looks.empty()) {
    list.insert(list.end(), {"--look", style().look ? style().looks[*style().look].name
                                                    : std::string(kDefaultLook)});
  }
  const auto descriptors = style().parameters.style.list().descriptors();
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    const config::ParameterValue& value = style().parameters.style.at(i);
    // What a file or the environment gave may have been tuned back to the look's value.
    const bool isGiven = std::ranges::find(style().given, i) != style().given.end();
    if (value == baseAt(i) && !isGiven) continue;
    list.insert(list.end(),
                {"--set", fmt::format("{}={}", descriptors[i].name, descriptors[i].textOf(value))});
  }
  list.insert(list.end(), {"--view", style().parameters.view.empty() ? std::string(kFinishedView)
                                                                     : style().parameters.view});
  return list;
}

std::string LiveTuning::lookFile() const {
  return lookFileText(style().name, style().parameters.style);
}

void LiveTuning::cycleView(int direction) {
  const auto shown = std::ranges::find(style().views, style().parameters.view);
  const auto index = static_cast<std::size_t>(shown - style().views.begin());
  style().parameters.view = style().views.at(around(index, direction, style().views.size()));
}

void LiveTuning::toggleCamera() {
  std::string& view = style().parameters.view;
  view = view == kRawView ? std::string() : std::string(kRawView);
}

void LiveTuning::cycleLook(int direction) {
  if (style().looks.empty()) return;
  const std::size_t before = direction > 0 ? style().looks.size() - 1 : 0;
  style().look = around(style().look.value_or(before), direction, style().looks.size());
  style().parameters.style = style().looks[*style().look].values;
}

/// The debug view stays where the next style has it, too.
void LiveTuning::cycleStyle(int direction) {
  const std::string view = style().parameters.view;
  current_ = around(current_, direction, styles_.size());
  const bool hasView = std::ranges::find(style().views, view) != style().views.end();
  style().parameters.view = hasView ? view : std::string();
}

std::string LiveTuning::state() const {
  std::string text = style().name;
  if (style().look) {
    const bool isChanged = !(style().looks[*style().look].values == style().parameters.style);
    text += fmt::format(" · {}{}", style().looks[*style().look].name, isChanged ? ", changed" : "");
  }
  if (!style().parameters.view.empty()) text += " · view " + style().parameters.view;
  if (isPaused_) text += " · paused";
  return text;
}

std::string LiveTuning::parameterLine() const {
  if (style().tunable.empty()) return fmt::format("{} has nothing to tune", style().name);
  const std::size_t index = style().tunable[style().chosen];
  const ParameterDescriptor& parameter = style().parameters.style.list().descriptors()[index];
  const std::string_view unit = parameter.unit();
  return fmt::format("{} {}{}{}  ({})  {}", parameter.name,
                     parameter.textOf(style().parameters.style.at(index)), unit.empty() ? "" : " ",
                     unit, rangeText(parameter), parameter.help);
}

std::string LiveTuning::help() const {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 14> kKeys{{
      {"Tab, Down", "next parameter (Shift-Tab, Up: the one before)"},
      {"Left, Right", "change it (with Shift: ten times as far)"},
      {"Backspace", "its value as the look has it"},
      {"l, Shift-l", "next look, the one before"},
      {"t, Shift-t", "next style, the one before"},
      {"r", "the camera's raw picture, and back"},
      {"v, Shift-v", "next view, the one before"},
      {"Space", "pause"},
      {"s", "save the finished picture"},
      {"w", "save the values as a look file"},
      {"c", "copy the command line that repeats this"},
      {"f", "full screen"},
      {"h, ?, F1", "these lines"},
      {"q, Escape", "quit"},
  }};
  std::string text = filterHelp_;
  for (const auto& [keys, meaning] : kKeys) {
    text += fmt::format("{}{}\t{}", text.empty() ? "" : "\n", keys, meaning);
  }
  return text;
}

}  // namespace pleinair::app
