#include "pipeline/runtime/status/metrics/declarations.h"

namespace pleinair::runtime {
namespace {

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

using enum MetricScope;
using enum MetricType;

}  // namespace

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

}  // namespace pleinair::runtime
