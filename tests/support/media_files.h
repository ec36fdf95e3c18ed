#pragma once

#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include "hal/camera.h"
#include "hal/cameras/recording/recording.h"
#include "hal/outputs/registry.h"
#include "tests/support/test_pictures.h"

namespace pleinair::support {

/// Writes `count` test images to a movie, pattern, folder or PNG; gives the output's format.
inline hal::FrameFormat writeMedia(const std::filesystem::path& path, int count,
                                   hal::FrameSize size = {64, 48},
                                   std::vector<hal::Duration> times = {}) {
  constexpr hal::Duration kPeriod = std::chrono::milliseconds(40);
  const auto output = hal::orThrow(hal::openFileOutput(path));
  const hal::OutputFormat format =
      hal::orThrow(output->start({.size = size, .framePeriod = kPeriod}));
  for (int i = 0; i < count; ++i) {
    const hal::Duration time = times.empty() ? i * kPeriod : times.at(static_cast<std::size_t>(i));
    hal::orThrow(output->write(testPicture(format.frame, i).view(), time));
  }
  hal::orThrow(output->finish());
  return format.frame;
}

/// The whole content of a recording.
struct Played {
  hal::StreamFormat format;
  std::vector<hal::CapturedFrame> frames;
  std::vector<hal::Duration> times;  ///< since start()
  std::vector<hal::StreamFormat> changes;
  std::uint64_t dropped = 0;
  hal::NextFrame ending;
};

/// Plays up to `most` frames. The error is that of start().
inline hal::Result<Played> play(const std::filesystem::path& path,
                                hal::RecordingOptions options = {}, std::size_t most = 10'000) {
  hal::SteppedClock clock(hal::TimePoint(std::chrono::seconds(7)));
  const auto camera = hal::openRecording(path, clock, options);
  const hal::TimePoint start = clock.now();
  hal::Result<hal::StreamFormat> format = camera->start({});
  if (!format) return tl::unexpected(format.error());
  Played played{.format = *format, .ending = hal::EndOfStream{}};
  while (played.frames.size() < most) {
    hal::NextFrame next = camera->next(hal::kNoDeadline);
    if (auto* frame = std::get_if<hal::CapturedFrame>(&next)) {
      played.times.push_back(frame->captureTime - start);
      played.dropped += frame->droppedBefore;
      played.frames.push_back(std::move(*frame));
    } else if (const auto* changed = std::get_if<hal::FormatChanged>(&next)) {
      played.changes.push_back(changed->format);
    } else {
      played.ending = std::move(next);
      break;
    }
  }
  return played;
}

}  // namespace pleinair::support
