#include "pipeline/runtime/status/metrics/declarations.h"

namespace pleinair::runtime {
namespace {

Readings paintStages(const PaintStage::Status& painting) {
  Readings readings;
  for (const PaintStage::Stage& stage : painting.stages) {
    readings.emplace_back(
        stage.name, SummaryReading{.recent = stage.recent, .count = stage.count, .sum = stage.sum});
  }
  return readings;
}

/// Durations of the passes, by their names.
template <class Read>
Readings paintPasses(const PaintStage::Status& painting, Read read) {
  Readings readings;
  for (const gpu::PassTime& pass : painting.passes) {
    readings.emplace_back(pass.pass, hal::Duration(read(pass)));
  }
  return readings;
}

StateReading framePath(const CameraPath& path) {
  StateReading state{.names = {}, .current = static_cast<std::size_t>(path.frames.path)};
  for (int i = 0; i <= static_cast<int>(gpu::FramePath::kImported); ++i) {
    state.names.emplace_back(gpu::toString(static_cast<gpu::FramePath>(i)));
  }
  return state;
}

StateReading lumaSource(const CameraPath& path) {
  StateReading state{.names = {}, .current = static_cast<std::size_t>(path.luma)};
  for (int i = 0; i <= static_cast<int>(LumaSource::kCopy); ++i) {
    state.names.emplace_back(toString(static_cast<LumaSource>(i)));
  }
  return state;
}

/// Unset until a frame was painted.
template <class Read>
Readings ofPath(const MetricMoment& moment, Read read) {
  const std::optional<CameraPath>& path = moment.status.painting.cameraPath;
  return path ? one(read(*path)) : one({});
}

using enum MetricScope;
using enum MetricType;

}  // namespace

std::vector<Metric> paintingMetrics() {
  return {
      {kPainting, "frames_per_second", "", kGauge, kNoUnit, "Images painted in the last second.",
       [](Moment m) { return one(m.status.painting.perSecond); }, "painted_per_second"},
      {kPainting, "painted", "", kCounter, kNoUnit, "Images painted.",
       [](Moment m) { return one(m.status.painting.painted); }, "painted_total"},
      {kPainting, "load", "", kGauge, kNoUnit, "Share of its time budget that the last frame took.",
       [](Moment m) { return one(m.status.painting.load); }, "load"},
      {kPainting, "quality", "", kState, kNoUnit, "Quality level in force.",
       [](Moment m) {
         return one(StateReading{.names = m.qualityNames, .current = m.status.painting.quality});
       },
       "quality_level"},
      {kPainting, "quality_lowered", "", kCounter, kNoUnit, "Times that quality was lowered.",
       [](Moment m) { return one(m.status.painting.qualityLowered); }, "quality_lowered_total"},
      {kPainting, "quality_raised", "", kCounter, kNoUnit, "Times that quality was raised.",
       [](Moment m) { return one(m.status.painting.qualityRaised); }, "quality_raised_total"},
      {kPainting, "quality_limit", "", kState, kNoUnit,
       "Best quality level that the machine's heat permits.",
       [](Moment m) {
         return one(
             StateReading{.names = m.qualityNames, .current = m.status.painting.bestQuality});
       }},
      {kPainting, "latency", "", kGauge, kMs, "Latency in force: from capture to the due time.",
       [](Moment m) { return one(m.status.painting.latency); }, "latency_target_seconds"},
      {kPainting, "latency_configured", "", kGauge, kMs, "Latency that is configured.",
       [](Moment m) { return one(m.status.painting.configuredLatency); }},
      {kPainting, "latency_raised", "", kCounter, kNoUnit, "Times that the latency was raised.",
       [](Moment m) { return one(m.status.painting.latencyRaised); }, "latency_raised_total"},
      {kPainting, "latency_lowered", "", kCounter, kNoUnit,
       "Times that the latency was lowered again.",
       [](Moment m) { return one(m.status.painting.latencyLowered); }, "latency_lowered_total"},
      {kPainting, "failures", "", kCounter, kNoUnit, "Frames that the painter refused.",
       [](Moment m) { return one(m.status.painting.failures); }},
      {kPainting, "context_losses", "", kCounter, kNoUnit, "Times that the GPU was lost.",
       [](Moment m) { return one(m.status.painting.contextLosses); }, "context_losses_total"},
      {kPainting, "last_failure", "", kText, kNoUnit, "The last refusal or loss of the GPU.",
       [](Moment m) { return textOf(m.status.painting.failure); }},
      {kPainting, "frame_path", "", kState, kNoUnit,
       "How camera frames reach the GPU: copied there, copied while a trial runs, or read in the "
       "camera's memory.",
       [](Moment m) { return ofPath(m, framePath); }},
      {kPainting, "frame_path_reason", "", kText, kNoUnit,
       "Why they are copied, or how they are imported.",
       [](Moment m) { return ofPath(m, [](const CameraPath& p) { return p.frames.reason; }); }},
      {kPainting, "frame_path_trial", "", kGauge, kMs,
       "Time from the first frame until it was decided.",
       [](Moment m) { return ofPath(m, [](const CameraPath& p) { return p.frames.trial; }); }},
      {kPainting, "frames_imported", "", kCounter, kNoUnit,
       "Camera frames that the GPU read where they were.",
       [](Moment m) { return ofPath(m, [](const CameraPath& p) { return p.frames.imported; }); }},
      {kPainting, "frames_uploaded", "", kCounter, kNoUnit,
       "Camera frames that were copied to the GPU.",
       [](Moment m) { return ofPath(m, [](const CameraPath& p) { return p.frames.uploaded; }); }},
      {kPainting, "bytes_uploaded", "", kCounter, kNoUnit,
       "Bytes of camera frames that were copied to the GPU.",
       [](Moment m) {
         return ofPath(m, [](const CameraPath& p) { return p.frames.uploadedBytes; });
       }},
      {kPainting, "leases_held", "", kGauge, kNoUnit,
       "Buffers of the camera that the GPU may still be reading.",
       [](Moment m) { return ofPath(m, [](const CameraPath& p) { return p.frames.heldLeases; }); }},
      {kPainting, "luma", "", kState, kNoUnit,
       "Where trackers read the frame's brightness: nowhere, in the frame's memory, in a second "
       "stream of the camera, in what the GPU read back, or in a copy.",
       [](Moment m) { return ofPath(m, lumaSource); }},
      {kPainting, "luma_reason", "", kText, kNoUnit, "Why they read it there.",
       [](Moment m) { return ofPath(m, [](const CameraPath& p) { return p.lumaReason; }); }},
      {kPainting, "stages", "stage", kSummary, kMs,
       "Time that each stage takes of a frame's latency.",
       [](Moment m) { return paintStages(m.status.painting); }, "stage_seconds"},
      {kPainting, "pass_mean", "pass", kGauge, kMs,
       "Mean time of each pass on the GPU in the timed frames, one in 128.",
       [](Moment m) {
         return paintPasses(m.status.painting, [](const gpu::PassTime& p) { return p.mean(); });
       }},
      {kPainting, "pass_last", "pass", kGauge, kMs,
       "Time of each pass on the GPU in the last timed frame.",
       [](Moment m) {
         return paintPasses(m.status.painting, [](const gpu::PassTime& p) { return p.last; });
       }},
      {kPainting, "pass_peak", "pass", kGauge, kMs,
       "Longest time of each pass on the GPU in a timed frame.",
       [](Moment m) {
         return paintPasses(m.status.painting, [](const gpu::PassTime& p) { return p.peak; });
       }},
  };
}

}  // namespace pleinair::runtime
