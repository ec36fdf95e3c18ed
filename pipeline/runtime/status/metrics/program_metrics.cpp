#include "pipeline/runtime/status/metrics/declarations.h"

namespace pleinair::runtime {
namespace {

Readings ofProcedure(const MetricMoment& moment, std::string ProcedureStatus::*member) {
  const std::optional<ProcedureStatus>& procedure = moment.status.procedure;
  return procedure ? one((*procedure).*member) : one({});
}

using enum MetricScope;
using enum MetricType;

}  // namespace

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

}  // namespace pleinair::runtime
