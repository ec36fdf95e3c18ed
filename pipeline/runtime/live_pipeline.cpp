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
  auto stage =
      std::make_unique<OutputStage>(std::move(output), format, std::move(options), clock_, ledger_);
  OutputStage& added = *stage;
  {
    const std::scoped_lock lock(outputsMutex_);
    outputs_.push_back(std::move(stage));
  }
  if (paint_) paint_->add(added);
  return added;
}

void LivePipeline::makePaintStage(PainterFactory factory, PaintStageOptions options) {
  std::vector<OutputStage*> outputs;
  std::optional<hal::Duration> refresh;
  for (const auto& each : outputs_) {
    outputs.push_back(each.get());
    refresh = std::max(refresh, each->refreshPeriod());  // none is less than any
  }
  if (refresh) options.latency.step = *refresh;
  paint_.emplace(std::move(factory), std::move(outputs), options, clock_, ledger_, frames_);
}

void LivePipeline::removeOutput(OutputStage& output) {
  assert(paint_);
  paint_->remove(output);
}

std::unique_ptr<OutputStage> LivePipeline::takeRemoved(OutputStage& output) {
  if (!hasReleased(output)) return nullptr;
  const std::scoped_lock lock(outputsMutex_);
  const auto owner = std::ranges::find(outputs_, &output, &std::unique_ptr<OutputStage>::get);
  assert(owner != outputs_.end());
  std::unique_ptr<OutputStage> taken = std::move(*owner);
  outputs_.erase(owner);
  return taken;
}

bool LivePipeline::isDrained() const {
  const std::scoped_lock lock(outputsMutex_);
  return capture_.status().hasEnded && ledger_.counts().inFlight == 0 &&
         std::ranges::all_of(outputs_, [](const auto& output) { return output->isIdle(); });
}

RuntimeStatus LivePipeline::status() const {
  RuntimeStatus status{.uptime = clock_.now() - began_,
                       .camera = capture_.status(),
                       .painting = paint_->status(),
                       .outputs = {},
                       .ledger = ledger_.counts()};
  const std::scoped_lock lock(outputsMutex_);
  for (const auto& output : outputs_) status.outputs.push_back(output->status());
  return status;
}

}  // namespace pleinair::runtime
