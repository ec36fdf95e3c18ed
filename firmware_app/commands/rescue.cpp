#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "config/config_error.h"
#include "firmware_app/cli/interrupt.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/commands/commands.h"
#include "firmware_app/config/configuration.h"
#include "firmware_app/live/screens/last_painting.h"
#include "firmware_app/live/screens/rescue_back_off.h"
#include "firmware_app/live/screens/rescue_picture.h"
#include "firmware_app/live/status/service_reporter.h"
#include "firmware_app/provisioning/provisioning.h"
#include "firmware_app/service_manager/service_manager.h"
#include "hal/clock.h"
#include "hal/console/virtual_terminal.h"
#include "hal/error.h"
#include "hal/outputs/display/display_output.h"
#include "hal/outputs/registry.h"
#include "pipeline/present/waiting_picture.h"

namespace pleinair::app {
namespace {

constexpr hal::Duration kStepInterval = std::chrono::milliseconds(20);
constexpr const char* kDisplay = "display";
constexpr const char* kFit = "fit";

constexpr hal::FrameSize kFileSize{1280, 720};

/// Where the picture is shown, and why there may be no painting.
struct RescueJob {
  std::vector<std::string> targets;
  hal::OutputOptionsByKind options;
  std::string problem;  ///< of the configuration; empty: none
};

/// A wrong configuration must not keep the picture from being shown: it says what is wrong.
RescueJob rescueJobOf(const ConfigurationRequest& request) {
  RescueJob job;
  try {
    const OutputSettings output = Configuration(request).output();
    job.options = output.options;
    for (const std::filesystem::path& target : output.targets) {
      const auto kind = hal::outputKindOf(target.string());
      if (kind && (*kind)->traits.showsWaiting) job.targets.push_back(target.string());
    }
  } catch (const config::ConfigError& error) {
    job.problem = error.what();
  } catch (const hal::Failure& error) {
    job.problem = error.what();
  }
  if (job.targets.empty()) job.targets.emplace_back(kDisplay);
  // The picture has no shape of its own: it fills the screen.
  for (const hal::OutputKind& kind : hal::outputKinds()) {
    const bool hasFit =
        std::ranges::find(kind.options, kFit, &hal::OutputOption::name) != kind.options.end();
    if (kind.traits.showsWaiting && hasFit) job.options[kind.name][kFit] = "fill";
  }
  return job;
}

std::optional<hal::Image> lastPainting() {
  hal::Result<std::optional<hal::Image>> kept = LastPainting(stateFolder()).read();
  return kept ? *std::move(kept) : std::nullopt;
}

/// Writes the picture, RGB8 of kFileSize, to a file.
void writePicture(const std::filesystem::path& file, const present::WaitingText& text,
                  const std::optional<hal::Image>& painting) {
  const hal::Image picture =
      present::waitingPicture(kFileSize, painting ? painting->view() : hal::ImageView(), text);
  const std::unique_ptr<hal::MemoryOutput> output = orThrow(hal::openFileOutput(file));
  const hal::OutputFormat format =
      orThrow(output->start({.size = kFileSize, .framePeriod = std::nullopt}));
  hal::Image opaque(format.frame);
  const auto from = picture.view().planes[0].bytes;
  const auto to = opaque.plane(0);
  for (std::size_t pixel = 0; 4 * pixel < from.size(); ++pixel) {
    std::copy_n(from.data() + 4 * pixel, 3, to.data() + 3 * pixel);
  }
  orThrow(output->write(opaque.view(), {}));
  orThrow(output->finish());
}

std::unique_ptr<hal::VirtualTerminal> takeConsole() {
  auto taken = hal::VirtualTerminal::open(hal::kernelTerminals(),
                                          {.leave = hal::leaveConsole, .enter = hal::enterConsole});
  return taken ? *std::move(taken) : nullptr;
}

hal::TimePoint endOf(const RescueOptions& options, hal::TimePoint now) {
  if (!options.time) return hal::kNoDeadline;
  const std::filesystem::path folder = runtimeFolder();
  if (!options.backsOff || folder.empty()) return now + *options.time;
  const hal::Duration time = RescueBackOff(folder / "back-off").begin(*options.time, now);
  spdlog::info("the service is tried again in {:.0f} s", hal::toSeconds(time));
  return now + time;
}

}  // namespace

int showRescue(const RescueOptions& options) {
  const Interrupt interrupt;
  const ServiceManager manager(takeServiceEnvironment());
  ServiceReporter reporter(manager);
  hal::SteadyClock clock;
  ConfigurationRequest request = options.configuration;
  if (options.isProvisioned) request.siteFile = keptSiteFile(stateFolder());
  const RescueJob job = rescueJobOf(request);
  if (!job.problem.empty()) spdlog::warn("{}", job.problem);
  const present::WaitingText text{.title = options.title,
                                  .detail = job.problem.empty() ? options.detail : job.problem};
  if (!options.file.empty()) {
    writePicture(options.file, text, lastPainting());
    writeText(stdout, fmt::format("wrote {}\n", options.file.string()));
    return 0;
  }
  const std::unique_ptr<hal::VirtualTerminal> terminal = takeConsole();
  RescuePicture picture(
      job.targets, [&](const std::string& target) { return hal::openOutput(target, job.options); },
      text, lastPainting(), reporter.renewal(), clock);
  const hal::TimePoint end = endOf(options, clock.now());
  std::string problem;
  while (Interrupt::received() == 0 && clock.now() < end) {
    if (terminal) terminal->follow();
    picture.step();
    std::string now = picture.problem();
    if (now != problem && !now.empty()) spdlog::warn("{}", now);
    problem = std::move(now);
    if (reporter.isDue(clock.now())) {
      reporter.update({.outputs = picture.progress()},
                      problem.empty() ? "showing the rescue picture" : problem, clock.now());
    }
    clock.sleepUntil(clock.now() + kStepInterval);
  }
  reporter.stopping();
  return 0;
}

}  // namespace pleinair::app
