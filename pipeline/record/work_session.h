#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hal/error.h"
#include "pipeline/procedure/stepper.h"
#include "pipeline/record/record_writer.h"

namespace pleinair::record {

/// How an answer was taken.
enum class Advance {
  kMoved,    ///< to another step
  kStayed,   ///< the check failed, and its outcome keeps the step
  kRefused,  ///< the step asks for another kind of answer; nothing was recorded
};

/// A procedure that is carried out, and its record. A step counts as done when its line is on the
/// disk: a call that fails leaves step and record as they were. One thread at a time.
class WorkSession {
 public:
  /// Begins at the first step. Errors: those of RecordWriter::create().
  static hal::Result<WorkSession> begin(std::shared_ptr<const procedure::Procedure> procedure,
                                        const std::filesystem::path& record, Begun begun,
                                        MomentSource clock = systemMoment,
                                        RecordSystem system = RecordSystem::real());
  /// Goes on at the step where the record ends. Errors: those of RecordWriter::resume(), and
  /// kInvalidInput where the record is of another procedure, or its way is not possible in this
  /// one.
  static hal::Result<WorkSession> resume(std::shared_ptr<const procedure::Procedure> procedure,
                                         const std::filesystem::path& record,
                                         const std::string& program,
                                         MomentSource clock = systemMoment,
                                         RecordSystem system = RecordSystem::real());

  const procedure::Stepper& stepper() const { return stepper_; }
  const RecordWriter& record() const { return writer_; }
  /// Who works now.
  const std::string& operatorName() const { return operator_; }

  /// Ends the current step. Precondition: the procedure is not finished, nor signed off.
  hal::Result<Advance> answer(const procedure::Answer& answer,
                              const std::optional<PoseQuality>& pose = std::nullopt,
                              const std::string& by = {});
  /// Goes back a step; stays at the first one. Precondition: not signed off.
  hal::Result<Advance> back();
  /// Adds a still of the current step. Precondition: as for answer().
  hal::Result<void> addStill(const std::string& when, std::span<const std::uint8_t> png);
  hal::Result<void> changeOperator(const std::string& name);
  /// Takes another version of the procedure, at the same step. Errors: those of
  /// Stepper::movedTo() and RecordWriter::add(); the version before stays in force then.
  hal::Result<void> changeProcedure(std::shared_ptr<const procedure::Procedure> procedure);
  /// Signs the record off: completed at the end, aborted before. Precondition: not signed off.
  hal::Result<void> signOff(const std::string& remark = {});

 private:
  WorkSession(procedure::Stepper stepper, RecordWriter writer, std::string operatorName,
              MomentSource clock);

  procedure::Stepper stepper_;
  RecordWriter writer_;
  std::string operator_;
  MomentSource clock_;
  Moment stepBegan_;
};

}  // namespace pleinair::record
