#include "pipeline/runtime/metrics.h"

#include <array>
#include <utility>

namespace pleinair::runtime {
namespace {

using Readings = std::vector<std::pair<std::string, MetricValue>>;

Readings one(MetricValue value) {
  Readings readings;
  readings.emplace_back(std::string(), std::move(value));
  return readings;
}

Readings textOf(const std::string& text) {
  return text.empty() ? one({}) : one(text);
}

Readings textOf(const std::optional<hal::Error>& error) {
  return error ? one(error->message()) : one({});
}

Readings byOutcome(const std::array<std::uint64_t, kOutcomes>& ended) {
  Readings readings;
  for (const Outcome outcome : allOutcomes()) {
    readings.emplace_back(nameOf(outcome), ended.at(static_cast<std::size_t>(outcome)));
  }
  return readings;
}

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

StateReading outputState(const OutputStage::Status& output) {
  std::size_t current = output.isFinal ? 2 : output.isFailed ? 1 : 0;
  if (output.suspension) {
    current = output.suspension->cause == hal::Suspension::Cause::kBlank ? 4 : 3;
  }
  return {.names = {"taking", "reopening", "failed", "suspended", "blanked"}, .current = current};
}

/// Unset where there is no display.
Readings pacing(const std::optional<hal::Refresh>& refresh) {
  if (!refresh) return one({});
  return one(StateReading{.names = {"display", "clock"}, .current = refresh->sequence ? 0U : 1U});
}

/// Unset for outputs that lend no surfaces, and until it is found out.
Readings scanOutPath(const ScanOut& scanOut) {
  if (scanOut.path == ScanOut::Path::kUnknown) return one({});
  return one(StateReading{.names = {"copied", "direct"},
                          .current = scanOut.path == ScanOut::Path::kDirect ? 1U : 0U});
}

Readings scanOutReason(const ScanOut& scanOut) {
  return scanOut.path == ScanOut::Path::kUnknown ? one({}) : one(scanOut.reason);
}

Readings scanOutTime(const ScanOut& scanOut) {
  return scanOut.path == ScanOut::Path::kUnknown ? one({}) : one(scanOut.took);
}

Readings scanOutDirect(const ScanOut& scanOut) {
  return scanOut.path == ScanOut::Path::kUnknown ? one({}) : one(scanOut.direct);
}

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

Readings ofProcedure(const MetricMoment& moment, std::string ProcedureStatus::*member) {
  const std::optional<ProcedureStatus>& procedure = moment.status.procedure;
  return procedure ? one((*procedure).*member) : one({});
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

/// Unset before the first reading, and where the machine does not tell.
template <class Read>
Readings ofMachine(const MetricMoment& moment, Read read) {
  const std::optional<hal::MachineState>& machine = moment.status.machine;
  if (!machine) return one({});
  const auto value = read(*machine);
  return value ? one(*value) : one({});
}

template <class Read>
Readings ofHottest(const MetricMoment& moment, Read read) {
  return ofMachine(moment, [&](const hal::MachineState& machine) {
    return machine.hottest ? std::optional(read(*machine.hottest)) : std::nullopt;
  });
}

StateReading clockTrust(hal::ClockTrust current) {
  return {.names = {"synchronized", "unconfirmed", "wrong"},
          .current = static_cast<std::size_t>(current)};
}

/// Unset until a frame was painted.
template <class Read>
Readings ofPath(const MetricMoment& moment, Read read) {
  const std::optional<CameraPath>& path = moment.status.painting.cameraPath;
  return path ? one(read(*path)) : one({});
}

// Short names for the declarations below.
using Moment = const MetricMoment&;
using enum MetricScope;
using enum MetricType;
constexpr MetricUnit kNoUnit = MetricUnit::kNone;
constexpr MetricUnit kS = MetricUnit::kSeconds;
constexpr MetricUnit kMs = MetricUnit::kMilliseconds;

std::vector<Metric> programMetrics() {
  return {
      {kProgram, "uptime", "", kGauge, kS, "Time since the start.",
       [](Moment m) { return one(m.status.uptime); }},
      {kProgram, "healthy", "", kGauge, kNoUnit,
       "Whether the camera streams and every output takes images, as in /healthz.",
       [](Moment m) { return one(m.status.isHealthy()); }},
      {kProgram, "site", "", kText, kNoUnit,
       "Place that the site file in force came from, where the machine was set up by one.",
       [](Moment m) { return textOf(m.status.siteOrigin); }},
      {kProgram, "site_problem", "", kText, kNoUnit,
       "What the screen says about setting it up, such as what is wrong with a site file.",
       [](Moment m) { return textOf(m.status.siteProblem); }},
      {kProgram, "procedure", "", kText, kNoUnit, "Name of the procedure that is carried out.",
       [](Moment m) { return ofProcedure(m, &ProcedureStatus::name); }},
      {kProgram, "procedure_step", "", kText, kNoUnit, "Id of its current step, or end.",
       [](Moment m) { return ofProcedure(m, &ProcedureStatus::step); }},
      {kProgram, "procedure_step_number", "", kGauge, kNoUnit,
       "Number of its current step, from 1; 0 at the end.",
       [](Moment m) {
         const auto& procedure = m.status.procedure;
         return procedure ? one(std::uint64_t{procedure->number}) : one({});
       }},
      {kProgram, "procedure_record", "", kText, kNoUnit, "File of its record, or empty.",
       [](Moment m) { return ofProcedure(m, &ProcedureStatus::record); }},
  };
}

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

std::vector<Metric> outputMetrics() {
  return {
      {kOutput, "name", "", kText, kNoUnit, "Name of the output, the label \"output\" in /metrics.",
       [](Moment m) { return one(m.output->name); }},
      {kOutput, "format", "", kText, kNoUnit, "Pixel layout, width and height of its images.",
       [](Moment m) { return one(m.output->format); }},
      {kOutput, "refresh_period", "", kGauge, kS, "Time between refreshes, if it has a display.",
       [](Moment m) {
         const std::optional<hal::Refresh>& refresh = m.output->refresh;
         return refresh ? one(refresh->period) : one({});
       }},
      {kOutput, "refresh_phase", "", kGauge, kS,
       "Time of one of its refreshes on the steady clock, once it is known.",
       [](Moment m) {
         const std::optional<hal::Refresh>& refresh = m.output->refresh;
         return refresh && refresh->phase ? one(refresh->phase->time_since_epoch()) : one({});
       }},
      {kOutput, "pacing", "", kState, kNoUnit,
       "What times its images: refreshes that its display counts, or our clock at that rate.",
       [](Moment m) { return pacing(m.output->refresh); }},
      {kOutput, "state", "", kState, kNoUnit, "Whether the output takes images.",
       [](Moment m) { return one(outputState(*m.output)); }, "output_up"},
      {kOutput, "suspension", "", kText, kNoUnit,
       "Why a display that works shows nothing: who has it, or why it is off.",
       [](Moment m) {
         const std::optional<hal::Suspension>& suspension = m.output->suspension;
         return suspension ? one(suspension->reason) : one({});
       }},
      {kOutput, "brightness", "", kGauge, kNoUnit,
       "Share of their values that images are shown with: less than 1 on a display that is dimmed.",
       [](Moment m) { return one(m.output->brightness); }},
      {kOutput, "scan_out", "", kState, kNoUnit,
       "How images reach a display's memory, or a window: read back and copied, or drawn there by "
       "the GPU.",
       [](Moment m) { return scanOutPath(m.output->scanOut); }},
      {kOutput, "scan_out_reason", "", kText, kNoUnit,
       "Why they are copied, or in which layout they are drawn.",
       [](Moment m) { return scanOutReason(m.output->scanOut); }},
      {kOutput, "scan_out_trial", "", kGauge, kMs, "Time that the trial took that decided on it.",
       [](Moment m) { return scanOutTime(m.output->scanOut); }},
      {kOutput, "direct", "", kCounter, kNoUnit, "Images that the GPU drew there.",
       [](Moment m) { return scanOutDirect(m.output->scanOut); }},
      {kOutput, "frames_per_second", "", kGauge, kNoUnit,
       "Images that the output took in the last second.",
       [](Moment m) { return one(m.output->perSecond); }, "output_per_second"},
      {kOutput, "latency", "", kSummary, kMs, "Time from capture until the output was given it.",
       [](Moment m) {
         return one(SummaryReading{.recent = m.output->latency,
                                   .count = m.output->presented,
                                   .sum = m.output->latencySum});
       },
       "capture_to_present_seconds"},
      {kOutput, "writing", "", kSummary, kMs, "Time that the output takes for an image.",
       [](Moment m) {
         return one(SummaryReading{.recent = m.output->writing, .count = {}, .sum = {}});
       }},
      {kOutput, "submitted", "", kCounter, kNoUnit, "Images submitted to the output.",
       [](Moment m) { return one(m.output->submitted); }},
      {kOutput, "repeats", "", kCounter, kNoUnit,
       "Of those, images without a camera frame of their own: during a pause.",
       [](Moment m) { return one(m.output->repeats); }},
      {kOutput, "waiting", "", kGauge, kNoUnit, "Images that are not due yet.",
       [](Moment m) { return one(m.output->waiting); }},
      {kOutput, "ended", "outcome", kCounter, kNoUnit, "Images of the output by outcome.",
       [](Moment m) { return byOutcome(m.output->ended); }, "output_pictures_total"},
      {kOutput, "failures", "", kCounter, kNoUnit, "Times that the output failed.",
       [](Moment m) { return one(m.output->failures); }},
      {kOutput, "last_failure", "", kText, kNoUnit, "Why the output failed the last time.",
       [](Moment m) { return textOf(m.output->failure); }},
  };
}

std::vector<Metric> frameMetrics() {
  return {
      {kFrames, "captured", "", kCounter, kNoUnit, "Frames that the camera made.",
       [](Moment m) { return one(m.status.ledger.captured); }},
      {kFrames, "in_flight", "", kGauge, kNoUnit, "Frames that have no outcome yet.",
       [](Moment m) { return one(m.status.ledger.inFlight); }},
      {kFrames, "ended", "outcome", kCounter, kNoUnit, "Frames by outcome; each has exactly one.",
       [](Moment m) { return byOutcome(m.status.ledger.ended); }, "frames_total"},
  };
}

std::vector<Metric> machineMetrics() {
  return {
      {kMachine, "sensor", "", kText, kNoUnit, "Temperature sensor that is nearest to its limit.",
       [](Moment m) {
         return ofHottest(m, [](const hal::ThermalZone& zone) { return zone.name; });
       }},
      {kMachine, "celsius", "", kGauge, kNoUnit, "What it reads.",
       [](Moment m) {
         return ofHottest(m, [](const hal::ThermalZone& zone) { return zone.celsius; });
       }},
      {kMachine, "limit_celsius", "", kGauge, kNoUnit,
       "Temperature from which on the machine slows itself down.",
       [](Moment m) {
         return ofHottest(m, [](const hal::ThermalZone& zone) { return zone.limitCelsius; });
       }},
      {kMachine, "memory_used_bytes", "", kGauge, kNoUnit, "Memory of the program.",
       [](Moment m) {
         return ofMachine(m, [](const hal::MachineState& s) { return s.usedBytes; });
       }},
      {kMachine, "memory_available_bytes", "", kGauge, kNoUnit, "Memory that it may still take.",
       [](Moment m) {
         return ofMachine(m, [](const hal::MachineState& s) { return s.availableBytes; });
       }},
      {kMachine, "disk_free_bytes", "", kGauge, kNoUnit,
       "Free space of the disk where the program keeps its state.",
       [](Moment m) {
         return ofMachine(m, [](const hal::MachineState& s) { return s.diskFreeBytes; });
       }},
      {kMachine, "clock", "", kState, kNoUnit,
       "Whether the machine's clock was set by a time server, may be right, or cannot be: then no "
       "schedule is followed.",
       [](Moment m) {
         return ofMachine(
             m, [](const hal::MachineState& s) { return std::optional(clockTrust(s.clock)); });
       }},
      {kMachine, "clock_jumps", "", kCounter, kNoUnit,
       "Times that the machine's clock went forward or back by 2 s or more.",
       [](Moment m) {
         return ofMachine(m,
                          [](const hal::MachineState& s) { return std::optional(s.clockJumps); });
       }},
  };
}

/// The prefix of a scope's names, in JSON and in Prometheus' format.
struct ScopeNames {
  std::string_view json;
  std::string_view prometheus;
};

ScopeNames namesOf(MetricScope scope) {
  switch (scope) {
    case kProgram:
      return {"", ""};
    case kCamera:
      return {"camera.", "camera_"};
    case kPainting:
      return {"painting.", "painting_"};
    case kOutput:
      return {"outputs[].", "output_"};
    case kFrames:
      return {"frames.", "frames_"};
    case kMachine:
      return {"machine.", "machine_"};
  }
  return {};
}

}  // namespace

const std::vector<Metric>& allMetrics() {
  static const std::vector<Metric> kMetrics = [] {
    std::vector<Metric> all;
    for (const auto& part : {programMetrics(), cameraMetrics(), paintingMetrics(), outputMetrics(),
                             frameMetrics(), machineMetrics()}) {
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }();
  return kMetrics;
}

std::string jsonKey(const Metric& metric) {
  std::string key(metric.name);
  if (metric.type == kSummary) return key;  // its members carry the unit
  if (metric.unit == kS) key += "_s";
  if (metric.unit == kMs) key += "_ms";
  return key;
}

std::string jsonPath(const Metric& metric) {
  return std::string(namesOf(metric.scope).json) + jsonKey(metric);
}

std::string prometheusName(const Metric& metric) {
  if (metric.type == kText) return {};
  std::string name = std::string(namesOf(metric.scope).prometheus) + std::string(metric.name);
  if (metric.unit != kNoUnit) name += "_seconds";
  if (metric.type == kCounter) name += "_total";
  return name;
}

std::string_view toString(MetricType type) {
  constexpr std::array<std::string_view, 5> kNames{"text", "gauge", "counter", "state", "summary"};
  return kNames.at(static_cast<std::size_t>(type));
}

}  // namespace pleinair::runtime
