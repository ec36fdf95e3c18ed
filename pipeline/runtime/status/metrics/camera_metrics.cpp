#include "pipeline/runtime/status/metrics/declarations.h"

namespace pleinair::runtime {
namespace {

Readings byKind(const hal::LinkCounts& link) {
  Readings readings;
  readings.emplace_back("missing", link.missingPackets);
  readings.emplace_back("resent", link.resentPackets);
  readings.emplace_back("ignored", link.ignoredPackets);
  return readings;
}

Readings cameraText(const MetricMoment& moment, std::string hal::CameraIdentity::*member) {
  const std::optional<hal::CameraIdentity>& camera = moment.status.camera.camera;
  return camera ? one((*camera).*member) : one({});
}

StateReading cameraState(hal::CameraState current) {
  StateReading state{.names = {}, .current = static_cast<std::size_t>(current)};
  for (int i = 0; i <= static_cast<int>(hal::CameraState::kEnded); ++i) {
    state.names.emplace_back(hal::toString(static_cast<hal::CameraState>(i)));
  }
  return state;
}

StateReading frameMemory(hal::FrameMemory current) {
  StateReading state{.names = {}, .current = static_cast<std::size_t>(current)};
  for (int i = 0; i <= static_cast<int>(hal::FrameMemory::kLent); ++i) {
    state.names.emplace_back(hal::toString(static_cast<hal::FrameMemory>(i)));
  }
  return state;
}

/// Unset where none was asked for.
Readings lumaText(const MetricMoment& moment) {
  const std::optional<hal::StreamFormat>& format = moment.status.camera.format;
  if (!format) return one({});
  if (format->luma) return one(*format->luma);
  return format->lumaNote.empty() ? one({}) : one(format->lumaNote);
}

using enum MetricScope;
using enum MetricType;

}  // namespace

std::vector<Metric> cameraMetrics() {
  return {
      {kCamera, "state", "", kState, kNoUnit, "State of the camera (docs/cameras.md).",
       [](Moment m) { return one(cameraState(m.status.camera.state)); }, "camera_streaming"},
      {kCamera, "reason", "", kText, kNoUnit, "What the device did that led to the state.",
       [](Moment m) { return one(m.status.camera.reason); }},
      {kCamera, "frames_per_second", "", kGauge, kNoUnit, "Frames that arrived in the last second.",
       [](Moment m) { return one(m.status.camera.perSecond); }},
      {kCamera, "delivery_p50", "", kGauge, kMs,
       "Median time from capture to arrival in the program.",
       [](Moment m) { return one(m.status.camera.delay); }},
      {kCamera, "opens", "", kCounter, kNoUnit, "Times that a camera was opened.",
       [](Moment m) { return one(m.status.camera.opens); }},
      {kCamera, "losses", "", kCounter, kNoUnit, "Times that the camera was lost.",
       [](Moment m) { return one(m.status.camera.losses); }},
      {kCamera, "stalls", "", kCounter, kNoUnit, "Times that the camera fell silent.",
       [](Moment m) { return one(m.status.camera.stalls); }},
      {kCamera, "packets", "kind", kCounter, kNoUnit,
       "Packets of a GigE camera that went wrong: missing for good, resent after a loss, or "
       "ignored "
       "because they belonged to no awaited frame.",
       [](Moment m) { return byKind(m.status.camera.link); }},
      {kCamera, "last_loss", "", kText, kNoUnit, "Why the camera was lost the last time.",
       [](Moment m) {
         const std::string& why = m.status.camera.lastLoss;
         return why.empty() ? one({}) : one(why);
       }},
      {kCamera, "quiet", "", kGauge, kS, "Time since something moved before the camera.",
       [](Moment m) {
         const std::optional<hal::Duration>& quiet = m.status.camera.quiet;
         return quiet ? one(*quiet) : one({});
       }},
      {kCamera, "backend", "", kText, kNoUnit, "Kind of the camera, such as v4l2.",
       [](Moment m) { return cameraText(m, &hal::CameraIdentity::backend); }},
      {kCamera, "id", "", kText, kNoUnit, "Stable id of the camera.",
       [](Moment m) { return cameraText(m, &hal::CameraIdentity::id); }},
      {kCamera, "description", "", kText, kNoUnit, "Name of the camera for people.",
       [](Moment m) { return cameraText(m, &hal::CameraIdentity::description); }},
      {kCamera, "format", "", kText, kNoUnit, "Pixel layout, width and height of its frames.",
       [](Moment m) {
         const std::optional<hal::StreamFormat>& format = m.status.camera.format;
         return format ? one(format->frame) : one({});
       }},
      {kCamera, "memory", "", kState, kNoUnit,
       "Who has allocated its frames: the program, the device (with dma-bufs), or an allocator "
       "that "
       "is lent to it.",
       [](Moment m) {
         const std::optional<hal::StreamFormat>& format = m.status.camera.format;
         return format ? one(frameMemory(format->memory)) : one({});
       }},
      {kCamera, "memory_note", "", kText, kNoUnit,
       "Name of the allocator, or why its memory is not used.",
       [](Moment m) {
         const std::optional<hal::StreamFormat>& format = m.status.camera.format;
         return format && !format->memoryNote.empty() ? one(format->memoryNote) : one({});
       }},
      {kCamera, "luma", "", kText, kNoUnit,
       "Size of the second image that it makes of each frame for trackers, or why it makes none.",
       [](Moment m) { return lumaText(m); }},
  };
}

}  // namespace pleinair::runtime
