#include "firmware_app/repair_station/step_session.h"

#include <ranges>
#include <utility>
#include <variant>

#include "firmware_app/repair_station/record_folder.h"
#include "hal/media/png_file.h"

namespace pleinair::app {
namespace {

constexpr const char* kUnnamed = "unnamed";

}  // namespace

hal::Result<StepSession> StepSession::open(std::shared_ptr<const procedure::Procedure> procedure,
                                           const SessionOptions& options) {
  StepSession opened{procedure::Stepper(procedure)};
  if (options.records.empty()) return opened;
  if (const auto path = openRecordIn(options.records, procedure->name)) {
    auto session = record::WorkSession::resume(procedure, *path, options.program,
                                               record::systemMoment, options.system);
    if (!session) return tl::unexpected(std::move(session.error()));
    opened.session_.emplace(*std::move(session));
    opened.resumed_ = path->string();
    const bool isAnother =
        !options.operatorName.empty() && options.operatorName != opened.session_->operatorName();
    if (!isAnother) return opened;
    if (auto changed = opened.session_->changeOperator(options.operatorName); !changed) {
      return tl::unexpected(std::move(changed.error()));
    }
    return opened;
  }
  const std::filesystem::path path = newRecordIn(options.records, procedure->name);
  auto session = record::WorkSession::begin(
      std::move(procedure), path,
      {.program = options.program,
       .operatorName = options.operatorName.empty() ? kUnnamed : options.operatorName,
       .workOrder = options.workOrder,
       .language = options.language},
      record::systemMoment, options.system);
  if (!session) return tl::unexpected(std::move(session.error()));
  opened.session_.emplace(*std::move(session));
  return opened;
}

bool StepSession::isAt(const std::string& step) const {
  return !isSignedOff() && !stepper().isFinished() && stepper().step().id == step;
}

bool StepSession::hasStillBefore() const {
  if (!session_ || stepper().isFinished()) return false;
  for (const record::RecordEntry& entry : session_->record().entries() | std::views::reverse) {
    if (std::holds_alternative<record::StepDone>(entry.event)) break;
    const auto* still = std::get_if<record::StillTaken>(&entry.event);
    if (still != nullptr && still->when == "before" && still->step == stepper().step().id) {
      return true;
    }
  }
  return false;
}

SessionView StepSession::view() const {
  SessionView view{.stepper = stepper(),
                   .record = {},
                   .operatorName = {},
                   .finalHash = {},
                   .isSignedOff = isSignedOff()};
  if (!session_) return view;
  view.record = session_->record().path().string();
  view.operatorName = session_->operatorName();
  view.finalHash = session_->record().finalHash();
  return view;
}

hal::Result<record::Advance> StepSession::answer(const procedure::Answer& answer,
                                                 const std::optional<record::PoseQuality>& pose,
                                                 const std::string& by) {
  if (session_) return session_->answer(answer, pose, by);
  const auto outcome = procedure::outcomeOf(stepper_.step(), answer);
  if (!outcome) return record::Advance::kRefused;
  return stepper_.advance(*outcome) ? record::Advance::kMoved : record::Advance::kStayed;
}

hal::Result<record::Advance> StepSession::back() {
  if (session_) return session_->back();
  return stepper_.back() ? record::Advance::kMoved : record::Advance::kStayed;
}

hal::Result<void> StepSession::addStill(const std::string& when, const hal::ImageView& still) {
  if (!session_) return {};
  const auto png = hal::encodePng(still);
  if (!png) return tl::unexpected(png.error());
  return session_->addStill(when, *png);
}

hal::Result<void> StepSession::changeProcedure(
    std::shared_ptr<const procedure::Procedure> procedure) {
  if (session_) return session_->changeProcedure(std::move(procedure));
  auto moved = stepper_.movedTo(std::move(procedure));
  if (!moved) return tl::unexpected(std::move(moved.error()));
  stepper_ = *std::move(moved);
  return {};
}

hal::Result<void> StepSession::changeOperator(const std::string& name) {
  return session_->changeOperator(name);
}

hal::Result<void> StepSession::signOff() {
  return session_->signOff();
}

}  // namespace pleinair::app
