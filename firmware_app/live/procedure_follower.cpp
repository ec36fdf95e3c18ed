#include "firmware_app/live/procedure_follower.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

/// The least time for the record, where other threads have used up what the end may take.
constexpr hal::Duration kRecordPatience = 300ms;

}  // namespace

ProcedureFollower::ProcedureFollower(const LiveJob& job, LiveControls& controls, LiveInput& input,
                                     Notify notify)
    : job_(job),
      procedure_(*job.procedure),
      controls_(controls),
      input_(input),
      notify_(std::move(notify)) {
  if (job.machine) machine_ = machinePlaceOf(job.scene.models[*job.machine]);
}

void ProcedureFollower::makeOverlay(hal::FrameSize picture) {
  const scene::Model* machine =
      job_.machine ? job_.scene.models[*job_.machine].model.get() : nullptr;
  std::vector<int> cards;
  for (const auto& [id, command] : job_.inputs.cards) cards.push_back(id);
  overlay_.emplace(machine, job_.procedureFolder, picture, job_.showsInset, std::move(cards));
  controls_.setOverlay(overlay_->update(procedure_.shown(), job_.clock->now()));
}

void ProcedureFollower::update(bool isPainting) {
  // A frame that is held is no evidence of what is done now.
  const bool isHeld = input_.isPaused();
  if (const auto tags = controls_.takeTags(); tags && !isHeld) {
    input_.see(*tags);
    procedure_.locate(poseQualityOf(machine_, *tags));
  }
  procedure_.poll();
  if (isPainting && !isHeld && procedure_.takeStillRequest()) controls_.requestStill();
  if (auto still = controls_.takeStill()) {
    procedure_.putStill(std::move(still->image), still->place);
  }
  showTexts();
  if (!overlay_) return;
  if (auto content = overlay_->update(procedure_.shown(), job_.clock->now())) {
    controls_.setOverlay(std::move(content));
  }
}

void ProcedureFollower::showTexts() {
  while (const auto failure = procedure_.takeFailure()) {
    notify_(*failure, false);
    if (overlay_) overlay_->notifyFailure(*failure, job_.clock->now());
  }
  while (const auto notice = procedure_.takeNotice()) {
    notify_(*notice, true);
    if (overlay_) overlay_->notify(*notice, job_.clock->now());
  }
}

std::optional<std::string> ProcedureFollower::takeStep() {
  const std::string step = procedure_.status().step;
  if (std::exchange(loggedStep_, step) == step) return std::nullopt;
  return fmt::format("step {}: {}", step, procedure_.text());
}

LiveProcedure::RecordEnd ProcedureFollower::end(std::chrono::steady_clock::time_point deadline) {
  if (end_) return *end_;
  const hal::Duration left = deadline - std::chrono::steady_clock::now();
  end_ = procedure_.end(std::max<hal::Duration>(left, kRecordPatience));
  while (const auto failure = procedure_.takeFailure()) notify_(*failure, false);
  while (const auto notice = procedure_.takeNotice()) notify_(*notice, true);
  return *end_;
}

}  // namespace pleinair::app
