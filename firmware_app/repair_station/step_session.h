#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "hal/error.h"
#include "hal/image.h"
#include "pipeline/procedure/stepper.h"
#include "pipeline/record/work_session.h"

namespace pleinair::app {

/// Where the work stands: a copy for other threads.
struct SessionView {
  procedure::Stepper stepper;
  std::string record;  ///< path; empty: nothing is recorded
  std::string operatorName;
  std::string finalHash;
  bool isSignedOff = false;
};

struct SessionOptions {
  std::filesystem::path records;  ///< the folder of records; empty: nothing is recorded
  std::string operatorName;       ///< empty: unnamed, or whoever the resumed record names
  std::string workOrder;
  std::string program;  ///< version of this program
  std::string language;
  record::RecordSystem system = record::RecordSystem::real();
};

/// A procedure that is carried out, with a record or without. Calls wait for the disk. One thread
/// at a time.
class StepSession {
 public:
  /// Goes on with the procedure's newest record that is not signed off, or begins one. Errors:
  /// those of record::WorkSession.
  static hal::Result<StepSession> open(std::shared_ptr<const procedure::Procedure> procedure,
                                       const SessionOptions& options);

  const procedure::Stepper& stepper() const { return session_ ? session_->stepper() : stepper_; }
  bool isRecorded() const { return session_.has_value(); }
  bool isSignedOff() const { return session_ && session_->record().isSignedOff(); }
  /// Whether the step with this id is the current one, and can still be ended.
  bool isAt(const std::string& step) const;
  /// The same, and the version in force is that one.
  bool isAt(const std::string& step, const procedure::Procedure& version) const {
    return isAt(step) && &stepper().procedure() == &version;
  }
  /// The record that was gone on with; empty: a new one, or none.
  const std::string& resumed() const { return resumed_; }
  /// Whether the record has a still from before the current step.
  bool hasStillBefore() const;
  SessionView view() const;

  /// All as record::WorkSession has them; without a record, nothing is written. Preconditions as
  /// there.
  hal::Result<record::Advance> answer(const procedure::Answer& answer,
                                      const std::optional<record::PoseQuality>& pose,
                                      const std::string& by);
  hal::Result<record::Advance> back();
  /// Codes it as a PNG. Errors also: those of hal::encodePng().
  hal::Result<void> addStill(const std::string& when, const hal::ImageView& still);
  hal::Result<void> changeProcedure(std::shared_ptr<const procedure::Procedure> procedure);
  /// Precondition: isRecorded().
  hal::Result<void> changeOperator(const std::string& name);
  /// Precondition: isRecorded(), not signed off.
  hal::Result<void> signOff();

 private:
  explicit StepSession(procedure::Stepper stepper) : stepper_(std::move(stepper)) {}

  procedure::Stepper stepper_;  ///< without a record
  std::optional<record::WorkSession> session_;
  std::string resumed_;
};

}  // namespace pleinair::app
