#pragma once

#include <cerrno>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <sys/resource.h>

#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {

/// A machine on which all is well; tests break one thing at a time.
struct HealthyMachine {
  std::map<std::string, std::string> files{
      {"/proc/sys/kernel/osrelease", "6.1.0-28-amd64"},
      {"/proc/sys/net/core/rmem_max", "8388608"},
      {"/proc/meminfo", "MemTotal:  8000000 kB\nMemFree: 100 kB\nMemAvailable:    4194304 kB\n"},
      {"/sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc"},
      {"/sys/devices/system/clocksource/clocksource0/available_clocksource", "tsc hpet acpi_pm"},
      {"/sys/module/v4l2loopback/parameters/exclusive_caps", "Y,N,N,N,N,N,N,N"}};
  std::map<std::string, std::vector<std::filesystem::path>> folders{
      {"/dev/dri", {"/dev/dri/by-path", "/dev/dri/card0", "/dev/dri/renderD128"}},
      {"/run/udev", {"/run/udev/control", "/run/udev/data"}},
      {"/sys/module/uvcvideo", {"/sys/module/uvcvideo/parameters"}},
      {"/sys/module/v4l2loopback", {"/sys/module/v4l2loopback/parameters"}}};
  std::map<std::string, int> refused;  ///< path → errno
  std::map<int, std::uint64_t> limits{{RLIMIT_RTPRIO, 50}, {RLIMIT_MEMLOCK, 64 << 20}};
  std::optional<std::uint64_t> freeBytes = 20'000'000'000;
  hal::Result<gpu::ContextInfo> graphics =
      gpu::ContextInfo{.renderer = "Mali-G52", .version = "OpenGL ES 3.2 Mesa 22.3.6"};
  FrameImportVerdict frameImport{
      .isImported = true, .reason = "heap", .took = std::chrono::milliseconds(80)};
  DeviceCameras cameras{
      .cameras = {{.identity = {.backend = "v4l2", .id = "usb-1", .description = "C920"},
                   .node = "/dev/video0",
                   .modes = {{.layout = "YUYV", .size = {640, 480}}}}}};
  std::vector<hal::LoopbackDevice> loopbacks{{.node = "/dev/video50",
                                              .card = "pleinair",
                                              .driver = "v4l2 loopback",
                                              .isLoopback = true,
                                              .isWritable = true}};
  hal::OutputListing displays{
      .outputs = {{.target = "display:card0-HDMI-A-1", .formats = {"1920x1080"}}}};
  std::optional<hal::Error> displayProblem;
  hal::Result<hal::DisplayTiming> displayTiming =
      hal::DisplayTiming{.size = {1920, 1080}, .period = std::chrono::microseconds(16'683)};
  ScanOutVerdict scanOut{
      .isDirect = true, .reason = "rows (linear)", .took = std::chrono::milliseconds(120)};
  std::vector<ListedKeyboard> keyboards{
      {.description = {.node = "/dev/input/event2", .name = "AT keyboard", .isKeyboard = true}}};
  std::optional<std::string> configurationError;
  std::vector<RequestedPart> requested{{.part = "camera", .value = "auto"}};

  /// Valid while this lives.
  Probes probes() {
    return {.read =
                [this](const auto& path) {
                  const auto found = files.find(path.string());
                  return found == files.end() ? std::nullopt : std::optional(found->second);
                },
            .list = [this](const auto& path) { return folders[path.string()]; },
            .access = [this](const auto& path) { return refused[path.string()]; },
            .freeBytes = [this](const auto&) { return freeBytes; },
            .limit = [this](int resource) { return limits.at(resource); },
            .graphics = [this] { return graphics; },
            .frameImport = [this] { return frameImport; },
            .cameras = [this] { return cameras; },
            .loopbacks = [this] { return loopbacks; },
            .displays = [this] { return displays; },
            .displayProblem = [this] { return displayProblem; },
            .displayTiming = [this] { return displayTiming; },
            .scanOut = [this] { return scanOut; },
            .keyboards = [this] { return keyboards; },
            .configurationError = [this] { return configurationError; },
            .requested = [this] { return requested; },
            .snapshots = "/srv/snapshots"};
  }
};

inline hal::Error errorOf(hal::ErrorKind kind, const std::string& problem) {
  return {.kind = kind, .subject = "/dev/video0", .problem = problem};
}

}  // namespace pleinair::app::doctor
