#include "pipeline/runtime/live_pipeline.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace pleinair::runtime {

LivePipeline::LivePipeline(hal::CameraSupervisor& camera, hal::Clock& clock)
    : camera_(camera),
      clock_(clock),
      began_(clock.now()),
      capture_(camera, clock, ledger_, frames_) {}

OutputStage& LivePipeline::addOutput(std::unique_ptr<hal::Output> output, hal::OutputFormat format,
                                     OutputStageOptions options) {
  assert(!paint_);
  outputs_.push_back(std::make_unique<OutputStage>(std::move(output), format, std::move(options),
                                                   clock_, ledger_));
  return *outputs_.back();
}

void LivePipeline::makePaintStage(PainterFactory factory, PaintStageOptions options) {
  std::vector<OutputStage*> outputs;
  for (const auto& each : outputs_) outputs.push_back(each.get());
  paint_.emplace(std::move(factory), std::move(outputs), options, clock_, ledger_, frames_);
}

bool LivePipeline::isDrained() const {
  return capture_.status().hasEnded && ledger_.counts().inFlight == 0 &&
         std::ranges::all_of(outputs_, [](const auto& output) { return output->isIdle(); });
}

RuntimeStatus LivePipeline::status() const {
  RuntimeStatus status{.uptime = clock_.now() - began_,
                       .camera = capture_.status(),
                       .painting = paint_->status(),
                       .outputs = {},
                       .ledger = ledger_.counts()};
  for (const auto& output : outputs_) status.outputs.push_back(output->status());
  return status;
}

}  // namespace pleinair::runtime
