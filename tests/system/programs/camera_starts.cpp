// Starts and stops the first camera of a kind again and again, and tells what the program holds
// then: descriptors, threads, resident memory and processes that it has started.
//
// usage: camera_starts KIND STARTS FRAMES      takes two frames after each start, and FRAMES after
//                                              the last one
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "hal/camera_backend.h"
#include "hal/cameras/registry.h"
#include "hal/clock.h"
#include "hal/error.h"

namespace pleinair {
namespace {

std::size_t entriesOf(const char* folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& each : std::filesystem::directory_iterator(folder)) ++count;
  return count;
}

/// Processes of this one, over all of its threads.
std::size_t children() {
  std::size_t count = 0;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream list(thread.path() / "children");
    for (std::string each; list >> each;) ++count;
  }
  return count;
}

std::string residentKb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmRSS:" && status >> word) return word;
  }
  return "0";
}

void tell(int starts) {
  fmt::print("{} {} {} {} {}\n", starts, entriesOf("/proc/self/fd"), entriesOf("/proc/self/task"),
             residentKb(), children());
  std::fflush(stdout);
}

/// How many of the frames came.
int take(hal::Camera& camera, hal::Clock& clock, int frames) {
  int taken = 0;
  for (int i = 0; i < frames; ++i) {
    const hal::NextFrame next = camera.next(clock.now() + std::chrono::seconds(30));
    if (!std::holds_alternative<hal::CapturedFrame>(next)) break;
    ++taken;
  }
  return taken;
}

int run(std::string_view name, int starts, int frames) {
  constexpr int kTellEvery = 25;
  hal::SteadyClock clock;
  for (const hal::CameraKind* kind : hal::cameraKinds()) {
    if (kind->name != name) continue;
    const auto backend = kind->open(kind->defaults, {});
    const auto cameras = hal::orThrow(backend->list());
    if (cameras.empty()) break;
    const auto camera = backend->make(cameras.front().identity.id, clock);
    for (int i = 1; i <= starts; ++i) {
      hal::orThrow(camera->start({.size = hal::FrameSize{320, 180}}));
      const int wanted = i == starts ? frames : 2;
      const int taken = take(*camera, clock, wanted);
      camera->stop();
      if (taken < wanted) {
        fmt::print(stderr, "{} of {} frames after start {}\n", taken, wanted, i);
        return EXIT_FAILURE;
      }
      if (i % kTellEvery == 1 || i == starts) tell(i);
    }
    return EXIT_SUCCESS;
  }
  fmt::print(stderr, "there is no camera of {}\n", name);
  return EXIT_FAILURE;
}

}  // namespace
}  // namespace pleinair

int main(int count, char** values) {
  const std::span arguments(values, static_cast<std::size_t>(count));
  if (arguments.size() != 4) return 2;
  try {
    return pleinair::run(arguments[1], std::stoi(arguments[2]), std::stoi(arguments[3]));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return EXIT_FAILURE;
  }
}
