#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "firmware_app/cli/interrupt.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/commands/procedure.h"
#include "firmware_app/config/input_map.h"
#include "firmware_app/repair_station/input_learning.h"
#include "hal/clock.h"
#include "hal/keyboards/buttons.h"
#include "hal/pending_file.h"

namespace pleinair::app {
namespace {

using procedure::StepCommandKind;

constexpr hal::Duration kInputPollInterval = std::chrono::milliseconds(20);

/// The commands that a pedal or gamepad is taught, the most useful first.
std::vector<procedure::StepCommand> taughtCommands() {
  constexpr std::array kKinds{StepCommandKind::kNext,      StepCommandKind::kBack,
                              StepCommandKind::kYes,       StepCommandKind::kNo,
                              StepCommandKind::kPhoto,     StepCommandKind::kRaw,
                              StepCommandKind::kUncertain, StepCommandKind::kSignOff};
  std::vector<procedure::StepCommand> commands;
  for (const StepCommandKind kind : kKinds) commands.push_back({.kind = kind, .operatorName = {}});
  return commands;
}

std::string listingOf(const std::vector<hal::KeyboardDescription>& devices) {
  if (devices.empty()) return "no input devices: see `pleinair doctor`\n";
  std::string text;
  for (const hal::KeyboardDescription& each : devices) {
    const char* kind = each.isKeyboard ? "keyboard" : each.hasKeys ? "keys" : "buttons";
    text += fmt::format("{:10}  {:9}  {:18}  {}\n", each.id.empty() ? "-" : each.id, kind,
                        each.node, each.name);
  }
  return text;
}

/// Calls `poll` until it answers false or a signal comes, and prints the lines that it adds.
template <class Poll>
void pollLines(hal::Clock& clock, Poll poll) {
  for (bool goesOn = true; goesOn && Interrupt::received() == 0;) {
    std::vector<std::string> lines;
    goesOn = poll(lines);
    for (const std::string& line : lines) writeText(stdout, line + "\n");
    if (!lines.empty()) std::fflush(stdout);
    if (goesOn) clock.sleepUntil(clock.now() + kInputPollInterval);
  }
}

void watch(hal::KeyboardDevices& devices, hal::Clock& clock) {
  std::vector<hal::KeyboardDescription> known;
  hal::InputDevices inputs(
      [&](const hal::KeyboardDescription& device) {
        known.push_back(device);
        return std::optional(hal::InputDevices::Choice{.index = known.size() - 1});
      },
      devices, clock);
  pollLines(clock, [&](std::vector<std::string>& lines) {
    inputs.read([&](const hal::InputDevices::Open& open, const hal::KeyEvent& event) {
      if (event.value != 1 || isTouch(event.code)) return;
      const hal::KeyboardDescription& device = known.at(open.choice.index);
      lines.push_back(
          fmt::format("{}  {}  {}", selectorOf(device), hal::buttonName(event.code), device.name));
    });
    std::vector<hal::Error> problems;
    inputs.takeProblems(problems);
    for (const hal::Error& each : problems) lines.push_back(each.message());
    return true;
  });
}

int learn(const std::filesystem::path& file, hal::KeyboardDevices& devices, hal::Clock& clock) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {
    throw hal::Failure({.kind = hal::ErrorKind::kInvalidArgument,
                        .subject = file.string(),
                        .problem = "exists already",
                        .remedy = "another name, or remove it"});
  }
  InputLearning learning(taughtCommands(), devices, clock);
  pollLines(clock, [&](std::vector<std::string>& lines) {
    lines = learning.poll();
    return !learning.isDone();
  });
  if (const int signal = Interrupt::received(); signal != 0) return kSignalExitBase + signal;
  if (learning.map().isEmpty()) {
    throw hal::Failure({.kind = hal::ErrorKind::kNotFound,
                        .subject = file.string(),
                        .problem = "no button was pressed; nothing is written",
                        .remedy = "`pleinair inputs --watch` shows what arrives"});
  }
  const std::string text = inputMapText(learning.map());
  hal::PendingFile written = hal::orThrow(hal::PendingFile::create(file));
  hal::orThrow(written.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
  hal::orThrow(written.publish());
  writeText(stdout, fmt::format("{}\nwritten to {}; name it in the site file:\n"
                                "  [input]\n  map = \"{}\"\n",
                                text, file.string(), file.string()));
  return 0;
}

}  // namespace

int showInputs(const InputsOptions& options) {
  const Interrupt interrupt;
  hal::SteadyClock clock;
  hal::KeyboardDevices& devices = hal::kernelKeyboards();
  writeText(stdout, listingOf(devices.list()));
  std::fflush(stdout);
  if (options.learn) return learn(*options.learn, devices, clock);
  if (options.watches) watch(devices, clock);
  return 0;
}

}  // namespace pleinair::app
